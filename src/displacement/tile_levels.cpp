// Levels of sets of tiles over unit squares.
#include "displacement/tile_levels.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "displacement/parallel.h"

namespace relief {
namespace {

/// Which level of a tile of `other` texels is as fine as a level of a tile of `own` texels.
std::uint32_t levelAsFine(std::uint32_t level, double own, double other, std::uint32_t count) {
    const double shifted = double(level) + std::round(std::log2(other / own));
    return std::uint32_t(std::clamp(shifted, 0.0, double(count - 1)));
}

} // namespace

bool hasOneSize(const HeightMap& set) {
    return std::ranges::all_of(set.tiles, [&](const MapTile& tile) { return tile.size == set.tiles.front().size; });
}

std::uint32_t countLevels(const HeightMap& set, const MapTile& tile) {
    if (set.addressing == Addressing::faces) return std::uint32_t(std::max(tile.segments.x, tile.segments.y)) + 1;
    return std::min(std::uint32_t(std::bit_width(std::uint32_t(std::max(tile.size.x, tile.size.y)))), kMostMapLevels);
}

ivec2 storedSize(const HeightMap& set, const MapTile& tile, std::uint32_t level) {
    if (set.addressing == Addressing::faces) {
        const ivec2 left = glm::max(tile.segments - int(level), ivec2(0));
        return ivec2(1 << left.x, 1 << left.y) + 1 + 2 * kFaceApron;
    }
    return glm::max(tile.size >> int(level), ivec2(1)) + 2 * kTileApron;
}

TileGrid gridOf(const HeightMap& set) {
    ivec2 lowest = set.tiles.front().place, highest = lowest;
    for (const MapTile& tile : set.tiles)
        lowest = glm::min(lowest, tile.place), highest = glm::max(highest, tile.place);
    return {lowest - 1, highest - lowest + 3};
}

double TileLevels::Grid::bilinear(double x, double y) const {
    x = std::clamp(x, 0.0, double(size.x - 1)), y = std::clamp(y, 0.0, double(size.y - 1));
    const int i = std::min(int(x), std::max(size.x - 2, 0)), j = std::min(int(y), std::max(size.y - 2, 0));
    const int right = std::min(i + 1, size.x - 1), below = std::min(j + 1, size.y - 1);
    return std::lerp(std::lerp(double(at(i, j)), double(at(right, j)), x - i),
                     std::lerp(double(at(i, below)), double(at(right, below)), x - i), y - j);
}

TileLevels::TileLevels(const HeightMap& set, std::uint32_t mostLevels) : set_(set), tiles_(set.tiles.size()) {
    if (set.addressing == Addressing::faces)
        addFaces();
    else
        forEachAtOnce(set.tiles.size(), [&](std::size_t tile) { addUnitSquare(tile, mostLevels); });
}

StoredLevel TileLevels::stored(std::size_t tile, std::uint32_t level) const {
    return set_.addressing == Addressing::faces ? storedFace(tile, level) : storedUnitSquare(tile, level);
}

void TileLevels::addUnitSquare(std::size_t tileIndex, std::uint32_t mostLevels) {
    const MapTile& tile = set_.tiles[tileIndex];
    Grids& grids = tiles_[tileIndex];
    const int stride = tile.size.x + 2 * kTileApron;
    grids.emplace_back(tile.size, stride, &set_.texels[tile.first] + kTileApron * std::ptrdiff_t(stride) + kTileApron);
    // Each texel is the mean of four of the level before, or of what there is.
    while (grids.size() < std::min(countLevels(set_, tile), mostLevels)) {
        const Grid& fine = grids.back();
        const ivec2 size = glm::max(fine.size / 2, ivec2(1)), last = fine.size - 1;
        std::vector<float> texels;
        texels.reserve(std::size_t(size.x) * std::size_t(size.y));
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const int right = std::min(2 * x + 1, last.x), below = std::min(2 * y + 1, last.y);
                texels.push_back(0.25f * (fine.at(2 * x, 2 * y) + fine.at(right, 2 * y) + fine.at(2 * x, below) +
                                          fine.at(right, below)));
            }
        grids.emplace_back(size, std::move(texels));
    }
}

/// A texel beyond the border is what the tile there shows at its place, on the level that is as fine; without a tile it
/// is the nearest texel of the border.
double TileLevels::beyondUnitSquare(std::size_t tile, std::uint32_t level, int column, int row) const {
    const Grid& own = tiles_[tile][level];
    const dvec2 st = dvec2(set_.tiles[tile].place) + dvec2((column + 0.5) / own.size.x, 1 - (row + 0.5) / own.size.y);
    const ivec2 place(glm::floor(st));
    const MapTile* other = findTileAt(set_.tiles, place);
    if (other == nullptr) {
        // Beside a corner one of the two other tiles there may go on.
        const int c = std::clamp(column, 0, own.size.x - 1), r = std::clamp(row, 0, own.size.y - 1);
        if (c == column || r == row) return double(own.at(c, r));
        const bool hasBeside =
            findTileAt(set_.tiles, set_.tiles[tile].place + ivec2(column < 0 ? -1 : 1, 0)) != nullptr;
        return hasBeside ? beyondUnitSquare(tile, level, column, r) : beyondUnitSquare(tile, level, c, row);
    }
    const Grids& grids = tiles_[std::size_t(other - set_.tiles.data())];
    const ivec2 ownSize = set_.tiles[tile].size;
    const Grid& grid = grids[levelAsFine(level, std::max(ownSize.x, ownSize.y), std::max(other->size.x, other->size.y),
                                         std::uint32_t(grids.size()))];
    const dvec2 within = st - dvec2(place);
    return grid.bilinear(within.x * grid.size.x - 0.5, (1 - within.y) * grid.size.y - 0.5);
}

void TileLevels::fillApron(std::size_t tile, std::span<float> texels) const {
    const ivec2 size = set_.tiles[tile].size;
    const int stride = size.x + 2 * kTileApron;
    RELIEF_CHECK(texels.size() == std::size_t(stride) * std::size_t(size.y + 2 * kTileApron));
    for (int y = -kTileApron; y < size.y + kTileApron; ++y) {
        const bool isWithin = y >= 0 && y < size.y;
        float* row = &texels[std::size_t(y + kTileApron) * std::size_t(stride)] + kTileApron;
        for (int x = -kTileApron; x < size.x + kTileApron; ++x) {
            if (isWithin && x == 0) x = size.x; // what lies between is there
            row[x] = float(beyondUnitSquare(tile, 0, x, y));
        }
    }
}

StoredLevel TileLevels::storedUnitSquare(std::size_t tile, std::uint32_t level) const {
    const Grid& own = tiles_[tile][level];
    StoredLevel result{storedSize(set_, set_.tiles[tile], level), {}};
    result.texels.reserve(std::size_t(result.size.x) * std::size_t(result.size.y));
    for (int y = -kTileApron; y < own.size.y + kTileApron; ++y)
        for (int x = -kTileApron; x < own.size.x + kTileApron; ++x) {
            const bool isInside = x >= 0 && y >= 0 && x < own.size.x && y < own.size.y;
            result.texels.push_back(isInside ? own.at(x, y) : float(beyondUnitSquare(tile, level, x, y)));
        }
    return result;
}

} // namespace relief
