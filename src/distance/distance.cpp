#include <algorithm>
#include <array>
#include <cmath>
#include <future>
#include <limits>
#include <numeric>
#include <thread>

#include "distance/closest.h"

namespace relief {
/// Points spread over a surface.
struct Samples {
    std::vector<dvec3> points;
    std::vector<double> weights; ///< area that each stands for
    double coverage = 0;
};

namespace {

/// Part i of a triangle that is cut into n * n, by corner weights: rows from the third corner's side, upright triangles
/// first.
std::array<dvec2, 3> partOf(std::uint32_t i, std::uint32_t n) {
    std::uint32_t row = 0;
    for (; i >= 2 * (n - row) - 1; ++row) i -= 2 * (n - row) - 1;
    const bool isTurned = i >= n - row;
    const std::uint32_t column = isTurned ? i - (n - row) : i;
    const dvec2 at = dvec2(column, row) / double(n);
    const double step = 1.0 / n;
    if (isTurned) return {at + dvec2(step, step), at + dvec2(0, step), at + dvec2(step, 0)};
    return {at, at + dvec2(step, 0), at + dvec2(0, step)};
}

/// Number `index` of the R2 sequence, folded into the triangle (0,0) (1,0) (0,1): Roberts, "The unreasonable
/// effectiveness of quasirandom sequences", 2018.
dvec2 sequencePoint(std::size_t index) {
    constexpr double kPlastic = 1.32471795724474602596; // the real root of x^3 = x + 1
    const double n = double(index) + 1;
    dvec2 point(n / kPlastic, n / (kPlastic * kPlastic));
    point -= glm::floor(point);
    return point.x + point.y > 1 ? 1.0 - point : point;
}

/// A third dimension of the sequence, which chooses a triangle of a group.
double sequenceShare(std::size_t index) {
    constexpr double kGolden = 0.61803398874989484820;
    const double x = (double(index) + 0.5) * kGolden;
    return x - std::floor(x);
}

class Sampler {
public:
    Sampler(const ClosestPoints& surface, std::size_t wanted)
        : surface_(surface), wanted_(std::max<std::size_t>(wanted, 1)) {}

    Samples sample() {
        const std::size_t triangleCount = surface_.indices().size() / 3;
        if (triangleCount >= wanted_)
            sampleGroups(triangleCount);
        else
            sampleParts(triangleCount);
        double area = 0;
        for (const double weight : samples_.weights) area += weight;
        if (!(area > 0)) fail(Failure::input, "the surface of {} triangles has no area to measure", triangleCount);
        return std::move(samples_);
    }

private:
    using Corners = std::array<dvec3, 3>;

    [[nodiscard]] Corners cornersOf(std::size_t triangle) const {
        Corners corners;
        for (std::size_t i = 0; i < 3; ++i)
            corners[i] = dvec3(surface_.positions()[surface_.indices()[3 * triangle + i]]);
        return corners;
    }
    static double areaOf(const Corners& c) { return 0.5 * glm::length(glm::cross(c[1] - c[0], c[2] - c[0])); }
    static double longestSideOf(const Corners& c) {
        return std::max({glm::distance(c[0], c[1]), glm::distance(c[1], c[2]), glm::distance(c[2], c[0])});
    }
    static dvec3 at(const Corners& c, const dvec2& w) { return c[0] + w.x * (c[1] - c[0]) + w.y * (c[2] - c[0]); }

    void add(const dvec3& point, double area, std::span<const dvec3> covered) {
        samples_.points.push_back(point);
        samples_.weights.push_back(area);
        for (const dvec3& p : covered) samples_.coverage = std::max(samples_.coverage, glm::distance(p, point));
    }

    static std::uint32_t partsOf(const Corners& corners, double length) {
        return std::uint32_t(std::clamp(std::ceil(longestSideOf(corners) / length), 1.0, 4096.0));
    }

    /// The longest part for which there are about as many as wanted.
    [[nodiscard]] double partLength(std::size_t triangleCount) const {
        double longest = 0;
        for (std::size_t t = 0; t < triangleCount; ++t) longest = std::max(longest, longestSideOf(cornersOf(t)));
        double low = longest / 4096, high = longest; // the count falls with the length
        for (int step = 0; step < 20 && low > 0; ++step) {
            const double length = std::sqrt(low * high);
            std::size_t count = 0;
            for (std::size_t t = 0; t < triangleCount; ++t) {
                const std::size_t n = partsOf(cornersOf(t), length);
                count += n * n;
            }
            (count > wanted_ ? low : high) = length;
        }
        return high > 0 ? high : 1;
    }

