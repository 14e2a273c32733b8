#include "app/bake_maps.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/files_together.h"
#include "displacement/map_origin.h"

namespace relief::app {
namespace {

// --- files --------------------------------------------------------------------------------------------------------

/// The file of a tile; the path itself where it names no set.
std::string nameFile(const std::string& path, const ivec2& tile) {
    const std::optional<TilePattern> pattern = findTilePattern(path);
    return pattern ? pattern->before + nameTile(*pattern, tile) + pattern->after : path;
}

void writeVoids(const BakeArgs& args, const BakedHeights& baked, const ivec2& tile) {
    if (args.voids.empty()) return;
    Image mask{baked.width, baked.height, 1, std::vector<float>(baked.states.size())};
    for (std::size_t i = 0; i < baked.states.size(); ++i)
        mask.texels[i] = baked.states[i] == TexelState::missed ? 1.0f : 0.0f;
    writeImage(nameFile(args.voids, tile), mask,
               lowerExtension(args.voids) == ".exr" ? SampleType::half : SampleType::uint8);
}

/// Directions are written as codes (n + 1) / 2; lengths in cage units, positions in the world.
void writeLayers(const BakeArgs& args, BakedHeights& baked, const Cage& cage, const ivec2& tile) {
    const Coordinates& coordinates = cage.coordinates;
    const std::vector<LayerFile> files = listLayers(args);
    for (std::size_t i = 0; i < files.size(); ++i) {
        const auto& [path, layer] = files[i];
        Image& image = baked.layers[i];
        const auto mapEach = [&](const auto& change) {
            for (std::size_t k = 0; k < image.texels.size(); ++k)
                image.texels[k] = float(change(double(image.texels[k]), int(k) % image.channels));
        };
        const double up = layer == SculptLayer::tangentNormal && args.normalY == NormalY::down ? -1 : 1;
        if (layer == SculptLayer::tangentNormal || layer == SculptLayer::objectNormal)
            mapEach([&](double n, int k) { return 0.5 * (k == 1 ? up : 1.0) * n + 0.5; });
        if (layer == SculptLayer::position)
            mapEach([&](double x, int k) { return coordinates.origin[k] + coordinates.unit * x; });
        if (layer == SculptLayer::vector) mapEach([&](double x, int) { return coordinates.unit * x; });
        if (layer == SculptLayer::curvature) mapEach([&](double x, int) { return x / coordinates.unit; });
        const bool isExr = lowerExtension(path) == ".exr";
        writeImage(nameFile(path, tile), image, isExr || hasUnit(layer) ? SampleType::real : SampleType::uint16,
                   toAttributes({.topology = hashTopology(cage)}));
        image = {};
    }
}

// --- heights over texture coordinates -----------------------------------------------------------------------------

/// What makes heights of the numbers in the file, for heights of that range in cage units.
MapOrigin chooseOrigin(const BakeArgs& args, double lowest, double highest) {
    const bool spans = chooseHeightSample(args) == SampleType::uint16;
    const double range = highest - lowest;
    MapOrigin origin{.scale = args.object.height.scale.value_or(spans && range > 0 ? range : 1.0)};
    if (origin.scale == 0) fail(Failure::usage, "--scale 0 holds no heights");
    origin.mid = args.object.height.mid.value_or(spans ? -lowest / origin.scale : 0.0);
    return origin;
}

/// Makes the file's numbers of heights; returns how many do not fit.
std::uint64_t encodeHeights(std::span<float> heights, double unit, SampleType sample, const MapOrigin& origin) {
    std::uint64_t clippedCount = 0;
    for (float& height : heights) {
        double value = unit * double(height) / origin.scale + origin.mid;
        if (sample == SampleType::uint16) {
            constexpr double kSteps = 65535;
            clippedCount += value < -0.5 / kSteps || value > 1 + 0.5 / kSteps ? 1 : 0;
            value = std::round(std::clamp(value, 0.0, 1.0) * kSteps) / kSteps;
        }
        height = float(value);
    }
    return clippedCount;
}

/// A picture of heights, or a tile of a set of them.
struct BakedTile {
    ivec2 place{0};
    std::vector<float> heights;
};

/// Writes the heights of all tiles with one scale, and returns them as they are in the files.
HeightMap storeHeights(const BakeArgs& args, const BakePair& pair, std::vector<BakedTile> tiles, const Warn& warn) {
    // One range over all tiles: integers of every file mean the same heights.
    double lowest = INFINITY, highest = -INFINITY;
    for (const BakedTile& tile : tiles) {
        const auto [low, high] = std::ranges::minmax(tile.heights);
        lowest = std::min(lowest, pair.unit * double(low)), highest = std::max(highest, pair.unit * double(high));
    }
    const SampleType sample = chooseHeightSample(args);
    MapOrigin origin = chooseOrigin(args, lowest, highest);
    origin.topology = hashTopology(pair.object.cage);
    const bool isSet = findTilePattern(args.target).has_value();
    const Wrap wrap = isSet ? Wrap::clamp : args.object.height.wrap.value_or(Wrap::repeat);

    // Tiles are encoded and written one by one; what the files hold is kept for the certificate.
    std::vector<HeightMap> maps;
    std::vector<ivec2> places;
    std::uint64_t clippedCount = 0;
    for (BakedTile& tile : tiles) {
        clippedCount += encodeHeights(tile.heights, pair.unit, sample, origin);
        Image image{args.size.x, args.size.y, 1, std::move(tile.heights)};
        writeImage(nameFile(args.target, tile.place), image, sample, toAttributes(origin));
        maps.push_back(
            makeHeightMap(image.width, image.height, std::move(image.texels), origin.mid, origin.scale, wrap));
        places.push_back(tile.place);
    }
    if (clippedCount > 0)
        warn(fmt::format("{}: {} texels do not fit into 0..1 with --mid {} --scale {}; they are clipped", args.target,
                         clippedCount, origin.mid, origin.scale));
    HeightMap map = isSet ? makeTileSet(maps, places) : std::move(maps.front());
    return sample == SampleType::half ? encode(map, MapFormat::half).decoded : map;
}

/// What the map cannot show, however it is baked.
void warnOfIslands(const BakeArgs& args, const UvTexels& texels, const Warn& warn) {
    const IslandOverlap overlap = texels.overlap();
    if (overlap.sampleCount > 0)
        warn(fmt::format("{}: islands of texture coordinates lie over each other ({} samples; faces {} and {} are the "
                         "first): their texels show the face with the lower number",
                         args.object.cage, overlap.sampleCount, overlap.faces[0], overlap.faces[1]));
    const std::vector<std::int32_t>& flat = texels.flatFaces();
    if (!flat.empty())
        warn(fmt::format("{}: {} faces have texture coordinates without area, face {} is the first: no texel shows "
                         "them",
                         args.object.cage, flat.size(), flat.front()));
}

/// Faces that no sample lies in: too small, or under others.
void warnOfUnseenFaces(const BakeArgs& args, const BakePair& pair, const BakedHeights& baked, const Warn& warn) {
    std::vector<int> unseen;
    for (int face = 0; face < pair.reference.faceCount(); ++face)
        if (!baked.seenFaces[std::size_t(face)] && !pair.reference.isHole(face)) unseen.push_back(face);
    if (!unseen.empty())
        warn(fmt::format(
            "{}: {} faces have no sample of {} x {} texels, face {} is the first: their islands are smaller "
            "than a texel, or under others",
            args.object.cage, unseen.size(), args.size.x, args.size.y, unseen.front()));
}

/// Throws for tiles that the name of the files cannot number, before anything is baked.
void checkTiles(const BakeArgs& args, std::span<const ivec2> tiles) {
    const std::optional<TilePattern> pattern = findTilePattern(args.target);
    if (!pattern) return;
    const bool isUdim = pattern->numbers == TilePattern::Numbers::udim;
    const ivec2 most = isUdim ? ivec2(9, 898) : ivec2(1023);
    for (const ivec2& tile : tiles)
        if (glm::any(glm::lessThan(tile, ivec2(0))) || glm::any(glm::greaterThan(tile, most)))
            fail(
                Failure::input,
                "{}: texture coordinates lie in the unit square from ({}, {}) on, which no tile of {} is; they go from "
                "(0, 0) to ({}, {})",
                args.object.cage, tile.x, tile.y, args.target, most.x, most.y);
}

void addCounts(BakedHeights& sum, const BakedHeights& part) {
    sum.texelCount += part.texelCount, sum.voidCount += part.voidCount;
    sum.sampleCount += part.sampleCount, sum.missCount += part.missCount;
    sum.seenFaces.resize(part.seenFaces.size());
    for (std::size_t i = 0; i < part.seenFaces.size(); ++i)
        if (part.seenFaces[i]) sum.seenFaces[i] = true;
    sum.behindCount += part.behindCount, sum.insideCount += part.insideCount;
}

HeightMap bakePictures(const BakeArgs& args, const BakePair& pair, const BakeOptions& options, BakeReport& report) {
    const Warn warn = makeWarn(args.output.isQuiet);
    // A single map is a set of one tile at the origin.
    const bool isSet = findTilePattern(args.target).has_value();
    const std::vector<ivec2> places = isSet ? findTilesOfFaces(pair.reference) : std::vector<ivec2>{ivec2(0)};
    checkTiles(args, places);
    std::vector<BakedTile> tiles;
    for (const ivec2& place : places) {
        const UvTexels texels(pair.object.surface, pair.reference,
                              {.width = args.size.x,
                               .height = args.size.y,
                               .samplesPerSide = args.samplesPerSide(),
                               .margin = args.margin,
                               .wrap = isSet ? Wrap::clamp : args.object.height.wrap.value_or(Wrap::repeat),
                               .origin = dvec2(place)});
        BakedHeights baked = bakeHeights(pair.reference, pair.sculpt, texels, options);
        // Islands that overlap or are too small are the same in all maps of a tile: said once.
        if (place == places.front() || texels.overlap().sampleCount > 0) warnOfIslands(args, texels, warn);
        addCounts(report.baked, baked);
        report.overlap.sampleCount += texels.overlap().sampleCount;
        if (baked.texelCount == 0) continue;
        writeVoids(args, baked, place);
        writeLayers(args, baked, pair.object.cage, place);
        tiles.push_back({place, std::move(baked.heights)});
    }
    if (tiles.empty())
        fail(Failure::input, "{}: no texel of {} x {} lies on an island of its texture coordinates", args.object.cage,
             args.size.x, args.size.y);
    warnOfUnseenFaces(args, pair, report.baked, warn);
    return storeHeights(args, pair, std::move(tiles), warn);
}

// --- heights per face ---------------------------------------------------------------------------------------------

HeightMap bakeFaces(const BakeArgs& args, const BakePair& pair, const BakeOptions& options, BakeReport& report) {
    FaceTexelOptions faces{.samplesPerSide = args.samplesPerSide()};
    if (args.faceSize) {
        const int log = std::countr_zero(unsigned(*args.faceSize));
        for (int face = 0; face < pair.reference.faceCount(); ++face)
            faces.segments.emplace_back(pair.reference.isHole(face) ? 0 : log);
    } else {
        const double texels = double(args.size.x) * double(args.size.y);
        faces.segments =
            chooseSegments(pair.reference, args.texelSize ? args.texelSize->cageUnits(pair.diagonal) / pair.unit
                                                          : std::sqrt(computeArea(pair.reference) / texels));
    }
    const FaceTexels texels(pair.object.surface, pair.reference, std::move(faces));
    const BakedHeights baked = bakeHeights(pair.reference, pair.sculpt, texels, options);
    addCounts(report.baked, baked);
    if (baked.texelCount == 0) fail(Failure::input, "{}: all of its faces are holes", args.object.cage);
    const auto mapOf = [&](const auto& valueAt) {
        HeightMap map = makeFaceMap(pair.object.surface, texels.segments(), [&](int face, const dvec2& uv) {
            return double(valueAt(texels.texelAt(face, uv)));
        });
        map.topology = hashTopology(pair.object.cage);
        return map;
    };
    // The mask first, so that both maps need not be there at a time.
    if (!args.voids.empty()) {
        const auto isMissed = [&](std::uint32_t texel) { return baked.states[texel] == TexelState::missed ? 1 : 0; };
        saveFaceMap(args.voids, mapOf(isMissed));
    }
    // Heights in cage units: rounded as the file holds them.
    const bool isHalf = chooseHeightSample(args) == SampleType::half;
    HeightMap map = mapOf([&](std::uint32_t texel) { return pair.unit * double(baked.heights[texel]); });
    if (isHalf) map = encode(map, MapFormat::half).decoded;
    saveFaceMap(args.target, map);
    return map;
}

} // namespace

HeightMap bakeMaps(const BakeArgs& args, const BakePair& pair, BakeReport& report) {
    BakeOptions options{
        .lines = pair.lines, .dropsBehind = args.dropsBehind, .layers = {}, .progress = args.output.progress};
    SculptDetail detail;
    for (const LayerFile& file : listLayers(args)) options.layers.layers.push_back(file.layer);
    if (!options.layers.layers.empty()) {
        detail = computeSculptDetail(pair.sculpt.triangles(), options.lines.facing);
        options.layers.detail = &detail;
        options.layers.occlusionLines = std::max(1, args.occlusionLines / args.sampleCount);
        options.layers.occlusionReach = pair.sculptBox.diagonal();
    }
    // All files of one run go together: a full disk leaves those that were there.
    FilesTogether files;
    HeightMap map = args.perFace ? bakeFaces(args, pair, options, report) : bakePictures(args, pair, options, report);
    files.takePlaces();
    const Warn warn = makeWarn(args.output.isQuiet);
    const BakedHeights& baked = report.baked;
    if (baked.voidCount > 0)
        warn(fmt::format("{}: {} of {} texels are voids: their lines miss {}; they are filled from around", args.target,
                         baked.voidCount, baked.texelCount, args.sculpt));
    if (baked.insideCount > 0)
        warn(fmt::format("{}: {} of {} lines look both ways, because the cage lies inside of the surface there",
                         args.smoothCage ? "--smooth-cage" : args.lineCage, baked.insideCount, baked.sampleCount));
    report.isBaked = true;
    return map;
}

} // namespace relief::app
