#include "geometry_image/border.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>

namespace relief {
namespace {

/// Segments of paths that a mesh of the coarsest mip needs so that no two of its edges are one.
int fewestSegments(const CutMesh& mesh, const BorderPath& path) {
    return mesh.from(path.halfEdges.front()) == mesh.to(path.halfEdges.back()) ? 3 : 2;
}

/// How often a path is on the border.
int timesOf(std::span<const BorderPath> paths, std::size_t p) { return paths[p].mate == p ? 1 : 2; }

/// The smallest number of segments per side that halving `size - 1` ends with and that holds all paths well.
int chooseSide(const CutMesh& mesh, std::span<const BorderPath> paths, int size, const std::string& name) {
    constexpr int kFewest = 8;
    int needed = 0;
    for (const BorderPath& path : paths) needed += fewestSegments(mesh, path);
    int side = size - 1;
    while (side % 2 == 0 && side / 2 >= kFewest && 2 * needed <= 4 * (side / 2)) side /= 2;
    if (needed > 4 * side)
        fail(Failure::input,
             "{}: its cut has {} paths, for which an image of {} samples per side is too small; use --size {}", name,
             paths.size(), size, std::bit_ceil(unsigned(needed)) / 2 + 1);
    return side;
}

/// Shares the border's segments out by length, with at least the fewest for each path.
std::vector<int> allotSegments(const CutMesh& mesh, std::span<const BorderPath> paths, int side) {
    double length = 0;
    for (const BorderPath& path : paths) length += path.length;
    std::vector<int> counts(paths.size(), 0);
    std::vector<double> ideals(paths.size(), 0);
    int left = 4 * side;
    const auto add = [&](std::size_t p, int change) {
        counts[p] += change;
        if (paths[p].mate != p) counts[paths[p].mate] += change;
        left -= change * timesOf(paths, p);
    };
    for (std::size_t p = 0; p < paths.size(); ++p) {
        ideals[p] = 4 * side * paths[p].length / length;
        if (paths[p].mate < p) continue;
        add(p, std::max(fewestSegments(mesh, paths[p]), int(ideals[p])));
    }
    // Those that lack most get one more, those that have most in excess one less. Pairs change by two: where one
    // segment is left over, a path without a mate takes it; where one is too many and no such path can give it, a pair
    // gives two and such a path takes one back.
    while (left != 0) {
        std::size_t best = paths.size();
        double most = -std::numeric_limits<double>::infinity();
        for (std::size_t p = 0; p < paths.size(); ++p) {
            if (paths[p].mate < p) continue;
            if (left > 0 && timesOf(paths, p) > left) continue;
            if (left < 0 && counts[p] <= fewestSegments(mesh, paths[p])) continue;
            const double lastChoice = left == -1 && timesOf(paths, p) == 2 ? 8.0 * side : 0;
            const double need = (left > 0 ? 1 : -1) * (ideals[p] - counts[p]) - lastChoice;
            if (need > most) most = need, best = p;
        }
        RELIEF_CHECK(best < paths.size());
        add(best, left > 0 ? 1 : -1);
    }
    return counts;
}

/// Where the first path starts: 0 to side - 1.
int chooseFirst(const CutMesh& mesh, const SquareBorder& border) {
    const int side = border.sewing.sideSegments;
    int best = 0;
    double bestScore = -1;
    for (int first = 0; first < side; ++first) {
        int at = first, nearestEnd = side, cornersMet = 0;
        for (std::size_t p = 0; p < border.paths.size(); ++p) {
            const int past = at % side, toCorner = std::min(past, side - past);
            const std::size_t before = (p + border.paths.size() - 1) % border.paths.size();
            if (border.paths[p].mate == before && before != p) nearestEnd = std::min(nearestEnd, toCorner);
            if (mesh.isCorner[mesh.from(border.paths[p].halfEdges.front())] != 0 && toCorner == 0) ++cornersMet;
            at += border.sewing.paths[p].segments;
        }
        const double score = nearestEnd + 0.01 * cornersMet;
        if (score > bestScore) bestScore = score, best = first;
    }
    return best;
}

SquareBorder makeSquareBorder(const CutMesh& mesh, int size, const std::string& name) {
    SquareBorder border{.disk = cutOpen(mesh)};
    border.paths = walkBorder(mesh, border.disk);
    border.sewing.sideSegments = chooseSide(mesh, border.paths, size, name);
    const std::vector<int> counts = allotSegments(mesh, border.paths, border.sewing.sideSegments);
    for (std::size_t p = 0; p < border.paths.size(); ++p)
        border.sewing.paths.push_back({counts[p], int(border.paths[p].mate)});
    border.sewing.first = chooseFirst(mesh, border);
    return border;
}

/// A half-edge of the border and where it lies, in segments from the lower left corner.
using OnBorder = std::function<void(std::uint32_t h, double from, double to)>;

void forEachOnBorder(const CutMesh& mesh, const SquareBorder& border, const OnBorder& visit) {
    int first = border.sewing.first;
    for (std::size_t p = 0; p < border.paths.size(); ++p) {
        const BorderPath& path = border.paths[p];
        const int segments = border.sewing.paths[p].segments;
        double walked = 0;
        for (const std::uint32_t h : path.halfEdges) {
            const double next = h == path.halfEdges.back() ? path.length : walked + mesh.length(h);
            const double scale = path.length > 0 ? segments / path.length : 0;
            visit(h, first + walked * scale, first + next * scale);
            walked = next;
        }
        first += segments;
    }
}

constexpr double kAtCorner = 1e-6; ///< segments within which a vertex lies in a corner of the square

/// Splits the first edge that a corner of the square falls into; false where there is none.
bool splitAtCorner(CutMesh& mesh, const SquareBorder& border) {
    const int side = border.sewing.sideSegments;
    std::uint32_t edge = kNone;
    double fraction = 0;
    forEachOnBorder(mesh, border, [&](std::uint32_t h, double from, double to) {
        const double corner = side * std::ceil((from + kAtCorner) / side);
        if (edge != kNone || corner > to - kAtCorner) return;
        edge = h, fraction = (corner - from) / (to - from);
    });
    if (edge != kNone) mesh.split(edge, fraction);
    return edge != kNone;
}

/// Splits the edges inside of the disk whose ends are both on its border; false where there are none.
bool splitChords(CutMesh& mesh, const Disk& disk) {
    const std::uint32_t before = mesh.halfEdgeCount();
    std::vector<char> isOnBorder(before); // per half-edge: its start
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) isOnBorder[h] = disk.isOnBorder[disk.corners[h]];
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) {
        if (mesh.isBorder(h) || isOnBorder[h] == 0 || isOnBorder[nextOf(h)] == 0) continue;
        const std::uint32_t twin = mesh.twins[h], next = nextOf(h), nextOfTwin = nextOf(twin);
        // The new triangles (m, b, c) behind those that are there.
        isOnBorder.insert(isOnBorder.end(), {0, isOnBorder[next], isOnBorder[previousOf(h)]});
        isOnBorder.insert(isOnBorder.end(), {0, isOnBorder[nextOfTwin], isOnBorder[previousOf(twin)]});
        isOnBorder[next] = isOnBorder[nextOfTwin] = 0;
        mesh.split(h, 0.5);
    }
    RELIEF_CHECK(isOnBorder.size() == mesh.halfEdgeCount());
    return mesh.halfEdgeCount() > before;
}

} // namespace

