// How far the faces along an edge disagree about the height there.
#include <algorithm>
#include <cmath>
#include <functional>

#include "check/check.h"

namespace relief {
namespace {

/// Samples along an edge: at least this many, and two per texel, so that no texel is skipped.
constexpr int kFewestSteps = 8, kMostSteps = 512;

/// Texture coordinates nearer than this are the same: they come from two patches in double precision.
constexpr double kSameTexture = 1e-9;

/// Points of edges whose heights are asked for together.
constexpr std::size_t kPointsAtOnce = 1u << 18;

using FacePoint = std::pair<int, dvec2>;

/// Where heights come from, and how many steps of an edge they need for its texture coordinates at three points.
struct HeightSource {
    std::function<std::vector<double>(std::span<const FacePoint>)> heightsAt;
    std::function<double(const dvec2& stStep)> texels;
};

class SeamMeter {
public:
    SeamMeter(const Surface& surface, const ReferenceSurface& reference, HeightSource source)
        : surface_(surface), reference_(reference), source_(std::move(source)) {}

    SeamReport measure() {
        const EdgeIncidences incidences = edgeIncidences(surface_);
        for (std::size_t edge = 0; edge < surface_.edges.size(); ++edge) {
            if (isSeam(incidences.of(edge))) gather(std::uint32_t(edge), incidences.of(edge));
            if (points_.size() > kPointsAtOnce) addGathered();
        }
        addGathered();
        if (report_.length > 0) report_.mean /= report_.length;
        return report_;
    }

private:
    [[nodiscard]] dvec2 pointOf(const Incidence& incidence, double t) const {
        return sidePoint(surface_.sideCount, int(incidence.side),
                         std::lerp(double(incidence.start), double(incidence.end), t));
    }
    [[nodiscard]] dvec2 textureOf(const Incidence& incidence, double t) const {
        return reference_.texture(int(incidence.face), pointOf(incidence, t)).st;
    }

    [[nodiscard]] bool isSeam(std::span<const Incidence> incidences) const {
        for (const Incidence& incidence : incidences.subspan(1))
            for (const double t : {0.0, 0.25, 0.5, 0.75, 1.0}) {
                const dvec2 own = textureOf(incidences.front(), t), other = textureOf(incidence, t);
                const double scale = 1 + std::max(glm::length(own), glm::length(other));
                if (glm::length(own - other) > kSameTexture * scale) return true;
            }
        return false;
    }

    [[nodiscard]] int stepsAlong(std::span<const Incidence> incidences) const {
        double most = 0;
        for (const Incidence& incidence : incidences) {
            const dvec2 a = textureOf(incidence, 0), b = textureOf(incidence, 0.5), c = textureOf(incidence, 1);
            most = std::max(most, source_.texels(b - a) + source_.texels(c - b));
        }
        return int(std::clamp(std::ceil(2 * most), double(kFewestSteps), double(kMostSteps)));
    }
    [[nodiscard]] double lengthOf(const Incidence& incidence) const {
        constexpr int kPieces = 4;
        const auto at = [&](int i) {
            return reference_.limit(int(incidence.face), pointOf(incidence, double(i) / kPieces)).p;
        };
        double length = 0;
        for (int i = 0; i < kPieces; ++i) length += glm::length(at(i + 1) - at(i));
        return length;
    }

    /// Adds the points of an edge: all faces at each step.
    void gather(std::uint32_t edge, std::span<const Incidence> incidences) {
        gathered_.push_back({edge, incidences, stepsAlong(incidences)});
        for (int i = 0; i <= gathered_.back().steps; ++i)
            for (const Incidence& incidence : incidences)
                points_.emplace_back(int(incidence.face), pointOf(incidence, double(i) / gathered_.back().steps));
    }

    void addGathered() {
        const std::vector<double> heights = source_.heightsAt(points_);
        std::size_t first = 0;
        for (const GatheredEdge& edge : gathered_) {
            const std::size_t count = edge.incidences.size() * std::size_t(edge.steps + 1);
            addEdge(edge, std::span(heights).subspan(first, count));
            first += count;
        }
        gathered_.clear();
        points_.clear();
    }

    struct GatheredEdge {
        std::uint32_t number = 0;
        std::span<const Incidence> incidences;
        int steps = 1;
    };

    /// The trapezoidal rule along the edge; report_.mean sums disagreement times length until measure() ends.
    void addEdge(const GatheredEdge& edge, std::span<const double> heights) {
        const auto& [number, incidences, steps] = edge;
        SeamEdge seam{.edge = number};
        double sum = 0;
        for (int i = 0; i <= steps; ++i) {
            // Largest minus smallest height that the faces see.
            const auto [lowest, highest] =
                std::ranges::minmax_element(heights.subspan(std::size_t(i) * incidences.size(), incidences.size()));
            const double t = double(i) / steps, apart = *highest - *lowest;
            sum += i == 0 || i == steps ? 0.5 * apart : apart;
            if (apart > seam.max)
                seam.max = apart, seam.worst = {incidences.front().face, vec2(pointOf(incidences.front(), t))};
        }
        if (seam.max > 0) report_.edges.push_back(seam);
        if (seam.max > report_.max) report_.max = seam.max, report_.worst = seam.worst;
        const double length = lengthOf(incidences.front());
        ++report_.seamEdgeCount;
        report_.length += length;
        report_.mean += sum / steps * length;
    }

    const Surface& surface_;
    const ReferenceSurface& reference_;
    HeightSource source_;
    std::vector<GatheredEdge> gathered_;
    std::vector<FacePoint> points_; ///< of these edges
    SeamReport report_;
};

} // namespace

SeamReport reportSeams(const Surface& surface, const ReferenceSurface& reference, const HeightMap& map) {
    const auto heightsAt = [&](std::span<const FacePoint> points) {
        std::vector<double> heights;
        heights.reserve(points.size());
        for (const auto& [face, uv] : points) heights.push_back(sampleHeight(map, reference.texture(face, uv).st).h);
        return heights;
    };
    const auto texels = [&](const dvec2& st) {
        return std::max(std::abs(st.x) * map.width, std::abs(st.y) * map.height);
    };
    return SeamMeter(surface, reference, {heightsAt, texels}).measure();
}

SeamReport reportSeams(const Surface& surface, const ReferenceSurface& reference, FunctionReference& function) {
    const auto heightsAt = [&](std::span<const FacePoint> points) { return function.heightsAt(points); };
    const auto noTexels = [](const dvec2&) { return 0.0; };
    return SeamMeter(surface, reference, {heightsAt, noTexels}).measure();
}

} // namespace relief
