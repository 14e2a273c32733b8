#include "geometry_image/cut.h"

#include <algorithm>
#include <array>
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

    /// Searches from the nearest of several copies until `isGoal` is true of one, which it returns; kNone where there
    /// is none within `limit`. Without a goal it returns the copy that is farthest away.
    std::uint32_t search(std::span<const std::uint32_t> starts, double limit,
                         const std::function<bool(std::uint32_t)>& isGoal) {
        NearestFirst next;
        for (const std::uint32_t start : starts) {
            distances_[start] = 0;
            next.emplace(0, start);
        }
        std::uint32_t last = kNone;
        while (!next.empty()) {
            const auto [distance, v] = next.top();
            next.pop();
            if (distance > distances_[v]) continue;
            if (distance >= limit) return kNone;
            last = v;
            const bool isStart = arrivals_[v] == kNone;
            if (!isStart && isGoal && isGoal(v)) return v;
            if (!isStart && disk_.isOnBorder[v] != 0) continue;
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
        for (std::uint32_t v = end; arrivals_[v] != kNone; v = disk_.corners[route.halfEdges.back()])
            route.halfEdges.push_back(arrivals_[v]);
        std::ranges::reverse(route.halfEdges);
        return route;
    }

private:
    const CutMesh& mesh_;
    const Disk& disk_;
    std::vector<double> distances_;
    std::vector<std::uint32_t> arrivals_; ///< the half-edge of the route that ends at each copy; kNone at a start
};

dvec3 centerOf(const CutMesh& mesh, std::uint32_t triangle) {
    dvec3 sum(0);
    for (std::uint32_t k = 0; k < 3; ++k) sum += mesh.positions[mesh.corners[3 * triangle + k]];
    return sum / 3.0;
}

/// Cuts all edges but those that a disk crosses as it grows from the first triangle, nearest triangles first.
void growDisk(CutMesh& mesh) {
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) mesh.isCut[h] = char(mesh.twins[h] != kNone);
    // Dijkstra's algorithm over triangles, from the centre of one to that of the next.
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
    const std::uint32_t first = RouteSearch(mesh, whole).search(std::array{0u}, kFar, {});
    RouteSearch search(mesh, whole);
    cutRoute(mesh, search.routeTo(search.search(std::array{first}, kFar, {})));
}

/// Marks the copies along the closed chain of border edges that an edge belongs to.
void markChain(const CutMesh& mesh, const Disk& disk, std::uint32_t h, std::vector<char>& isMarked) {
    isMarked.assign(disk.vertexCount(), 0);
    for (std::uint32_t at = h; isMarked[disk.corners[at]] == 0;) {
        isMarked[disk.corners[at]] = 1;
        for (at = nextOf(at); !mesh.isBorder(at);) at = nextOf(mesh.twins[at]);
    }
}

/// Replaces a path of the border by the shortest route that makes a disk as well. False where there is none.
bool shortenPath(CutMesh& mesh, std::span<const BorderPath> paths, std::size_t p) {
    const BorderPath& path = paths[p];
    const std::size_t after = (p + 1) % paths.size(), afterMate = (path.mate + 1) % paths.size();
    const bool endsInside = after == path.mate, startsInside = afterMate == p;
    if (endsInside && startsInside) return false; // the only path of a sphere
    for (const std::uint32_t h : path.halfEdges) mesh.setCut(h, false);
    const Disk ring = cutOpen(mesh);
    // Without the path the border is two chains, or one and the end of the path inside of it.
    std::vector<char> isGoal;
    std::vector<std::uint32_t> starts;
    if (endsInside || startsInside) {
        const std::uint32_t h = endsInside ? nextOf(path.halfEdges.back()) : path.halfEdges.front();
        starts.push_back(ring.corners[h]);
        isGoal = ring.isOnBorder;
    } else {
        markChain(mesh, ring, paths[after].halfEdges.front(), isGoal);
        for (std::uint32_t v = 0; v < ring.vertexCount(); ++v)
            if (isGoal[v] != 0) starts.push_back(v);
        markChain(mesh, ring, paths[afterMate].halfEdges.front(), isGoal);
    }
    // From one to the other, if that is shorter.
    RouteSearch search(mesh, ring);
    constexpr double kGain = 1 - 1e-6;
    const std::uint32_t end =
        search.search(starts, kGain * path.length, [&](std::uint32_t v) { return isGoal[v] != 0; });
    if (end == kNone)
        for (const std::uint32_t h : path.halfEdges) mesh.setCut(h, true);
    else
        cutRoute(mesh, search.routeTo(end));
    return end != kNone;
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
    constexpr int kMostSearches = 600; // each walks over the surface
    std::vector<BorderPath> paths = walkBorder(mesh, cutOpen(mesh));
    // One path after another, until none has become shorter since it was looked at.
    std::size_t unchanged = 0;
    for (int searches = 0; searches < kMostSearches && unchanged < paths.size(); ++searches) {
        const std::size_t p = std::size_t(searches) % paths.size();
        ++unchanged;
        if (paths[p].mate == p || !shortenPath(mesh, paths, p)) continue;
        paths = walkBorder(mesh, cutOpen(mesh));
        unchanged = 0;
    }
}

Route findRouteToBorder(const CutMesh& mesh, const Disk& disk, std::uint32_t start) {
    RouteSearch search(mesh, disk);
    const std::uint32_t end =
        search.search(std::array{start}, kFar, [&](std::uint32_t v) { return disk.isOnBorder[v] != 0; });
    return end == kNone ? Route{} : search.routeTo(end);
}

} // namespace relief
