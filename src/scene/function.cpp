// Heights by a function: what it displaces by, found out before anything is drawn.
#include <algorithm>
#include <cmath>
#include <set>

#include "scene/loading.h"

namespace relief {
namespace {

constexpr int kMeasuredIsolation = 2;             ///< enough to find the heights of a face
constexpr std::size_t kMeasuredPoints = 1u << 16; ///< of all faces and times together, as far as every face has 3 x 3
constexpr double kMargin = 1.25;                  ///< of a bound that is measured
constexpr double kStepShare = 1.0 / 8192;         ///< of slopes: of the diagonal of the cage's box

/// A point of a face, or of a triangle of a mesh.
struct MeasuredPoint {
    int face = 0;
    dvec2 uv{0};
};

/// Points all over what is drawn, and what the function is given there at rest; times are left at 0.
struct MeasuredPoints {
    std::vector<MeasuredPoint> at;
    std::vector<FunctionPoint> given;
    std::size_t faceCount = 0;
};

/// Points per side of a face, for about `count` points on all faces.
int sideOfLattice(std::size_t count, std::size_t faceCount) {
    return std::max(int(std::sqrt(double(count) / double(std::max<std::size_t>(faceCount, 1)))), 3);
}

/// Adds a lattice of side x side points of a face, corners and edges included; of a triangle those with u + v <= 1.
void addLattice(int face, int side, bool isTriangle, std::vector<MeasuredPoint>& points) {
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
            if (!isTriangle || i + j < side) points.push_back({face, dvec2(i, j) / double(side - 1)});
}

MeasuredPoints spreadOverSurface(const LoadedObject& object, double unit, std::size_t count) {
    Cage rest = object.cage;
    if (!object.restPositions.empty()) rest.positions = object.restPositions;
    const ReferenceSurface surface(rest, {.scheme = object.options.scheme, .isolation = kMeasuredIsolation});
    MeasuredPoints points{.faceCount = std::size_t(surface.faceCount())};
    const int side = sideOfLattice(count, points.faceCount);
    for (int face = 0; face < surface.faceCount(); ++face)
        if (!surface.isHole(face)) addLattice(face, side, surface.sideCount() == 3, points.at);
    for (const MeasuredPoint& point : points.at)
        points.given.push_back(
            {.p = vec3(unit * surface.limit(point.face, point.uv).p),
             .st = surface.hasTexCoords() ? vec2(surface.texture(point.face, point.uv).st) : vec2(0)});
    return points;
}

MeasuredPoints spreadOverMesh(const LoadedObject& object, double unit, std::size_t count) {
    const DenseMesh& mesh = *object.dense;
    MeasuredPoints points{.faceCount = mesh.indices.size() / 3};
    const int side = sideOfLattice(count, points.faceCount);
    for (std::size_t face = 0; face < points.faceCount; ++face) addLattice(int(face), side, true, points.at);
    for (const MeasuredPoint& point : points.at) {
        const double weights[] = {1 - point.uv.x - point.uv.y, point.uv.x, point.uv.y};
        FunctionPoint given;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t vertex = mesh.indices[3 * std::size_t(point.face) + k];
            given.p += vec3(unit * weights[k] * dvec3(object.denseRest[vertex]));
            if (!mesh.texCoords.empty()) given.st += float(weights[k]) * mesh.texCoords[vertex];
        }
        points.given.push_back(given);
    }
    return points;
}

/// Checks values against the stated bound, and keeps the largest one and the range on each face.
class Census {
public:
    Census(const HeightFunction& function, std::optional<double> stated, double mid, std::size_t faceCount)
        : name_(function.name()), stated_(stated), mid_(mid), lowest_(faceCount, INFINITY),
          highest_(faceCount, -INFINITY) {}

    void check(const MeasuredPoint& point, double time, const FunctionValue& found) const {
        const double value = found.value;
        const auto where = [&] {
            return fmt::format("at face {}, (u,v) = ({:.6g}, {:.6g}), t = {:.6g} s", point.face, point.uv.x, point.uv.y,
                               time);
        };
        if (found.hasTooManyTurns)
            fail(Failure::device, "{}: loops take more than {} turns {}: does one never end?", name_,
                 kMostFunctionTurns, where());
        if (!std::isfinite(value))
            fail(Failure::input, "{}: height is {} {}", name_, std::isnan(value) ? NAN : value, where());
        if (stated_ && std::abs(value) > *stated_ * (1 + 1e-5))
            fail(Failure::input, "{}: height is {:.6g} {}, more than its bound {:.6g}: raise kBound or --height-bound",
                 name_, value, where(), *stated_);
    }

