// Sums of maps, made once on the host: what draws, bounds and certifies a surface meets one map.
#include "displacement/layers.h"

#include <algorithm>
#include <cmath>

#include "displacement/parallel.h"
#include "displacement/tile_set.h"
#include "displacement/vector_map.h"

namespace relief {
namespace {

constexpr int kMostSide = 16384;
constexpr double kMostBytes = double(1ull << 30);

/// The maps and masks of all layers.
template <typename Take>
void eachMap(std::span<const MapLayer> layers, const Take& take) {
    for (const MapLayer& layer : layers) {
        take(layer.name, layer.map, layer.placement);
        if (layer.mask) take(layer.maskName, *layer.mask, MapPlacement());
    }
}

/// Vectors of all layers together, or nothing where all are heights.
std::optional<VectorSpace> findSpace(std::span<const MapLayer> layers) {
    const auto found = std::ranges::find_if(layers, [](const MapLayer& layer) { return layer.map.vectors != nullptr; });
    if (found == layers.end()) return {};
    const VectorSpace space = found->map.vectors->space;
    for (const MapLayer& layer : layers) {
        if (layer.map.vectors && layer.map.vectors->space != space)
            fail(Failure::usage, "{} and {}: vectors of tangent space and of object space cannot be added", found->name,
                 layer.name);
        if (!layer.map.vectors && space == VectorSpace::object)
            fail(Failure::usage, "{} and {}: heights cannot be added to vectors of object space, only of tangent space",
                 layer.name, found->name);
    }
    return space;
}

/// The addressing of the sum. Throws for layers that have no sum.
Addressing chooseAddressing(std::span<const MapLayer> layers) {
    const auto of = [&](Addressing addressing) {
        std::string name;
        eachMap(layers, [&](const std::string& each, const HeightMap& map, const MapPlacement& placement) {
            if (map.addressing != addressing) return;
            if (name.empty()) name = each;
            if (addressing != Addressing::texture && !placement.isIdentity())
                fail(Failure::usage, "{}: a {} has its own texture coordinates: it takes no repeat and no offset", each,
                     addressing == Addressing::tiles ? "set of tiles" : "map per face");
        });
        return name;
    };
    const std::string faces = of(Addressing::faces), tiles = of(Addressing::tiles), texture = of(Addressing::texture);
    if (!faces.empty() && !(tiles + texture).empty())
        fail(Failure::usage,
             "{} and {}: a map per face cannot be added to maps over texture coordinates; relief map makes one kind of "
             "the other",
             faces, tiles.empty() ? texture : tiles);
    return !faces.empty() ? Addressing::faces : !tiles.empty() ? Addressing::tiles : Addressing::texture;
}

/// The height of a map at the centre of a texel of the sum. A map of the same size has a texel there.
class CentreLookup {
public:
    CentreLookup(const HeightMap& map, const MapPlacement& placement, const ivec2& size)
        : map_(map), placement_(placement), isSame_(map.addressing == Addressing::texture && placement.isIdentity() &&
                                                    ivec2(map.width, map.height) == size) {}

