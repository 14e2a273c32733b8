// Maps of an object: heights and colors.
#include <algorithm>
#include <cmath>
#include <limits>

#include "displacement/map_origin.h"
#include "scene/loading.h"

namespace relief {
namespace {

/// The box of the texture coordinates that corners use.
std::pair<vec2, vec2> texCoordRange(const Cage& cage) {
    vec2 lower(INFINITY), upper(-INFINITY);
    for (const std::uint32_t corner : cage.texCorners) {
        lower = glm::min(lower, cage.texCoords[corner]);
        upper = glm::max(upper, cage.texCoords[corner]);
    }
    return {lower, upper};
}

bool isInUnitSquare(const Cage& cage) {
    constexpr float kRounding = 1e-4f; // of programs that write texture coordinates with a few digits
    const auto [lower, upper] = texCoordRange(cage);
    return lower.x >= -kRounding && lower.y >= -kRounding && upper.x <= 1 + kRounding && upper.y <= 1 + kRounding;
}

} // namespace

void placeTexCoords(Cage& cage, const ObjectDesc& desc) {
    if (desc.placement.isIdentity()) return;
    if (!cage.hasTexCoords())
        fail(Failure::input, "{}: there are no texture coordinates, which --map-repeat and --map-offset change",
             desc.cage);
    for (const std::string& map : {desc.height.path, desc.material.albedo, desc.material.normalMap.path})
        if (findTilePattern(map))
            fail(Failure::usage,
                 "{}: a set of tiles has its own texture coordinates; omit --map-repeat and --map-offset", map);
    for (vec2& st : cage.texCoords) st = vec2(desc.placement.at(dvec2(st)));
}

void warnOutsideMap(const ObjectDesc& desc, const Cage& cage, const std::string& map, const Warn& warn) {
    if (desc.height.wrap || !desc.placement.isIdentity() || !cage.hasTexCoords() || findTilePattern(map)) return;
    if (isInUnitSquare(cage)) return;
    const auto [lower, upper] = texCoordRange(cage);
    warn(fmt::format("{}: texture coordinates go from ({:.4g}, {:.4g}) to ({:.4g}, {:.4g}), outside of 0..1, where {} "
                     "repeats; --wrap repeat or clamp says what is meant, and a name with <UDIM> a set of tiles",
                     desc.cage, lower.x, lower.y, upper.x, upper.y, map));
}

namespace {

/// Whether all triangles between the first corner of a face and the others have no area in the texture, but for
/// rounding.
bool isFlatInTexture(const Cage& cage, std::size_t first, std::uint32_t size) {
    constexpr double kRounding = 4 * std::numeric_limits<float>::epsilon();
    const auto at = [&](std::size_t corner) { return dvec2(cage.texCoords[cage.texCorners[first + corner]]); };
    for (std::size_t i = 1; i + 1 < size; ++i) {
        const dvec2 a = at(i) - at(0), b = at(i + 1) - at(0), most = glm::max(glm::abs(at(0)), glm::abs(at(i)));
        const double error = kRounding * std::max(most.x, most.y) * (glm::length(a) + glm::length(b));
        if (std::abs(a.x * b.y - a.y * b.x) > error) return false;
    }
    return true;
}

} // namespace

void warnOfFlatTexCoords(const LoadedObject& object, const std::string& path, const Warn& warn) {
    const bool isTurned = object.normalMap && object.normalMap->space == NormalSpace::tangent;
    const Cage& cage = object.cage;
    if ((!isTurned && object.bumpMap() == nullptr) || !cage.hasTexCoords()) return;
    std::size_t first = 0, count = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        if (isFlatInTexture(cage, first, size)) ++count;
        first += size;
    }
    if (count > 0)
        warn(fmt::format("{}: the texture coordinates of {} of {} faces span no area: nothing says which way {} turns "
                         "their normals, and they stay as they are",
                         path, count, cage.faceSizes.size(), isTurned ? "the normal map" : "the height map"));
}

