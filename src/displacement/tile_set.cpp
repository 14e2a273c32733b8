// Maps of several tiles: making them, and looking them up.
#include <algorithm>
#include <cmath>

#include "displacement/parallel.h"
#include "displacement/tile_levels.h"
#include "displacement/tile_set.h"
#include "displacement/voids.h"

namespace relief {
namespace {

/// Row after row from the lowest (s,t) on.
bool isTileBefore(const MapTile& tile, const ivec2& place) {
    return tile.place.y != place.y ? tile.place.y < place.y : tile.place.x < place.x;
}

/// A lookup in the texels of one tile, by columns and rows of its own; the apron goes on beyond them.
class TileLookup {
public:
    TileLookup(const HeightMap& map, const MapTile& tile)
        : map_(map), tile_(tile), apron_(apronOf(map.addressing)), stride_(tile.size.x + 2 * apron_) {}

    /// Bilinear, in stored values; texels have whole coordinates.
    [[nodiscard]] double at(double x, double y) const {
        const double i = std::floor(x), j = std::floor(y);
        return std::lerp(std::lerp(texel(i, j), texel(i + 1, j), x - i),
                         std::lerp(texel(i, j + 1), texel(i + 1, j + 1), x - i), y - j);
    }

    /// The value, and its central differences over one texel along both axes, per texel.
    [[nodiscard]] HeightSample sample(double x, double y) const {
        return {.h = map_.scale * (at(x, y) - map_.mid),
                .hs = map_.scale * (at(x + 1, y) - at(x - 1, y)) / 2,
                .ht = map_.scale * (at(x, y + 1) - at(x, y - 1)) / 2};
    }

private:
    [[nodiscard]] double texel(double column, double row) const {
        const int c = std::clamp(int(column), -apron_, tile_.size.x - 1 + apron_) + apron_;
        const int r = std::clamp(int(row), -apron_, tile_.size.y - 1 + apron_) + apron_;
        return double(map_.texels[tile_.first + std::size_t(r) * std::size_t(stride_) + std::size_t(c)]);
    }