    void sampleParts(std::size_t triangleCount) {
        const double length = partLength(triangleCount);
        for (std::size_t t = 0; t < triangleCount; ++t) {
            const Corners corners = cornersOf(t);
            const std::uint32_t n = partsOf(corners, length);
            for (std::uint32_t i = 0; i < n * n; ++i) {
                const std::array<dvec2, 3> part = partOf(i, n);
                const Corners ofPart{at(corners, part[0]), at(corners, part[1]), at(corners, part[2])};
                add(at(ofPart, sequencePoint(samples_.points.size())), areaOf(corners) / (double(n) * n), ofPart);
            }
        }
    }

    void sampleGroups(std::size_t triangleCount) {
        for (std::size_t group = 0; group < wanted_; ++group) {
            const std::size_t first = group * triangleCount / wanted_, end = (group + 1) * triangleCount / wanted_;
            std::vector<dvec3> covered;
            double area = 0;
            for (std::size_t t = first; t < end; ++t) {
                const Corners corners = cornersOf(t);
                covered.insert(covered.end(), corners.begin(), corners.end());
                area += areaOf(corners);
            }
            double left = sequenceShare(group) * area;
            std::size_t chosen = first;
            for (; chosen + 1 < end; ++chosen) {
                left -= areaOf(cornersOf(chosen));
                if (left < 0) break;
            }
            add(at(cornersOf(chosen), sequencePoint(group)), area, covered);
        }
    }

    const ClosestPoints& surface_;
    std::size_t wanted_;
    Samples samples_;
};

/// The smallest distance within which samples of that area are.
double distanceOfShare(const std::vector<double>& distances, const std::vector<double>& weights, double area) {
    std::vector<std::size_t> order(distances.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    std::ranges::sort(order, {}, [&](std::size_t i) { return distances[i]; });
    for (const std::size_t i : order)
        if (area -= weights[i]; area <= 0) return distances[i];
    return distances[order.back()];
}

/// Calls `work(first, end)` for stretches of 0..count, one per core; in turn where no more threads can be started.
void onAllCores(std::size_t count, const std::function<void(std::size_t first, std::size_t end)>& work) {
    const std::size_t partCount = std::max(1u, std::thread::hardware_concurrency());
    std::vector<std::future<void>> parts;
    for (std::size_t i = 0; i < partCount; ++i)
        parts.push_back(std::async([&, i] { work(i * count / partCount, (i + 1) * count / partCount); }));
    for (std::future<void>& part : parts) part.get();
}

} // namespace

struct MeasuredSurface::Parts {
    ClosestPoints points;
    Samples samples;
    double area = 0;