SquareBorder fitSquare(CutMesh& mesh, int size, const std::string& name) {
    SquareBorder border = makeSquareBorder(mesh, size, name);
    // Splits change the numbers of half-edges, so that the border is walked again after them.
    constexpr int kMostSplits = 16;
    for (int splits = 0; splitAtCorner(mesh, border) || splitChords(mesh, border.disk); ++splits) {
        RELIEF_CHECK(splits < kMostSplits);
        border = makeSquareBorder(mesh, size, name);
    }
    return border;
}

std::vector<dvec2> placeOnSquare(const CutMesh& mesh, const SquareBorder& border) {
    const int side = border.sewing.sideSegments;
    std::vector<dvec2> st(border.disk.vertexCount(), dvec2(0));
    forEachOnBorder(mesh, border, [&](std::uint32_t h, double from, double) {
        double at = std::fmod(from, 4.0 * side) / side;
        const double corner = std::round(at);
        if (std::abs(at - corner) * side < 2 * kAtCorner) at = corner;
        const int sideNumber = int(at) % 4;
        const double along = at - std::floor(at);
        const dvec2 points[4] = {{along, 0}, {1, along}, {1 - along, 1}, {0, 1 - along}};
        st[border.disk.corners[h]] = points[sideNumber];
    });
    return st;
}

} // namespace relief