namespace {

/// Reads one map of an object, heights or vectors, which have their own encodings.
EncodedMap readHeights(const HeightDesc& height, const LayerDesc& map, const Warn& warn) {
    if (findTilePattern(map.path) && height.wrap)
        fail(Failure::usage, "{}: a set of tiles does not repeat; omit --wrap", map.path);
    if (map.vectors) {
        VectorOptions options = *map.vectors;
        options.mid = map.mid, options.scale = map.scale, options.channel = map.channel;
        options.format = height.format, options.wrap = height.wrap.value_or(options.wrap);
        return {.decoded = loadVectorMap(map.path, options, warn), .encoding = {}};
    }
    HeightOptions options{
        .mid = map.mid, .scale = map.scale, .channel = map.channel, .format = height.format, .limits = {}};
    options.wrap = height.wrap.value_or(options.wrap);
    return loadHeightMap(map.path, options, warn);
}

MapLayer readLayer(const HeightDesc& height, const LayerDesc& desc, const Warn& warn) {
    HeightDesc asStored = height; // the sum is encoded, not what it is made of
    asStored.format.reset();
    MapLayer layer{.name = desc.path,
                   .map = readHeights(asStored, desc, warn).decoded,
                   .placement = desc.placement,
                   .maskName = desc.mask,
                   .mask = {}};
    if (desc.mask.empty()) return layer;
    // Shares of 8 bits are no stairs to warn of.
    const LayerDesc mask{
        .path = desc.mask, .mid = 0, .scale = 1, .channel = {}, .vectors = {}, .mask = {}, .placement = {}};
    layer.mask = readHeights(asStored, mask, [](const std::string&) {}).decoded;
    return layer;
}

bool isPerFace(const HeightMap& map) { return map.addressing == Addressing::faces; }

/// Where one layer is a map per face, and others are not, those are made maps per face: heights alone can be.
void makeAllPerFace(std::vector<MapLayer>& layers, const ObjectDesc& desc, const Cage& cage) {
    const HeightMap* perFace = nullptr;
    bool areMixed = false;
    const auto visit = [&](const HeightMap& map) {
        if (isPerFace(map) && perFace == nullptr) perFace = &map;
        areMixed = areMixed || !isPerFace(map);
    };
    for (const MapLayer& layer : layers) {
        visit(layer.map);
        if (layer.mask) visit(*layer.mask);
    }
    const std::optional<SurfaceOptions> options = chooseSurface(desc, cage);
    if (perFace == nullptr || !areMixed || !options) return;
    for (const MapLayer& layer : layers)
        if (layer.map.vectors)
            fail(Failure::usage,
                 "{}: vectors cannot be added to a map per face; relief map makes that a map over texture coordinates",
                 layer.name);
    if (desc.weld)
        fail(Failure::usage, "{}: with --weld, a map per face cannot be added to other maps; weld the cage's file",
             desc.cage);
    // The others get nodes as fine as their texels, on the faces of the cage that the map per face is for.
    const Surface surface = buildSurface(cage, *options);
    const ReferenceSurface reference(cage, *options);
    const std::uint64_t topology = perFace->topology;
    const auto convert = [&](HeightMap& map, MapPlacement& placement) {
        if (isPerFace(map)) return;
        map = toFaceMap(map, placement, surface, reference);
        map.topology = topology;
        placement = {};
    };
    for (MapLayer& layer : layers) {
        convert(layer.map, layer.placement);
        MapPlacement ofMask;
        if (layer.mask) convert(*layer.mask, ofMask);
    }
}

/// The map of an object, with its layers added.
EncodedMap readAllHeights(const ObjectDesc& desc, const Cage& cage, const Warn& warn) {
    const HeightDesc& height = desc.height;
    const LayerDesc first{.path = height.path,
                          .mid = height.mid,
                          .scale = height.scale,
                          .channel = height.channel,
                          .vectors = height.vectors,
                          .mask = {},
                          .placement = {}};
    if (height.layers.empty()) return readHeights(height, first, warn);
    std::vector<MapLayer> layers{readLayer(height, first, warn)};
    for (const LayerDesc& layer : height.layers) layers.push_back(readLayer(height, layer, warn));
    makeAllPerFace(layers, desc, cage);
    const Wrap wrap = height.wrap.value_or(Wrap::repeat);
    EncodedMap sum = addLayers(layers, wrap, height.format.value_or(MapFormat::real));
    if (sum.decoded.addressing == Addressing::texture && wrap == Wrap::repeat && !repeatsWhole(layers) &&
        cage.hasTexCoords() && !isInUnitSquare(cage))
        fail(Failure::usage,
             "{}: texture coordinates leave 0..1, where the sum of layers repeats: each repeat= has to be a whole "
             "number",
             desc.cage);
    return sum;
}

/// The first set of tiles among the maps of an object.
std::string findSet(const HeightDesc& height) {
    if (findTilePattern(height.path)) return height.path;
    for (const LayerDesc& layer : height.layers)
        if (findTilePattern(layer.path)) return layer.path;
    return height.path;
}

/// Tiles that corners of faces lie in, each a little towards the middle of its face: on a border they would be others.
void warnOfMissingTiles(const Cage& cage, const HeightMap& set, const std::string& path, const Warn& warn) {
    const TilePattern pattern = *findTilePattern(path);
    std::vector<std::string> missing;
    std::size_t first = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        dvec2 middle(0);
        for (std::uint32_t k = 0; k < size; ++k)
            middle += dvec2(cage.texCoords[cage.texCorners[first + k]]) / double(size);
        for (std::uint32_t k = 0; k < size; ++k) {
            const dvec2 st = glm::mix(dvec2(cage.texCoords[cage.texCorners[first + k]]), middle, 1e-3);
            if (findTile(set.tiles, st) != nullptr) continue;
            const ivec2 place(glm::floor(glm::clamp(st, dvec2(-1e6), dvec2(1e6))));
            const std::string name = std::min(place.x, place.y) < 0
                                         ? fmt::format("of s and t from {} and {}", place.x, place.y)
                                         : nameTile(pattern, place);
            if (std::ranges::find(missing, name) == missing.end()) missing.push_back(name);
        }
        first += size;
    }
    if (missing.empty()) return;
    // One warning names the first few; sets may have a hundred tiles.
    constexpr std::size_t kMostNames = 8;
    std::string names;
    for (std::size_t i = 0; i < std::min(missing.size(), kMostNames); ++i) names += (i > 0 ? ", " : "") + missing[i];
    if (missing.size() > kMostNames) names += fmt::format(" and {} more", missing.size() - kMostNames);
    warn(fmt::format("{}: the set has no tile {}, which texture coordinates lie in: nothing is displaced there", path,
                     names));
}