    [[nodiscard]] double at(const ivec2& texel, const dvec2& st) const {
        if (!isSame_) return sampleHeight(map_, {.st = placement_.at(st)}).h;
        const std::size_t i = std::size_t(texel.y) * std::size_t(map_.width) + std::size_t(texel.x);
        return map_.scale * (double(map_.texels[i]) - map_.mid);
    }

private:
    const HeightMap& map_;
    MapPlacement placement_;
    bool isSame_;
};

/// Component k of a layer (2: heights), or null where it has none.
const HeightMap* componentOf(const MapLayer& layer, int k) {
    if (layer.map.vectors) return &layer.map.vectors->channels[std::size_t(k)];
    return k == 2 ? &layer.map : nullptr;
}

/// One component of the sum over the unit square at `place`, row after row from the top.
std::vector<float> addOver(std::span<const MapLayer> layers, int component, const ivec2& place, const ivec2& size) {
    std::vector<float> texels(std::size_t(size.x) * std::size_t(size.y));
    struct Term {
        CentreLookup map;
        std::optional<CentreLookup> mask;
    };
    // Lookups are set up once per layer, which is faster than once per texel.
    std::vector<Term> terms;
    for (const MapLayer& layer : layers) {
        const HeightMap* map = componentOf(layer, component);
        if (map == nullptr) continue;
        terms.push_back({{*map, layer.placement, size}, {}});
        if (layer.mask) terms.back().mask.emplace(*layer.mask, MapPlacement(), size);
    }
    forEachAtOnce(std::size_t(size.y), [&](std::size_t y) {
        for (int x = 0; x < size.x; ++x) {
            const ivec2 texel(x, int(y));
            const dvec2 st = dvec2(place) + dvec2((x + 0.5) / size.x, 1 - (double(y) + 0.5) / size.y);
            double sum = 0;
            for (const Term& term : terms) {
                const double weight = term.mask ? term.mask->at(texel, st) : 1.0;
                if (weight != 0) sum += weight * term.map.at(texel, st);
            }
            texels[y * std::size_t(size.x) + std::size_t(x)] = float(sum);
        }
    });
    return texels;
}

/// Texels per unit square that no map or mask is finer than; of a set at one of its tiles.
ivec2 finestSize(std::span<const MapLayer> layers, const ivec2& place, double count) {
    dvec2 finest(1);
    std::string name;
    eachMap(layers, [&](const std::string& each, const HeightMap& map, const MapPlacement& placement) {
        dvec2 size(map.width, map.height);
        if (map.addressing == Addressing::tiles) {
            const MapTile* tile = findTileAt(map.tiles, place);
            size = tile != nullptr ? dvec2(tile->size) : dvec2(1);
        }
        size = glm::ceil(size * glm::abs(placement.repeat) - 1e-6);
        if (size.x > finest.x || size.y > finest.y) name = each;
        finest = glm::max(finest, size);
    });
    if (std::max(finest.x, finest.y) > kMostSide || finest.x * finest.y * 4 * count > kMostBytes)
        fail(Failure::input,
             "{}: with its repeat it takes {:.0f} x {:.0f} texels, more than the sum of layers holds; "
             "repeat it less often, or make it smaller",
             name, finest.x, finest.y);
    return {finest};
}

/// All unit squares that a set has a tile of; masks make none.
std::vector<ivec2> listPlaces(std::span<const MapLayer> layers) {
    std::vector<ivec2> places;
    for (const MapLayer& layer : layers)
        for (const MapTile& tile : layer.map.tiles)
            if (std::ranges::find(places, tile.place) == places.end()) places.push_back(tile.place);
    if (places.empty()) fail(Failure::usage, "{}: a mask of tiles needs a map of tiles", layers.front().name);
    return places;
}

/// One of `count` components of the sum, as a set of tiles.
HeightMap addTiles(std::span<const MapLayer> layers, int component, int count, std::span<const ivec2> places) {
    std::vector<HeightMap> maps;
    for (const ivec2& place : places) {
        const ivec2 size = finestSize(layers, place, double(places.size()) * count);
        maps.push_back(makeHeightMap(size.x, size.y, addOver(layers, component, place, size), 0, 1, Wrap::clamp));
    }
    return makeTileSet(maps, places);
}

/// The sum at the nodes of the finest map per face. On edges it is that of each face: fitToFaces() chooses the owner's.
HeightMap addFaces(std::span<const MapLayer> layers) {
    HeightMap sum{.wrap = Wrap::clamp, .addressing = Addressing::faces, .topology = layers.front().map.topology};
    eachMap(layers, [&](const std::string& name, const HeightMap& map, const MapPlacement&) {
        if (map.topology != sum.topology || map.tiles.size() != layers.front().map.tiles.size())
            fail(Failure::input, "{} and {}: these maps per face were made for different cages", layers.front().name,
                 name);
    });
    // Segments of each face: the most of any map or mask. Nodes of coarser ones are among them.
    for (std::size_t f = 0; f < layers.front().map.tiles.size(); ++f) {
        ivec2 segments(0);
        eachMap(layers, [&](const std::string&, const HeightMap& map, const MapPlacement&) {
            segments = glm::max(segments, map.tiles[f].segments);
        });
        sum.tiles.push_back(
            {.place = {int(f), 0}, .size = ivec2(1 << segments.x, 1 << segments.y) + 1, .segments = segments});
    }
    allocateTiles(sum);
    forEachAtOnce(sum.tiles.size(), [&](std::size_t f) {
        const MapTile& tile = sum.tiles[f];
        std::vector<float> nodes;
        for (int j = 0; j < tile.size.y; ++j)
            for (int i = 0; i < tile.size.x; ++i) {
                const MapPlace place{.face = int(f), .uv = dvec2(i, j) / dvec2(tile.size - 1)};
                double height = 0;
                for (const MapLayer& layer : layers)
                    height +=
                        (layer.mask ? sampleHeight(*layer.mask, place).h : 1.0) * sampleHeight(layer.map, place).h;
                nodes.push_back(float(height));
            }
        copyTile(nodes, sum, tile);
    });
    return sum;
}

/// Vectors over one unit square, or over those of sets.
HeightMap addVectors(std::span<const MapLayer> layers, bool isOfTiles, VectorSpace space, Wrap wrap, MapFormat format) {
    std::array<HeightMap, 3> components;
    const std::vector<ivec2> places = isOfTiles ? listPlaces(layers) : std::vector<ivec2>();
    const ivec2 size = isOfTiles ? ivec2(0) : finestSize(layers, {}, 3);
    for (int k = 0; k < 3; ++k)
        components[std::size_t(k)] = isOfTiles
                                         ? addTiles(layers, k, 3, places)
                                         : makeHeightMap(size.x, size.y, addOver(layers, k, {}, size), 0, 1, wrap);
    return joinComponents(components, space, format);
}

} // namespace

bool repeatsWhole(std::span<const MapLayer> layers) {
    return std::ranges::all_of(
        layers, [](const MapLayer& layer) { return layer.placement.repeat == glm::round(layer.placement.repeat); });
}

EncodedMap addLayers(std::span<const MapLayer> layers, Wrap wrap, MapFormat format) {
    RELIEF_CHECK(!layers.empty());
    const std::optional<VectorSpace> space = findSpace(layers);
    const Addressing addressing = chooseAddressing(layers);
    if (addressing == Addressing::faces)
        return {addFaces(layers), {.format = format, .blocks = {}}}; // encoded once it is fitted
    const bool isOfTiles = addressing == Addressing::tiles;
    if (space) return {addVectors(layers, isOfTiles, *space, wrap, format), {}};
    if (isOfTiles) return encode(addTiles(layers, 2, 1, listPlaces(layers)), format);
    const ivec2 size = finestSize(layers, {}, 1);
    return encode(makeHeightMap(size.x, size.y, addOver(layers, 2, {}, size), 0, 1, wrap), format);
}

} // namespace relief
