// Levels of maps per face: nodes on edges and in corners belong to their owners, and the apron of a tile is what the
// faces across its sides show.
//
//   3 --- side 2 --- 2      Node k of side s, in the side's direction; (i,j) counts along u and v from corner 0.
//   |                |      A level has half the segments of the one before. A node of it is the mean, weighed 1 2 1
// side 3          side 1    along each axis that is halved, of the nodes around it; on edges along the edge alone, and
//   |                |      corners stay: faces with an edge in common then agree on every level.
//   0 --- side 0 --- 1
#include <algorithm>
#include <cmath>

#include "displacement/parallel.h"
#include "displacement/tile_levels.h"

namespace relief {
namespace {

/// Node k of a side of a grid of `last` + 1 nodes each way, `depth` nodes inside of it.
ivec2 nodeOfSide(std::uint32_t side, const ivec2& last, int k, int depth) {
    switch (side) {
    case 0: return {k, depth};
    case 1: return {last.x - depth, k};
    case 2: return {last.x - k, last.y - depth};
    default: return {depth, last.y - k};
    }
}

/// (u,v) at x along a side, `depth` inside of it.
dvec2 pointInside(std::uint32_t side, double x, double depth) {
    switch (side) {
    case 0: return {x, depth};
    case 1: return {1 - depth, x};
    case 2: return {1 - x, 1 - depth};
    default: return {depth, 1 - x};
    }
}

int along(std::uint32_t side, const ivec2& pair) { return side % 2 == 0 ? pair.x : pair.y; }
int acrossOf(std::uint32_t side, const ivec2& pair) { return side % 2 == 0 ? pair.y : pair.x; }

/// Means of one row or column of nodes, `stride` apart.
void halveNodes(std::span<const float> from, std::size_t first, std::size_t stride, int segments,
                std::vector<float>& to) {
    const auto at = [&](int k) { return from[first + std::size_t(k) * stride]; };
    if (segments == 1) {
        to.push_back(at(0)), to.push_back(at(1));
        return;
    }
    to.push_back(at(0));
    for (int k = 2; k < segments; k += 2) to.push_back(0.25f * (at(k - 1) + at(k + 1)) + 0.5f * at(k));
    to.push_back(at(segments));
}

/// The nodes of the next level.
std::vector<float> halvedNodes(std::span<const float> nodes, const ivec2& segments) {
    const auto width = std::size_t(segments.x) + 1;
    std::vector<float> rows, all; // rows are halved first
    for (int j = 0; j <= segments.y; ++j) halveNodes(nodes, std::size_t(j) * width, 1, segments.x, rows);
    const std::size_t halfWidth = rows.size() / (std::size_t(segments.y) + 1);
    std::vector<float> columns;
    for (std::size_t i = 0; i < halfWidth; ++i) halveNodes(rows, i, halfWidth, segments.y, columns);
    const std::size_t halfHeight = columns.size() / halfWidth;
    for (std::size_t j = 0; j < halfHeight; ++j)
        for (std::size_t i = 0; i < halfWidth; ++i) all.push_back(columns[i * halfHeight + j]);
    return all;
}

} // namespace

void TileLevels::addFaces() {
    RELIEF_CHECK(set_.links != nullptr);
    // Level 0 without the apron that the map has.
    forEachAtOnce(tiles_.size(), [&](std::size_t t) {
        const MapTile& tile = set_.tiles[t];
        const int stride = tile.size.x + 2 * kFaceApron;
        std::vector<float> nodes;
        for (int j = 0; j < tile.size.y; ++j) {
            const float* row = &set_.texels[tile.first] + std::ptrdiff_t(j + kFaceApron) * stride + kFaceApron;
            nodes.insert(nodes.end(), row, row + tile.size.x);
        }
        tiles_[t].emplace_back(tile.size, std::move(nodes));
    });
    shareEdges(0);
    // All faces of a level before the next: edges are the owners'.
    std::uint32_t mostLevels = 0;
    for (const MapTile& tile : set_.tiles) mostLevels = std::max(mostLevels, countLevels(set_, tile));
    for (std::uint32_t level = 1; level < mostLevels; ++level) {
        forEachAtOnce(tiles_.size(), [&](std::size_t t) {
            if (level >= countLevels(set_, set_.tiles[t])) return;
            const Grid& fine = tiles_[t].back();
            const ivec2 segments = fine.size - 1, half = glm::max(segments / 2, ivec2(1));
            tiles_[t].emplace_back(half + 1, halvedNodes(fine.own, segments));
        });
        shareEdges(level);
    }
}

/// The level of a face whose segments along a side, or away from it, are nearest to a number.
const TileLevels::Grid& TileLevels::gridNear(std::uint32_t face, double segments, std::uint32_t side,
                                             bool isAlong) const {
    const Grids& grids = tiles_[face];
    const ivec2 logs = set_.tiles[face].segments;
    const double level = std::round((isAlong ? along(side, logs) : acrossOf(side, logs)) - std::log2(segments));
    return grids[std::size_t(std::clamp(level, 0.0, double(grids.size() - 1)))];
}

/// Corners first, then what lies between them along the edges of other owners.
void TileLevels::shareEdges(std::uint32_t level) {
    const FaceLinks& links = *set_.links;
    for (std::size_t t = 0; t < tiles_.size(); ++t)
        for (std::uint32_t c = 0; c < 4 && level < tiles_[t].size(); ++c) {
            const Incidence& owner = links.cornerOwners[4 * t + c];
            if (owner.face == kNoPatch) continue;
            Grid& own = tiles_[t][level];
            const Grid& other = tiles_[owner.face][std::min<std::size_t>(level, tiles_[owner.face].size() - 1)];
            const dvec2 at = pointInside(owner.side, double(owner.start), 0) * dvec2(other.size - 1);
            const ivec2 node = nodeOfSide(c, own.size - 1, 0, 0);
            own.own[std::size_t(node.y) * std::size_t(own.size.x) + std::size_t(node.x)] =
                float(other.bilinear(at.x, at.y));
        }
    for (std::size_t t = 0; t < tiles_.size(); ++t)
        for (std::uint32_t side = 0; side < 4 && level < tiles_[t].size(); ++side) shareSide(t, level, side);
}

void TileLevels::shareSide(std::size_t tile, std::uint32_t level, std::uint32_t side) {
    Grid& own = tiles_[tile][level];
    const ivec2 last(own.size.x - 1, own.size.y - 1);
    const int count = along(side, last);
    for (std::size_t k = 0; k < 2; ++k) {
        const FaceLink& link = set_.links->links[8 * tile + 2 * side + k];
        if (link.face == kNoPatch || !link.isOwner) continue;
        const double share = double(link.end - link.start) / double(link.ownEnd - link.ownStart);
        const Grid& other = gridNear(link.face, count / std::abs(share), link.side, true);
        for (int node = 1; node < count; ++node) {
            const double x = double(node) / count;
            if (x < std::min(link.ownStart, link.ownEnd) || x > std::max(link.ownStart, link.ownEnd)) continue;
            const dvec2 at =
                pointInside(link.side, link.start + (x - link.ownStart) * share, 0) * dvec2(other.size - 1);
            const ivec2 to = nodeOfSide(side, last, node, 0);
            own.own[std::size_t(to.y) * std::size_t(own.size.x) + std::size_t(to.x)] =
                float(other.bilinear(at.x, at.y));
        }
    }
}

/// The node beyond a side: what the face there shows as far behind the edge. Where no face continues the surface, the
/// slope across the side is that of the own nodes alone.
double TileLevels::acrossSide(std::size_t tile, std::uint32_t level, std::uint32_t side, int node) const {
    const Grid& own = tiles_[tile][level];
    const ivec2 last(own.size.x - 1, own.size.y - 1);
    const int count = along(side, last);
    const auto corner = std::size_t(4 * tile + (side + (node == 0 ? 0 : 1)) % 4);
    const bool isOneSided = (node == 0 || node == count) && set_.links->isOneSided[corner];
    const double x = double(node) / count;
    for (std::size_t k = 0; k < 2 && !isOneSided; ++k) {
        const FaceLink& link = set_.links->links[8 * tile + 2 * side + k];
        if (link.face == kNoPatch || !link.continues) continue;
        if (x < std::min(link.ownStart, link.ownEnd) || x > std::max(link.ownStart, link.ownEnd)) continue;
        const double share = double(link.end - link.start) / double(link.ownEnd - link.ownStart);
        const double depth = std::abs(share) / acrossOf(side, last);
        const Grid& other = gridNear(link.face, 1 / depth, link.side, false);
        const dvec2 at = pointInside(link.side, link.start + (x - link.ownStart) * share, std::min(depth, 1.0)) *
                         dvec2(other.size - 1);
        return other.bilinear(at.x, at.y);
    }
    const ivec2 edge = nodeOfSide(side, last, node, 0), inner = nodeOfSide(side, last, node, 1);
    return 2 * double(own.at(edge.x, edge.y)) - double(own.at(inner.x, inner.y));
}

StoredLevel TileLevels::storedFace(std::size_t tile, std::uint32_t level) const {
    const Grid& own = tiles_[tile][level];
    StoredLevel result{own.size + 2 * kFaceApron, {}};
    result.texels.resize(std::size_t(result.size.x) * std::size_t(result.size.y));
    const auto put = [&](const ivec2& node, double value) {
        result.texels[std::size_t(node.y + 1) * std::size_t(result.size.x) + std::size_t(node.x + 1)] = float(value);
    };
    const ivec2 last(own.size.x - 1, own.size.y - 1);
    // No lookup reads the corners of the apron.
    for (const int x : {-1, own.size.x})
        for (const int y : {-1, own.size.y})
            put({x, y}, double(own.at(std::clamp(x, 0, last.x), std::clamp(y, 0, last.y))));
    for (int y = 0; y < own.size.y; ++y)
        for (int x = 0; x < own.size.x; ++x) put({x, y}, double(own.at(x, y)));
    for (std::uint32_t side = 0; side < 4; ++side)
        for (int node = 0; node <= along(side, last); ++node)
            put(nodeOfSide(side, last, node, -1), acrossSide(tile, level, side, node));
    return result;
}

} // namespace relief