/// A map that relief has baked says for which cage, mid and scale.
void warnOfOtherOrigin(const ObjectDesc& desc, std::uint64_t topology, const Warn& warn) {
    const HeightDesc& height = desc.height;
    const std::string file = findTilePattern(height.path) ? listTiles(height.path).front().path : height.path;
    if (height.vectors) return;
    const ImageInfo info = readImageInfo(file);
    const std::optional<MapOrigin> origin = readMapOrigin(info);
    if (!origin) return;
    if (origin->topology != topology)
        warn(fmt::format("{}: this map was baked over another cage than {}, or with another --weld", file, desc.cage));
    const double mid = height.mid.value_or(info.hasUnit() ? 0 : 0.5), scale = height.scale.value_or(1);
    // Equal but for the digits that relief bake does not print.
    const auto isSame = [](double a, double b) { return std::abs(a - b) <= 1e-6 * std::abs(b); };
    if (!isSame(mid, origin->mid) || !isSame(scale, origin->scale))
        warn(fmt::format("{}: this map was baked for --mid {} --scale {}; it is read with --mid {} --scale {}", file,
                         origin->mid, origin->scale, mid, scale));
}

} // namespace

void fitHeights(LoadedObject& object, const ObjectDesc& desc, const Warn& warn) {
    HeightMap& map = *object.height;
    const std::uint64_t topology = hashTopology(object.cage);
    if (map.addressing != Addressing::faces) return warnOfOtherOrigin(desc, topology, warn);
    if (map.topology != topology)
        fail(Failure::input,
             "{}: this map per face was made for another cage than {} ({:016x}, not {:016x}), or with another --weld",
             desc.height.path, desc.cage, map.topology, topology);
    fitToFaces(map, object.surface);
    EncodedMap encoded = encode(map, object.heightEncoding.format);
    object.height = std::move(encoded.decoded);
    object.heightEncoding = std::move(encoded.encoding);
}

EncodedMap loadHeights(const ObjectDesc& desc, const Cage& cage, const Warn& warn) {
    EncodedMap map = readAllHeights(desc, cage, warn);
    const std::string& path = desc.height.path;
    // What each addressing needs of the cage, and what it cannot be combined with.
    if (map.decoded.addressing == Addressing::faces) {
        if (desc.height.detail == Detail::bump || desc.height.detail == Detail::both)
            fail(Failure::usage,
                 "{}: a map per face has no texture coordinates, which bend normals; use --detail displacement", path);
        if (!desc.placement.isIdentity() && desc.material.albedo.empty() && desc.material.normalMap.path.empty())
            fail(Failure::usage,
                 "{}: a map per face has no texture coordinates to change; omit --map-repeat and --map-offset", path);
        return map;
    }
    if (map.decoded.addressing == Addressing::tiles) {
        const std::string set = findSet(desc.height);
        if (!cage.hasTexCoords())
            fail(Failure::input, "{}: there are no texture coordinates, which the set of tiles {} needs", desc.cage,
                 set);
        if (!desc.placement.isIdentity())
            fail(Failure::usage,
                 "{}: a set of tiles has its own texture coordinates; omit --map-repeat and --map-offset", set);
        warnOfMissingTiles(cage, map.decoded, set, warn);
        return map;
    }
    if (!cage.hasTexCoords())
        warn(fmt::format("{}: no texture coordinates: every face takes the whole map", desc.cage));
    warnOutsideMap(desc, cage, path, warn);
    return map;
}

