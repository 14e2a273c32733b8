#include "geometry_image/cut.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>

namespace relief {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();

/// What is nearest comes first; ties by number, so that results do not depend on the library.
using Nearest = std::pair<double, std::uint32_t>;
using NearestFirst = std::priority_queue<Nearest, std::vector<Nearest>, std::greater<>>;

/// Dijkstra's algorithm over the copies of a disk, along edges inside of it. Routes pass no copy on the border.
class RouteSearch {
public:
    RouteSearch(const CutMesh& mesh, const Disk& disk)
        : mesh_(mesh), disk_(disk), distances_(disk.vertexCount(), kFar), arrivals_(disk.vertexCount(), kNone) {}

    /// Searches from a copy until `isGoal` is true of one, which it returns; kNone within `limit`.
    /// Without a goal it returns the copy that is farthest away.
    std::uint32_t search(std::uint32_t start, double limit, const std::function<bool(std::uint32_t)>& isGoal) {
        start_ = start;
        distances_[start] = 0;
        NearestFirst next;
        next.emplace(0, start);
        std::uint32_t last = start;
        while (!next.empty()) {
            const auto [distance, v] = next.top();
            next.pop();
            if (distance > distances_[v]) continue;
            if (distance >= limit) return kNone;
            last = v;
            if (v != start && isGoal && isGoal(v)) return v;
            if (v != start && disk_.isOnBorder[v] != 0) continue;
            for (const std::uint32_t h : disk_.edgesFrom(v)) {
                if (mesh_.isBorder(h)) continue;
                const std::uint32_t to = disk_.corners[nextOf(h)];
                const double there = distance + mesh_.length(h);
                if (there >= distances_[to]) continue;
                distances_[to] = there, arrivals_[to] = h;
                next.emplace(there, to);
            }
        }
        return isGoal ? kNone : last;
    }

    [[nodiscard]] Route routeTo(std::uint32_t end) const {
        Route route{{}, distances_[end]};
        for (std::uint32_t v = end; v != start_; v = disk_.corners[route.halfEdges.back()])
            route.halfEdges.push_back(arrivals_[v]);
        std::ranges::reverse(route.halfEdges);
        return route;
    }

private:
    const CutMesh& mesh_;
    const Disk& disk_;
    std::vector<double> distances_;
    std::vector<std::uint32_t> arrivals_; ///< the half-edge of the route that ends at each copy
    std::uint32_t start_ = 0;
};

dvec3 centerOf(const CutMesh& mesh, std::uint32_t triangle) {
    dvec3 sum(0);
    for (std::uint32_t k = 0; k < 3; ++k) sum += mesh.positions[mesh.corners[3 * triangle + k]];
    return sum / 3.0;
}

/// Cuts all edges but those that a disk crosses as it grows from the first triangle, nearest triangles first.
void growDisk(CutMesh& mesh) {
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) mesh.isCut[h] = char(mesh.twins[h] != kNone);
    std::vector<double> distances(mesh.halfEdgeCount() / 3, kFar);
    std::vector<std::uint32_t> arrivals(distances.size(), kNone);
    std::vector<char> isInside(distances.size(), 0);
    NearestFirst next;
    next.emplace(0, 0);
    distances[0] = 0;
    while (!next.empty()) {
        const std::uint32_t t = next.top().second;
        next.pop();
        if (isInside[t] != 0) continue;
        isInside[t] = 1;
        if (arrivals[t] != kNone) mesh.setCut(arrivals[t], false);
        for (std::uint32_t h = 3 * t; h < 3 * t + 3; ++h) {
            if (mesh.twins[h] == kNone) continue;
            const std::uint32_t other = mesh.twins[h] / 3;
            const double there = distances[t] + glm::length(centerOf(mesh, other) - centerOf(mesh, t));
            if (isInside[other] != 0 || there >= distances[other]) continue;
            distances[other] = there, arrivals[other] = h;
            next.emplace(there, other);
        }
    }
}

