#include "check/gaps.h"

#include <cmath>
#include <limits>

#include "base/point_tree.h"

namespace relief {
namespace {

constexpr double kNowhere = std::numeric_limits<double>::infinity();

double largest(const dvec3& v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

/// The largest difference of two points in any coordinate.
double apart(const vec3& a, const vec3& b) { return largest(dvec3(a) - dvec3(b)); }

/// The unit in the last place of the largest coordinate of both points.
double ulpOf(const vec3& a, const vec3& b) {
    const auto magnitude = float(std::max(largest(dvec3(a)), largest(dvec3(b))));
    return double(std::nextafter(magnitude, std::numeric_limits<float>::infinity())) - magnitude;
}

// --- gaps

struct Gap {
    double distance = kNowhere;
    vec3 from{0}, to{0}; ///< the ends that are farthest apart
};

Gap gapBetween(const vec3& a, const vec3& b, const vec3& c, const vec3& d) {
    const double ac = apart(a, c), bd = apart(b, d);
    return ac > bd ? Gap{ac, a, c} : Gap{bd, b, d};
}

/// The gap between two edges, end to end, in the direction in which it is smaller.
Gap gapBetween(const LoneEdge& e, const LoneEdge& f) {
    const Gap same = gapBetween(e.ends[0], e.ends[1], f.ends[0], f.ends[1]);
    const Gap turned = gapBetween(e.ends[0], e.ends[1], f.ends[1], f.ends[0]);
    return same.distance <= turned.distance ? same : turned;
}

dvec3 middleOf(const LoneEdge& edge) { return 0.5 * (dvec3(edge.ends[0]) + dvec3(edge.ends[1])); }

PointTree treeOfMiddles(std::span<const LoneEdge> edges) {
    std::vector<dvec3> middles;
    middles.reserve(edges.size());
    for (const LoneEdge& edge : edges) middles.push_back(middleOf(edge));
    return PointTree(std::move(middles));
}

/// The gap from edge `self` to the nearest other one. Middles of edges are never farther apart than the ends.
Gap nearestGap(const PointTree& middles, std::span<const LoneEdge> edges, std::uint32_t self) {
    const LoneEdge& edge = edges[self];
    Gap best{.distance = apart(edge.ends[0], edge.ends[1]), .from = edge.ends[0], .to = edge.ends[1]};
    const auto distance = [&](const Bounds& box) {
        return largest(glm::max(glm::max(box.lower - middles[self], middles[self] - box.upper), dvec3(0)));
    };
    middles.search(distance, best.distance, [&](std::uint32_t other) {
        if (other == self) return;
        const Gap gap = gapBetween(edge, edges[other]);
        if (gap.distance < best.distance) best = gap;
    });
    return best;
}

void findLargestGap(std::span<const LoneEdge> edges, std::size_t askedCount, Watertightness& result) {
    const PointTree middles = treeOfMiddles(edges);
    for (std::uint32_t i = 0; i < askedCount; ++i) {
        const Gap gap = nearestGap(middles, edges, i);
        const auto ulps = float(gap.distance / ulpOf(gap.from, gap.to));
        if (ulps <= result.largestGapUlps) continue;
        result.largestGapUlps = ulps;
        result.worstLocation = gap.from;
    }
}

// --- T-junctions

/// How much a point that was rounded on its way may miss the line, and how much it must keep from its ends.
constexpr double kLineUlps = 4;

/// An edge with what it takes to ask for points on it.
struct Carrier {
    dvec3 start, along;
    double length, tolerance;

    explicit Carrier(const LoneEdge& edge)
        : start(edge.ends[0]), along(dvec3(edge.ends[1]) - start), length(glm::length(along)),
          tolerance(kLineUlps * ulpOf(edge.ends[0], edge.ends[1])) {
        along /= length;
    }

    [[nodiscard]] bool holds(const dvec3& point) const {
        const dvec3 offset = point - start;
        const double x = glm::dot(offset, along);
        return x > tolerance && x < length - tolerance && glm::length(offset - x * along) <= tolerance;
    }

    /// 0 when the edge passes within tolerance of the box, else infinite (slab test).
    [[nodiscard]] double distanceTo(const Bounds& box) const {
        double first = 0, last = length;
        for (int axis = 0; axis < 3; ++axis) {
            const double lower = box.lower[axis] - tolerance - start[axis];
            const double upper = box.upper[axis] + tolerance - start[axis];
            if (along[axis] == 0) {
                if (lower > 0 || upper < 0) return kNowhere;
                continue;
            }
            const double a = lower / along[axis], b = upper / along[axis];
            first = std::max(first, std::min(a, b));
            last = std::min(last, std::max(a, b));
        }
        return first <= last ? 0 : kNowhere;
    }
};

std::vector<dvec3> distinctEnds(std::span<const LoneEdge> edges) {
    std::vector<dvec3> ends;
    ends.reserve(2 * edges.size());
    for (const LoneEdge& edge : edges) ends.insert(ends.end(), {dvec3(edge.ends[0]), dvec3(edge.ends[1])});
    std::sort(ends.begin(), ends.end(),
              [](const dvec3& a, const dvec3& b) { return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z); });
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    return ends;
}

/// Ends of `open` edges inside any of the `carriers`.
void countTJunctions(std::span<const LoneEdge> open, std::initializer_list<std::span<const LoneEdge>> carriers,
                     Watertightness& result) {
    const std::vector<dvec3> ends = distinctEnds(open);
    const PointTree tree(ends);
    std::vector<char> isInside(ends.size(), 0);
    constexpr double kInside = 0;
    for (const auto edges : carriers)
        for (const LoneEdge& edge : edges) {
            const Carrier carrier(edge);
            tree.search([&](const Bounds& box) { return carrier.distanceTo(box); }, kInside,
                        [&](std::uint32_t point) { isInside[point] |= char(carrier.holds(ends[point])); });
        }
    result.tJunctions = std::uint64_t(std::count(isInside.begin(), isInside.end(), 1));
}

} // namespace

void diagnoseGaps(std::span<const LoneEdge> open, std::span<const LoneEdge> boundary, Watertightness& result) {
    if (open.empty()) return;
    const auto diagnosed = [](std::span<const LoneEdge> edges) {
        return edges.first(std::min(edges.size(), kMostDiagnosedEdges));
    };
    std::vector<LoneEdge> all(open.begin(), open.end());
    all.insert(all.end(), boundary.begin(), boundary.end());
    findLargestGap(all, diagnosed(open).size(), result);
    countTJunctions(open, {diagnosed(open), diagnosed(boundary)}, result);
}

} // namespace relief