    const HeightMap& map_;
    const MapTile& tile_;
    int apron_, stride_;
};

} // namespace

void allocateTiles(HeightMap& set) {
    std::size_t count = 0;
    for (MapTile& tile : set.tiles) {
        const ivec2 size = tile.size + 2 * apronOf(set.addressing);
        tile.first = count;
        count += std::size_t(size.x) * std::size_t(size.y);
        set.width = std::max(set.width, tile.size.x), set.height = std::max(set.height, tile.size.y);
    }
    set.texels.assign(count, 0.0f);
}

void copyTile(std::span<const float> texels, HeightMap& set, const MapTile& tile) {
    const int apron = apronOf(set.addressing), stride = tile.size.x + 2 * apron;
    RELIEF_CHECK(texels.size() == std::size_t(tile.size.x) * std::size_t(tile.size.y));
    for (int y = 0; y < tile.size.y; ++y)
        std::copy_n(&texels[std::size_t(y) * std::size_t(tile.size.x)], tile.size.x,
                    &set.texels[tile.first] + std::ptrdiff_t(y + apron) * stride + apron);
}

namespace {

/// The texels of a tile as they are stored, its apron included.
std::span<float> texelsOf(HeightMap& set, std::size_t tile) {
    const ivec2 size = storedSize(set, set.tiles[tile], 0);
    return std::span(set.texels).subspan(set.tiles[tile].first, std::size_t(size.x) * std::size_t(size.y));
}

} // namespace

void finishTiles(HeightMap& set) {
    if (set.addressing == Addressing::tiles) {
        // Tiles of one size show each other's texels; others are read on the level that is as fine.
        const TileLevels levels(set, hasOneSize(set) ? 1 : kMostMapLevels);
        forEachAtOnce(set.tiles.size(), [&](std::size_t t) { levels.fillApron(t, texelsOf(set, t)); });
        findRange(set);
        return;
    }
    const TileLevels levels(set);
    std::vector<float> texels = set.texels; // edges are read as they were
    forEachAtOnce(set.tiles.size(), [&](std::size_t t) {
        std::ranges::copy(levels.stored(t, 0).texels, texels.begin() + std::ptrdiff_t(set.tiles[t].first));
    });
    set.texels = std::move(texels);
    findRange(set);
}

void findRange(HeightMap& map) {
    std::vector<vec2> ranges(std::max<std::size_t>(map.tiles.size(), 1), vec2(INFINITY, -INFINITY));
    const auto add = [](vec2& range, std::span<const float> texels) {
        const auto [lowest, highest] = std::ranges::minmax(texels);
        range = {std::min(range.x, lowest), std::max(range.y, highest)};
    };
    if (map.tiles.empty()) add(ranges.front(), map.texels);
    const int apron = apronOf(map.addressing);
    forEachAtOnce(map.tiles.size(), [&](std::size_t t) {
        const MapTile& tile = map.tiles[t];
        for (int y = 0; y < tile.size.y; ++y) {
            const std::size_t row = std::size_t(y + apron) * std::size_t(tile.size.x + 2 * apron);
            add(ranges[t],
                std::span(map.texels).subspan(tile.first + row + std::size_t(apron), std::size_t(tile.size.x)));
        }
    });
    map.lowest = INFINITY, map.highest = -INFINITY;
    for (const vec2& range : ranges)
        map.lowest = std::min(map.lowest, range.x), map.highest = std::max(map.highest, range.y);
}

void roundTiles(HeightMap& set, const MapEncoding& encoding) {
    forEachAtOnce(set.tiles.size(), [&](std::size_t t) { roundTo(encoding, texelsOf(set, t)); });
}

const MapTile* findTileAt(std::span<const MapTile> tiles, const ivec2& place) {
    const auto found = std::lower_bound(tiles.begin(), tiles.end(), place, isTileBefore);
    return found != tiles.end() && found->place == place ? &*found : nullptr;
}

const MapTile* findTile(std::span<const MapTile> tiles, const dvec2& st) {
    const dvec2 whole = glm::clamp(glm::floor(st), dvec2(-1e6), dvec2(1e6)), within = st - whole;
    if (const MapTile* tile = findTileAt(tiles, ivec2(whole))) return tile;
    const auto besideOf = [](double x) {
        return x < double(kTileRounding) ? -1 : x > 1 - double(kTileRounding) ? 1 : 0;
    };
    const ivec2 beside(besideOf(within.x), besideOf(within.y));
    for (const ivec2& step : {ivec2(beside.x, 0), ivec2(0, beside.y), beside})
        if (const MapTile* tile = findTileAt(tiles, ivec2(whole) + step)) return tile;
    return nullptr;
}

HeightMap makeTileSet(std::span<const HeightMap> maps, std::span<const ivec2> places) {
    RELIEF_CHECK(!maps.empty());
    RELIEF_CHECK(maps.size() == places.size());
    HeightMap set{.mid = maps[0].mid, .scale = maps[0].scale, .wrap = Wrap::clamp, .addressing = Addressing::tiles};
    std::vector<std::size_t> order(maps.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::ranges::sort(order,
                      [&](std::size_t a, std::size_t b) { return isTileBefore({.place = places[a]}, places[b]); });
    for (const std::size_t i : order) {
        RELIEF_CHECK(maps[i].mid == set.mid);
        RELIEF_CHECK(maps[i].scale == set.scale);
        set.tiles.push_back({.place = places[i], .size = {maps[i].width, maps[i].height}});
    }
    allocateTiles(set);
    for (std::size_t t = 0; t < order.size(); ++t) copyTile(maps[order[t]].texels, set, set.tiles[t]);
    finishTiles(set);
    return set;
}

HeightMap makeFaceMap(const Surface& surface, std::span<const ivec2> segments,
                      const std::function<double(int face, const dvec2& uv)>& heightAt) {
    RELIEF_CHECK(segments.size() == surface.faces.size());
    HeightMap map{.wrap = Wrap::clamp, .addressing = Addressing::faces};
    for (std::size_t f = 0; f < segments.size(); ++f)
        map.tiles.push_back(
            {.place = {int(f), 0}, .size = ivec2(1 << segments[f].x, 1 << segments[f].y) + 1, .segments = segments[f]});
    allocateTiles(map);
    for (std::size_t f = 0; f < segments.size(); ++f) {
        if (surface.faces[f].root == kNoPatch) continue;
        const MapTile& tile = map.tiles[f];
        std::vector<float> nodes;
        for (int j = 0; j < tile.size.y; ++j)
            for (int i = 0; i < tile.size.x; ++i)
                nodes.push_back(float(heightAt(int(f), dvec2(i, j) / dvec2(tile.size - 1))));
        copyTile(nodes, map, tile);
    }
    fitToFaces(map, surface);
    return map;
}

void fitToFaces(HeightMap& map, const Surface& surface) {
    RELIEF_CHECK(map.addressing == Addressing::faces);
    if (map.tiles.size() != surface.faces.size())
        fail(Failure::input, "a map of {} faces does not fit a surface of {}", map.tiles.size(), surface.faces.size());
    map.links = std::make_shared<const FaceLinks>(linkFaces(surface));
    finishTiles(map);
}

JoinedMap joinTiles(const HeightMap& set) {
    constexpr int kMostSide = 16384;
    const TileGrid grid = gridOf(set); // with a row and a column more on each side
    JoinedMap joined{.map = {.mid = set.mid, .scale = set.scale, .wrap = Wrap::clamp},
                     .tiles = {grid.first + 1, grid.count - 2}};
    ivec2 size(set.width, set.height);
    while (glm::any(glm::greaterThan(size * joined.tiles.count, ivec2(kMostSide)))) size = glm::max(size / 2, ivec2(1));
    HeightMap& map = joined.map;
    map.width = size.x * joined.tiles.count.x, map.height = size.y * joined.tiles.count.y;
    map.texels.assign(std::size_t(map.width) * std::size_t(map.height), float(set.mid));
    forEachAtOnce(std::size_t(map.height), [&](std::size_t y) {
        for (int x = 0; x < map.width; ++x) {
            const dvec2 st = dvec2(joined.tiles.first) +
                             dvec2((x + 0.5) / size.x, joined.tiles.count.y - (double(y) + 0.5) / size.y);
            if (const MapTile* tile = findTileAt(set.tiles, ivec2(glm::floor(st)))) {
                const dvec2 texels(tile->size), within = st - dvec2(tile->place);
                map.texels[y * std::size_t(map.width) + std::size_t(x)] =
                    float(TileLookup(set, *tile).at(within.x * texels.x - 0.5, (1 - within.y) * texels.y - 0.5));
            }
        }
    });
    findRange(map);
    return joined;
}

HeightSample sampleHeight(const HeightMap& map, const MapPlace& place) {
    if (map.addressing == Addressing::texture) return sampleHeight(map, place.st);
    if (map.addressing == Addressing::faces) {
        const MapTile& tile = map.tiles[std::size_t(place.face)];
        const dvec2 segments(tile.size - 1);
        const dvec2 at = place.uv * segments;
        HeightSample sample = TileLookup(map, tile).sample(at.x, at.y);
        sample.hs *= segments.x, sample.ht *= segments.y;
        return sample;
    }
    const MapTile* tile = findTile(map.tiles, place.st);
    if (tile == nullptr) return {};
    const dvec2 size(tile->size), within = place.st - dvec2(tile->place);
    HeightSample sample = TileLookup(map, *tile).sample(within.x * size.x - 0.5, (1 - within.y) * size.y - 0.5);
    sample.hs *= size.x, sample.ht *= -size.y; // rows go down
    return sample;
}

} // namespace relief
