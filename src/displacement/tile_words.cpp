// Sets of tiles in the words of the device (shared/maps.h).
#include <algorithm>
#include <mutex>

#include "displacement/map_formats.h"
#include "displacement/parallel.h"
#include "displacement/tile_levels.h"

namespace relief {
namespace {

std::size_t countEntries(const HeightMap& set) {
    if (set.addressing == Addressing::faces) return set.tiles.size();
    const TileGrid grid = gridOf(set);
    return std::size_t(grid.count.x) * std::size_t(grid.count.y);
}

std::uint64_t toEven(std::uint64_t word) { return word + word % 2; }

/// Lays the levels of a tile out from a word on: the words where its levels begin, the last one first, then level 0 and
/// the others, each from an even word on. Calls `take(level, word)` for each.
template <typename Take>
std::uint64_t layOutTile(MapFormat format, const HeightMap& set, const MapTile& tile, std::uint64_t word,
                         const Take& take) {
    const std::uint32_t count = countLevels(set, tile);
    word = toEven(word + count - 1);
    for (std::uint32_t level = 0; level < count; ++level) {
        take(level, word);
        word = toEven(word + levelBytes(format, storedSize(set, tile, level)) / 4);
    }
    return word;
}

/// For a unit square without a tile: a bit for each of the nine squares around it that has one.
std::uint32_t squaresAround(const HeightMap& set, const ivec2& place) {
    std::uint32_t bits = 0;
    for (int k = 0; k < 9; ++k)
        if (std::ranges::find(set.tiles, place + ivec2(k % 3 - 1, k / 3 - 1), &MapTile::place) != set.tiles.end())
            bits |= 1u << k;
    return bits;
}

void storeEntries(MapWords& words, const HeightMap& set, std::span<const std::uint32_t> firsts) {
    const bool isOfFaces = set.addressing == Addressing::faces;
    const TileGrid grid = isOfFaces ? TileGrid{} : gridOf(set);
    for (int i = 0; !isOfFaces && i < grid.count.x * grid.count.y; ++i) {
        words.words[2 * std::size_t(i)] = kNoTile;
        words.words[2 * std::size_t(i) + 1] =
            squaresAround(set, grid.first + ivec2(i % grid.count.x, i / grid.count.x));
    }
    for (std::size_t t = 0; t < set.tiles.size(); ++t) {
        const MapTile& tile = set.tiles[t];
        const ivec2 at = tile.place - grid.first, size = isOfFaces ? tile.segments : tile.size;
        const std::size_t entry = isOfFaces ? t : std::size_t(at.y) * std::size_t(grid.count.x) + std::size_t(at.x);
        words.words[2 * entry] = firsts[t];
        words.words[2 * entry + 1] = std::uint32_t(size.x) | std::uint32_t(size.y) << 16;
    }
}

/// Level 0 as the set has it, encoded already.
StoredLevel levelOfSet(const HeightMap& set, std::size_t t) {
    const ivec2 size = storedSize(set, set.tiles[t], 0);
    const auto first = set.texels.begin() + std::ptrdiff_t(set.tiles[t].first);
    return {size, std::vector<float>(first, first + std::ptrdiff_t(size.x) * size.y)};
}

} // namespace

std::uint64_t mapBytes(MapFormat format, const HeightMap& map) {
    if (map.addressing == Addressing::texture) return mapBytes(format, map.width, map.height);
    std::uint64_t word = 2 * std::uint64_t(countEntries(map));
    for (const MapTile& tile : map.tiles)
        word = layOutTile(format, map, tile, word, [](std::uint32_t, std::uint64_t) {});
    return 4 * word;
}

void storeTiles(MapWords& words, const HeightMap& set, const MapEncoding& encoding) {
    // Where everything lies is known first, so that tiles are stored at once.
    words.words.resize(mapBytes(encoding.format, set) / 4, 0);
    std::vector<std::uint32_t> firsts;       // word of level 0 of each tile
    std::vector<std::size_t> firstLevels;    // in words.firsts, of each tile
    std::vector<std::size_t> firstBlocks{0}; // byte of encoding.blocks, of each tile
    std::uint64_t word = 2 * std::uint64_t(countEntries(set));
    for (const MapTile& tile : set.tiles) {
        firstLevels.push_back(words.firsts.size());
        firstBlocks.push_back(firstBlocks.back() + levelBytes(MapFormat::bc4, storedSize(set, tile, 0)));
        std::uint64_t first = 0;
        word = layOutTile(encoding.format, set, tile, word, [&](std::uint32_t level, std::uint64_t at) {
            if (level == 0) first = at, firsts.push_back(std::uint32_t(at));
            if (level > 0) words.words[first - level] = std::uint32_t(at);
            words.firsts.push_back(std::uint32_t(at));
            words.sizes.push_back(storedSize(set, tile, level));
        });
    }
    storeEntries(words, set, firsts);

    const TileLevels levels(set);
    std::mutex mutex;
    forEachAtOnce(set.tiles.size(), [&](std::size_t t) {
        float roundOff = 0;
        for (std::uint32_t level = 0; level < countLevels(set, set.tiles[t]); ++level) {
            const StoredLevel stored = level == 0 ? levelOfSet(set, t) : levels.stored(t, level);
            const MapLevel<float> texels{stored.size.x, stored.size.y, stored.texels};
            const std::span<std::uint32_t> to = std::span(words.words).subspan(words.firsts[firstLevels[t] + level]);
            const bool hasBlocks = level == 0 && encoding.format == MapFormat::bc4;
            if (hasBlocks)
                storeBlocks(to, encoding, texels,
                            std::span(encoding.blocks).subspan(firstBlocks[t], firstBlocks[t + 1] - firstBlocks[t]));
            else
                roundOff = std::max(roundOff, storeLevel(to, encoding, texels));
        }
        const std::lock_guard lock(mutex);
        words.roundOff = std::max(words.roundOff, roundOff);
    });
}

} // namespace relief
