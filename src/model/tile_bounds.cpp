// Bounds of the heights of sets of tiles.
#include <algorithm>
#include <cmath>

#include "displacement/tile_levels.h"
#include "model/bounds.h"

namespace relief {

/// The pyramid of one tile over a unit square.
struct HeightPyramid::Tile {
    vec2 place{0};
    HeightPyramid pyramid;
};

void HeightPyramid::addTiles(const HeightMap& map) {
    for (const MapTile& tile : map.tiles) {
        // What lies in the apron is bounded by the tiles that it is of.
        HeightMap own{.width = tile.size.x, .height = tile.size.y, .mid = map.mid, .scale = map.scale};
        own.wrap = Wrap::clamp;
        const auto stride = std::ptrdiff_t(tile.size.x) + 2 * kTileApron;
        for (int y = 0; y < tile.size.y; ++y) {
            const float* row = &map.texels[tile.first] + (y + kTileApron) * stride + kTileApron;
            own.texels.insert(own.texels.end(), row, row + tile.size.x);
        }
        tiles_.push_back(std::make_shared<const Tile>(Tile{vec2(tile.place), HeightPyramid(own, roundOff_)}));
    }
}

/// Bounds of all tiles that lookups in the box read. Where these are several, heights go from those of one to those of
/// another within a texel; where there is none heights are 0.
Range HeightPyramid::rangeOfTiles(const TexBox& box, int level) const {
    Range all{INFINITY, -INFINITY, 0, 0};
    vec2 most(0); // texels of a tile
    std::size_t count = 0;
    bool isInside = false; // the box lies in the square of the last tile that was met
    const auto side = float(1 << std::clamp(level, 0, int(kMostMapLevels) - 1));
    for (const std::shared_ptr<const Tile>& tile : tiles_) {
        const vec2 size(tile->pyramid.size_), lower = box.lower - tile->place, upper = box.upper - tile->place;
        // Lookups read up to three texels of the level beyond the box, and an apron is four wide.
        const vec2 margin = glm::min(4.0f * side / size, vec2(float(kTileApron)));
        if (glm::any(glm::lessThan(upper, -margin)) || glm::any(glm::greaterThan(lower, 1.0f + margin))) continue;
        const Range own = tile->pyramid.range({lower, upper}, level);
        all = {std::min(all.lowest, own.lowest), std::max(all.highest, own.highest), std::max(all.slopeS, own.slopeS),
               std::max(all.slopeT, own.slopeT)};
        isInside = glm::all(glm::greaterThanEqual(lower, vec2(0))) && glm::all(glm::lessThan(upper, vec2(1)));
        most = glm::max(most, size);
        ++count;
    }
    if (count == 0) return {};
    if (count > 1) {
        const float step = all.highest - all.lowest;
        all.slopeS = std::max(all.slopeS, step * most.x), all.slopeT = std::max(all.slopeT, step * most.y);
    }
    if (count > 1 || !isInside) all.lowest = std::min(all.lowest, 0.0f), all.highest = std::max(all.highest, 0.0f);
    return all;
}

namespace {

/// Bounds of one level of a face as it is stored.
Range rangeOfLevel(const StoredLevel& level, const HeightMap& map, double roundOff) {
    const ivec2 last = level.size - 1, segments = level.size - 1 - 2 * kFaceApron;
    const auto at = [&](int x, int y) {
        return double(level.texels[std::size_t(y) * std::size_t(level.size.x) + std::size_t(x)]);
    };
    double lowest = INFINITY, highest = -INFINITY;
    dvec2 step(0);
    for (int y = 0; y <= last.y; ++y)
        for (int x = 0; x <= last.x; ++x) {
            // Nodes of the apron count for slopes alone, its corners not at all.
            const bool isRow = y > 0 && y<last.y, isColumn = x> 0 && x < last.x;
            if (isRow && isColumn) lowest = std::min(lowest, at(x, y)), highest = std::max(highest, at(x, y));
            if (isRow && x < last.x) step.x = std::max(step.x, std::abs(at(x + 1, y) - at(x, y)));
            if (isColumn && y < last.y) step.y = std::max(step.y, std::abs(at(x, y + 1) - at(x, y)));
        }
    const double a = map.scale * (lowest - roundOff - map.mid), b = map.scale * (highest + roundOff - map.mid);
    const dvec2 slope = std::abs(map.scale) * dvec2(segments) * (step + 2 * roundOff);
    return {float(std::min(a, b)), float(std::max(a, b)), float(slope.x), float(slope.y)};
}

} // namespace

/// Bounds of each face over all of its levels, by what is stored of them.
void HeightPyramid::addFaces(const HeightMap& map) {
    const TileLevels levels(map);
    for (std::size_t t = 0; t < map.tiles.size(); ++t) {
        Range all{INFINITY, -INFINITY, 0, 0};
        for (std::uint32_t level = 0; level < countLevels(map, map.tiles[t]); ++level) {
            const Range one = rangeOfLevel(levels.stored(t, level), map, level > 0 ? double(roundOff_) : 0);
            all = {std::min(all.lowest, one.lowest), std::max(all.highest, one.highest),
                   std::max(all.slopeS, one.slopeS), std::max(all.slopeT, one.slopeT)};
        }
        faces_.push_back(all);
    }
}

} // namespace relief