void fitUnitToHeights(LoadedObject& object, const Warn& warn) {
    constexpr double kUsual = 1 << 20, kMost = 1e15;
    Coordinates& coordinates = object.cage.coordinates;
    const double bound = object.height->heightBound(), size = summarize(object.cage).bounds.longestSide();
    const double ratio = size > 0 ? bound / size : 0;
    if (ratio > kMost)
        warn(fmt::format("heights of up to {:.3g} cage units on a cage {:.3g} large: 32-bit floats hold at most {:.0e} "
                         "times its size; lower --scale",
                         bound, size, kMost));
    if (ratio > kUsual) {
        const double factor = std::ldexp(1.0, std::ilogb(std::min(ratio, kMost)) / 2);
        for (vec3& p : object.cage.positions) p = dvec3(p) / factor;
        coordinates.unit *= factor;
    }
    scaleHeights(*object.height, 1 / coordinates.unit);
}

NormalMap loadNormals(const ObjectDesc& desc, const LoadedObject& object, const Warn& warn) {
    const NormalMapDesc& map = desc.material.normalMap;
    if (map.space == NormalSpace::object && object.animation)
        fail(Failure::usage,
             "{}: normals of object space do not follow a cage that changes its shape; bake them as --normal-space "
             "tangent",
             map.path);
    NormalOptions options{.space = map.space, .y = map.y, .limits = {}};
    options.wrap = desc.height.wrap.value_or(options.wrap);
    if (!findTilePattern(map.path)) return loadNormalMap(map.path, options, warn);
    JoinedPictures joined = joinPictures(map.path, vec3(0.5f, 0.5f, 1.0f), warn);
    options.wrap = Wrap::clamp;
    NormalMap normals = makeNormalMap(joined.image, map.path, options, warn);
    normals.tiles = joined.tiles;
    return normals;
}

void loadAlbedo(LoadedObject& object, const std::string& path, const Warn& warn) {
    if (!findTilePattern(path)) {
        object.albedo = loadColors(path, warn);
        return;
    }
    JoinedPictures joined = joinPictures(path, {}, warn);
    object.albedo = std::move(joined.image);
    object.albedoTiles = joined.tiles;
    object.wrap = Wrap::clamp;
}

Image loadColors(const std::string& path, const Warn& warn) {
    // Which channels are the colors.
    const ImageInfo info = readImageInfo(path);
    if (info.channels < 3)
        fail(Failure::input, "{}: an albedo map has 3 channels, this one has {}", path, info.channels);
    const std::vector<std::string> layers = layersOf(info);
    if (layers.size() > 1)
        warn(fmt::format("{}: there are {} layers; the colors are channels {}, {} and {}, the first ones", path,
                         layers.size(), info.channelNames[0], info.channelNames[1], info.channelNames[2]));
    // Values that are no colors: refused where they are no numbers, else clamped by the device's format.
    Image image = readImage(path);
    if (const std::optional<BadTexel> bad = findNotFinite(image))
        fail(Failure::input,
             "{}: channel {} of the texel in column {}, row {} (from 0, top left) is {}; colors are finite numbers",
             path, info.channelNames[std::size_t(bad->channel)], bad->x, bad->y, bad->value);
    const auto clamped = std::ranges::count_if(image.texels, [](float value) { return value < 0 || value > 1; });
    if (clamped > 0)
        warn(fmt::format("{}: {} of {} values are outside of 0..1, the range of an albedo; they are clamped to it",
                         path, clamped, image.texels.size()));
    return image;
}

Image loadMatcap(const std::string& path) {
    const ImageInfo info = readImageInfo(path);
    const Image file = readImage(path);
    if (file.channels < 3 || file.width != file.height)
        fail(Failure::input, "{}: a matcap is a square color picture of a ball; this one is {} x {} with {} channels",
             path, file.width, file.height, file.channels);
    Image ball{file.width, file.height, 3, {}};
    ball.texels.reserve(std::size_t(file.width) * std::size_t(file.height) * 3);
    for (int y = 0; y < file.height; ++y)
        for (int x = 0; x < file.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const float value = file.at(x, y)[c];
                if (!std::isfinite(value) || value < 0)
                    fail(Failure::input, "{}: pixel {},{} is {}; light is a number from 0 on", path, x, y, value);
                // Codes are sRGB (IEC 61966-2-1), made linear.
                const float linear = value <= 0.04045f ? value / 12.92f : std::pow((value + 0.055f) / 1.055f, 2.4f);
                ball.texels.push_back(info.isFloat ? value : linear);
            }
    return ball;
}

} // namespace relief