    void add(const MeasuredPoint& point, const FunctionValue& found) {
        const double value = found.value;
        if (!std::isfinite(value)) return; // at a time that is not drawn
        largest_ = std::max(largest_, std::abs(value - mid_));
        lowest_[std::size_t(point.face)] = std::min(lowest_[std::size_t(point.face)], value);
        highest_[std::size_t(point.face)] = std::max(highest_[std::size_t(point.face)], value);
    }

    [[nodiscard]] double largest() const { return largest_; } ///< of |value - mid|
    [[nodiscard]] std::vector<float> ranges(double scale) const {
        std::vector<float> ranges;
        ranges.reserve(lowest_.size());
        for (std::size_t face = 0; face < lowest_.size(); ++face)
            ranges.push_back(float(std::abs(scale) * std::max(highest_[face] - lowest_[face], 0.0)));
        return ranges;
    }

private:
    const std::string& name_;
    std::optional<double> stated_;
    double mid_, largest_ = 0;
    std::vector<double> lowest_, highest_; ///< per face
};

std::optional<double> findStatedBound(FunctionEvaluator& evaluator, const HeightFunction& function,
                                      const HeightDesc& desc) {
    if (desc.functionBound || !function.statesBound()) return desc.functionBound;
    const double bound = evaluator.bound();
    if (!(bound >= 0 && std::isfinite(bound)))
        fail(Failure::input, "{}: kBound is {}; it is the largest absolute value that height() returns",
             function.name(), bound);
    return bound;
}

void checkSize(const LoadedObject& object, double bound) {
    constexpr double kMost = 1 << 20;
    const double size = summarize(object.cage).bounds.longestSide() / object.cage.coordinates.unit;
    if (size > 0 && !(bound <= kMost * size))
        fail(Failure::usage,
             "{}: heights of up to {:.3g} on a cage {:.3g} large are too much for 32-bit floats; lower "
             "--scale",
             object.function->function->name(), bound, size);
}

} // namespace

FunctionHeights loadFunction(const ObjectDesc& desc, const Cage& cage) {
    FunctionHeights heights;
    heights.function = shareHeightFunction(readHeightFunction(desc.height.function));
    heights.movesSurface = desc.height.detail != Detail::bump;
    heights.bendsNormals = desc.height.detail == Detail::bump || desc.height.detail == Detail::both;
    heights.unit = cage.coordinates.unit;
    heights.scale = desc.height.scale.value_or(1) / heights.unit;
    heights.mid = desc.height.mid.value_or(0);
    heights.step = float(kStepShare * computeBounds(cage.positions).diagonal());
    return heights;
}

void measureFunction(Device& device, LoadedObject& object, const HeightDesc& desc, std::span<const double> times,
                     const Warn& warn, std::span<const double> steadyTimes) {
    if (!object.function) return;
    FunctionHeights& heights = *object.function;
    const HeightFunction& function = *heights.function;
    FunctionEvaluator evaluator(device, function);
    const std::optional<double> stated = findStatedBound(evaluator, function, desc);

    // Points all over the surface at rest.
    const bool isMeasuredApart = !steadyTimes.empty();
    const std::size_t timeCount = std::max<std::size_t>(isMeasuredApart ? steadyTimes.size() : times.size(), 1);
    MeasuredPoints points = object.dense ? spreadOverMesh(object, heights.unit, kMeasuredPoints / timeCount)
                                         : spreadOverSurface(object, heights.unit, kMeasuredPoints / timeCount);

    // Values are checked at times that are drawn, and measured at those that do not depend on which are drawn; where
    // the two agree, they are evaluated once.
    Census census(function, stated, heights.mid, points.faceCount);
    std::set<double> all(times.begin(), times.end());
    all.insert(steadyTimes.begin(), steadyTimes.end());
    for (const double time : all) {
        for (FunctionPoint& point : points.given) point.t = float(time);
        const std::vector<FunctionValue> values = evaluator.evaluate(points.given);
        const bool isChecked = std::ranges::count(times, time) > 0;
        const bool isMeasured = !isMeasuredApart || std::ranges::count(steadyTimes, time) > 0;
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (isChecked) census.check(points.at[i], time, values[i]);
            if (isMeasured) census.add(points.at[i], values[i]);
        }
    }
    const double bound =
        std::abs(heights.scale) * (stated ? *stated + std::abs(heights.mid) : kMargin * census.largest());
    checkSize(object, bound);
    heights.bound = float(bound);
    if (heights.movesSurface) heights.faceRanges = census.ranges(heights.scale);
    if (!stated)
        warn(fmt::format(
            "{}: states no kBound; the largest height at {} points is {:.4g}, and heights are clamped to a "
            "quarter more, {:.4g}",
            function.name(), points.at.size() * timeCount, heights.unit * bound / kMargin, heights.unit * bound));
}

} // namespace relief