/// Removes cuts that end inside of the surface, one edge after another.
void removeEnds(CutMesh& mesh) {
    // Per vertex: how many border edges there are, and all of their numbers in one, so that a single one is known.
    std::vector<std::uint32_t> counts(mesh.positions.size(), 0), edges(mesh.positions.size(), 0);
    const auto toggle = [&](std::uint32_t h, int change) {
        for (const std::uint32_t v : {mesh.from(h), mesh.to(h)}) {
            counts[v] += std::uint32_t(change);
            edges[v] ^= std::min(h, mesh.twins[h]);
        }
    };
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h)
        if (mesh.isBorder(h) && h < mesh.twins[h]) toggle(h, 1);
    std::vector<std::uint32_t> ends;
    for (std::uint32_t v = 0; v < counts.size(); ++v)
        if (counts[v] == 1) ends.push_back(v);
    while (!ends.empty()) {
        const std::uint32_t v = ends.back();
        ends.pop_back();
        if (counts[v] != 1) continue;
        const std::uint32_t h = edges[v], other = mesh.from(h) == v ? mesh.to(h) : mesh.from(h);
        mesh.setCut(h, false);
        toggle(h, -1);
        if (counts[other] == 1) ends.push_back(other);
    }
}

void cutRoute(CutMesh& mesh, const Route& route) {
    for (const std::uint32_t h : route.halfEdges) mesh.setCut(h, true);
}

/// Between two points of a closed surface that are far apart.
void cutSphere(CutMesh& mesh) {
    const Disk whole = cutOpen(mesh);
    const std::uint32_t a = RouteSearch(mesh, whole).search(0, kFar, {});
    RouteSearch search(mesh, whole);
    cutRoute(mesh, search.routeTo(search.search(a, kFar, {})));
}

/// Replaces one path by a shorter one on its side of the cut. False where there is none.
bool shortenPath(CutMesh& mesh, const Disk& disk, const BorderPath& path) {
    const std::uint32_t start = disk.corners[path.halfEdges.front()];
    const std::uint32_t end = disk.corners[nextOf(path.halfEdges.back())];
    if (start == end) return false;
    RouteSearch search(mesh, disk);
    constexpr double kGain = 1 - 1e-6;
    if (search.search(start, kGain * path.length, [end](std::uint32_t v) { return v == end; }) == kNone) return false;
    for (const std::uint32_t h : path.halfEdges) mesh.setCut(h, false);
    cutRoute(mesh, search.routeTo(end));
    return true;
}

} // namespace

void cutToDisk(CutMesh& mesh) {
    growDisk(mesh);
    removeEnds(mesh);
    bool hasBorder = false;
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount() && !hasBorder; ++h) hasBorder = mesh.isBorder(h);
    if (!hasBorder) cutSphere(mesh);
}

void shortenPaths(CutMesh& mesh) {
    constexpr int kRounds = 4;
    constexpr std::size_t kManyPaths = 400; // of which each costs a walk over the surface
    bool isShorter = true;
    for (int round = 0; round < kRounds && isShorter; ++round) {
        isShorter = false;
        Disk disk = cutOpen(mesh);
        std::vector<BorderPath> paths = walkBorder(mesh, disk);
        const std::size_t count = std::min(paths.size(), kManyPaths);
        for (std::size_t i = 0; i < count; ++i) {
            if (paths[i].mate == i || !shortenPath(mesh, disk, paths[i])) continue;
            isShorter = true;
            disk = cutOpen(mesh);
            paths = walkBorder(mesh, disk);
            RELIEF_CHECK(paths.size() >= count);
        }
    }
}

Route findRouteToBorder(const CutMesh& mesh, const Disk& disk, std::uint32_t start) {
    RouteSearch search(mesh, disk);
    const std::uint32_t end = search.search(start, kFar, [&](std::uint32_t v) { return disk.isOnBorder[v] != 0; });
    return end == kNone ? Route{} : search.routeTo(end);
}

} // namespace relief