    Parts(std::vector<vec3> positions, std::vector<std::uint32_t> indices, std::size_t sampleCount, TreeUse use)
        : points(std::move(positions), std::move(indices), use), samples(Sampler(points, sampleCount).sample()) {
        for (const double weight : samples.weights) area += weight;
    }
};

MeasuredSurface::MeasuredSurface(const TriangleView& triangles, std::size_t sampleCount, TreeUse use)
    : parts_(std::make_unique<Parts>(std::vector(triangles.positions.begin(), triangles.positions.end()),
                                     std::vector(triangles.indices.begin(), triangles.indices.end()), sampleCount,
                                     use)) {}
MeasuredSurface::MeasuredSurface(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
MeasuredSurface MeasuredSurface::ofMesh(TriangleMesh mesh, std::size_t sampleCount, TreeUse use) {
    return MeasuredSurface(
        std::make_unique<Parts>(std::move(mesh.positions), std::move(mesh.indices), sampleCount, use));
}
MeasuredSurface::~MeasuredSurface() = default;
MeasuredSurface::MeasuredSurface(MeasuredSurface&&) noexcept = default;
MeasuredSurface& MeasuredSurface::operator=(MeasuredSurface&&) noexcept = default;

double MeasuredSurface::distance(const dvec3& p, double limit) const { return parts_->points.distance(p, limit); }
NearestPoint MeasuredSurface::nearest(const dvec3& p) const { return parts_->points.nearest(p); }
std::optional<LineHit> MeasuredSurface::nearestOnLine(const dvec3& p, const dvec3& direction, const LineReach& reach,
                                                      Facing facing) const {
    return parts_->points.nearestOnLine(p, direction, reach, facing);
}
bool MeasuredSurface::isBlocked(const dvec3& p, const dvec3& direction, double reach) const {
    return parts_->points.isBlocked(p, direction, reach);
}
TriangleView MeasuredSurface::triangles() const {
    const std::span<const vec3> all = parts_->points.positions(); // one more than there are
    return {all.first(all.size() - 1), parts_->points.indices()};
}
std::size_t MeasuredSurface::sampleCount() const { return parts_->samples.points.size(); }
double MeasuredSurface::coverage() const { return parts_->samples.coverage; }

dvec3 normalAt(const DenseMesh& mesh, const NearestPoint& nearest) {
    std::array<dvec3, 3> corners, normals;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t v = mesh.indices[3 * std::size_t(nearest.triangle) + k];
        corners[k] = dvec3(mesh.positions[v]) - nearest.point, normals[k] = dvec3(mesh.normals[v]);
    }
    // Weights are areas of the triangles between the point and the opposite side.
    const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    dvec3 sum(0);
    for (std::size_t k = 0; k < 3; ++k)
        sum += std::max(0.0, glm::dot(normal, glm::cross(corners[(k + 1) % 3], corners[(k + 2) % 3]))) * normals[k];
    return sum != dvec3(0) ? sum : normals[0] + normals[1] + normals[2];
}

SampledDistance measureOneWay(const MeasuredSurface& from, const MeasuredSurface& to) {
    const Samples& samples = from.parts_->samples;
    std::vector<double> distances(samples.points.size());
    onAllCores(distances.size(), [&](std::size_t first, std::size_t end) {
        // A distance changes by no more than one moves: the last one limits the search for the next.
        double limit = std::numeric_limits<double>::infinity();
        for (std::size_t i = first; i < end; ++i) {
            if (i > first) limit = distances[i - 1] + glm::distance(samples.points[i - 1], samples.points[i]);
            distances[i] = to.parts_->points.distance(samples.points[i], limit);
        }
    });
    SampledDistance result{.coverage = samples.coverage, .sampleCount = distances.size()};
    // Two halves of the samples, whose difference shows how far the sampling is to be trusted.
    double squares[2] = {}, areas[2] = {}, sum = 0;
    for (std::size_t i = 0; i < distances.size(); ++i) {
        squares[i % 2] += samples.weights[i] * distances[i] * distances[i];
        areas[i % 2] += samples.weights[i];
        sum += samples.weights[i] * distances[i];
        result.max = std::max(result.max, distances[i]);
    }
    const double area = areas[0] + areas[1];
    result.share95 = distanceOfShare(distances, samples.weights, 0.95 * area);
    result.mean = sum / area;
    result.rms = std::sqrt((squares[0] + squares[1]) / area);
    if (areas[0] > 0 && areas[1] > 0)
        result.rmsError = 0.5 * std::abs(std::sqrt(squares[0] / areas[0]) - std::sqrt(squares[1] / areas[1]));
    return result;
}

void moveToNearest(const DenseMesh& mesh, const MeasuredSurface& measured, dvec3& position, dvec3& normal) {
    const NearestPoint nearest = measured.nearest(position);
    const dvec3 there = normalAt(mesh, nearest);
    if (glm::dot(there, normal) > 0) position = nearest.point, normal = there;
}

double SurfaceDistance::rms() const { return std::sqrt(0.5 * (forth.rms * forth.rms + back.rms * back.rms)); }
double SurfaceDistance::rmsError() const { return std::max(forth.rmsError, back.rmsError); }
double SurfaceDistance::hausdorff() const { return std::max(forth.max, back.max); }

SurfaceDistance measureDistance(const MeasuredSurface& a, const MeasuredSurface& b) {
    return {measureOneWay(a, b), measureOneWay(b, a)};
}

} // namespace relief
