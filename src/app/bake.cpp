#include <algorithm>
#include <cmath>
#include <iostream>

#include <malloc.h>

#include <nlohmann/json.hpp>

#include "app/bake_options.h"
#include "app/bake_report.h"
#include "app/commands.h"
#include "app/heatmap.h"
#include "base/clock.h"

namespace relief::app {
namespace {

// --- the sculpt ---------------------------------------------------------------------------------------------------

std::string describeBox(const Bounds& box) {
    return fmt::format("({:.4g}, {:.4g}, {:.4g}) to ({:.4g}, {:.4g}, {:.4g})", box.lower.x, box.lower.y, box.lower.z,
                       box.upper.x, box.upper.y, box.upper.z);
}

TriangleMesh loadSculpt(const BakeArgs& args, const Coordinates& coordinates, const Warn& warn) {
    TriangleMesh mesh = readSculpt(args.sculpt, coordinates, warn);
    const SculptFaults faults = windAlike(mesh);
    if (faults.turnedCount > 0)
        warn(fmt::format("{}: {} of {} triangles were wound against those around them; they are turned over",
                         args.sculpt, faults.turnedCount, mesh.indices.size() / 3));
    if (faults.nonManifoldCount > 0)
        warn(fmt::format("{}: {} edges have more than two triangles (not manifold); the winding is not followed across "
                         "them",
                         args.sculpt, faults.nonManifoldCount));
    if (faults.nonOrientableCount > 0)
        warn(fmt::format("{}: {} edges have triangles that cannot be wound alike (as of a Moebius strip)", args.sculpt,
                         faults.nonOrientableCount));
    return mesh;
}

/// Which side of the sculpt is outside, as seen from the surface. A sculpt that is wound the other way is taken as it
/// is, with a word about it.
Facing chooseFacing(const BakeArgs& args, const SculptSides& sides, const Bounds& cageBox, const Bounds& sculptBox,
                    const Warn& warn) {
    const std::uint64_t hits = sides.frontCount + sides.backCount;
    if (hits == 0)
        fail(Failure::input,
             "{}: none of {} lines along the normals of {} meets it within --max-distance; the cage's box is {}, the "
             "sculpt's {}",
             args.sculpt, sides.lineCount, args.object.cage, describeBox(cageBox), describeBox(sculptBox));
    if (sides.facing() == Facing::back)
        warn(fmt::format("{}: its triangles are wound inside out ({:.0f} % of the lines see their backs); the other "
                         "side is taken for the outside",
                         args.sculpt, 100.0 * double(sides.backCount) / double(hits)));
    const double fewer = double(std::min(sides.frontCount, sides.backCount)) / double(hits);
    if (fewer > 0.1)
        warn(fmt::format("{}: {:.0f} % of the lines meet a triangle first that faces the other way; is the surface far "
                         "from the sculpt, or are its parts wound differently?",
                         args.sculpt, 100 * fewer));
    return sides.facing();
}

// --- the map ------------------------------------------------------------------------------------------------------

/// Values as the file holds them, and what makes heights of them.
HeightMap toStored(const BakedHeights& baked, const BakeArgs& args, double unit, const Warn& warn) {
    const SampleType sample = chooseHeightSample(args);
    const auto [low, high] = std::ranges::minmax_element(baked.heights);
    const double lowest = unit * double(*low), range = unit * double(*high) - lowest;
    const bool spans = sample == SampleType::uint16;
    const double scale = args.object.height.scale.value_or(spans && range > 0 ? range : 1.0);
    if (scale == 0) fail(Failure::usage, "--scale 0 holds no heights");
    const double mid = args.object.height.mid.value_or(spans ? -lowest / scale : 0.0);
    std::vector<float> values(baked.heights.size());
    std::uint64_t clippedCount = 0;
    for (std::size_t i = 0; i < values.size(); ++i) {
        double value = unit * double(baked.heights[i]) / scale + mid;
        if (spans) {
            constexpr double kSteps = 65535;
            clippedCount += value < -0.5 / kSteps || value > 1 + 0.5 / kSteps ? 1 : 0;
            value = std::round(std::clamp(value, 0.0, 1.0) * kSteps) / kSteps;
        }
        values[i] = float(value);
    }
    if (clippedCount > 0)
        warn(fmt::format("{}: {} texels do not fit into 0..1 with --mid {} --scale {}; they are clipped", args.target,
                         clippedCount, mid, scale));
    const Wrap wrap = args.object.height.wrap.value_or(Wrap::repeat);
    HeightMap map = makeHeightMap(baked.width, baked.height, std::move(values), mid, scale, wrap);
    return sample == SampleType::half ? encode(map, MapFormat::half).decoded : map;
}

void writeHeights(const BakeArgs& args, const HeightMap& map) {
    const Image image{map.width, map.height, 1, map.texels};
    const SampleType sample = chooseHeightSample(args);
    if (lowerExtension(args.target) == ".exr")
        writeImage(args.target, image, {{"height", sample}});
    else
        writeImage(args.target, image, sample);
}

void writeVoids(const BakeArgs& args, const BakedHeights& baked) {
    if (args.voids.empty()) return;
    Image mask{baked.width, baked.height, 1, std::vector<float>(baked.states.size())};
    for (std::size_t i = 0; i < baked.states.size(); ++i)
        mask.texels[i] = baked.states[i] == TexelState::missed ? 1.0f : 0.0f;
    writeImage(args.voids, mask, lowerExtension(args.voids) == ".exr" ? SampleType::half : SampleType::uint8);
}

/// Directions are written as codes (n + 1) / 2; lengths in cage units, positions in the world.
void writeLayers(const BakeArgs& args, BakedHeights& baked, const Coordinates& coordinates) {
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
        writeImage(path, image, isExr || hasUnit(layer) ? SampleType::real : SampleType::uint16);
        image = {};
    }
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

// --- the command --------------------------------------------------------------------------------------------------

/// The cage's surface, and the sculpt beside it.
struct Pair {
    LoadedObject object;
    ReferenceSurface reference;
    MeasuredSurface sculpt;
    Bounds sculptBox;
    std::uint64_t triangleCount = 0;
};

Pair loadPair(const BakeArgs& args, const Warn& warn) {
    LoadedObject object = load(args.object, CageState::posed, warn);
    if (object.dense)
        fail(Failure::usage, "{}: maps are baked for subdivision surfaces; name its --scheme", args.object.cage);
    if (!object.cage.hasTexCoords())
        fail(Failure::input, "{}: there are no texture coordinates to bake over", args.object.cage);
    ReferenceSurface reference(object.cage, object.options);
    const TriangleMesh mesh = loadSculpt(args, object.cage.coordinates, warn);
    constexpr std::size_t kSamples = 200'000;
    MeasuredSurface sculpt({mesh.positions, mesh.indices}, kSamples, TreeUse::lines);
    return {std::move(object), std::move(reference), std::move(sculpt), computeBounds(mesh.positions),
            mesh.indices.size() / 3};
}

/// Bakes the map and writes it, whatever is measured of it afterwards.
HeightMap bakeMap(const BakeArgs& args, const Pair& pair, BakeOptions options, BakeReport& report) {
    const Warn warn = makeWarn(args.output.isQuiet);
    SculptDetail detail;
    for (const LayerFile& file : listLayers(args)) options.layers.layers.push_back(file.layer);
    if (!options.layers.layers.empty()) {
        detail = computeSculptDetail(pair.sculpt.triangles(), options.facing);
        options.layers.detail = &detail;
        options.layers.occlusionLines = std::max(1, args.occlusionLines / args.sampleCount);
        options.layers.occlusionReach = pair.sculptBox.diagonal();
    }
    const UvTexels texels(pair.object.surface, pair.reference,
                          {.width = args.size.x,
                           .height = args.size.y,
                           .samplesPerSide = int(std::ceil(std::sqrt(double(args.sampleCount)) - 1e-9)),
                           .margin = args.margin,
                           .wrap = options.wrap});
    BakedHeights baked = bakeHeights(pair.reference, pair.sculpt, texels, options);
    warnOfIslands(args, texels, warn);
    if (baked.texelCount == 0)
        fail(Failure::input, "{}: no texel of {} x {} lies on an island of its texture coordinates", args.object.cage,
             args.size.x, args.size.y);
    HeightMap map = toStored(baked, args, pair.object.cage.coordinates.unit, warn);
    writeHeights(args, map);
    writeVoids(args, baked);
    writeLayers(args, baked, pair.object.cage.coordinates);
    if (baked.voidCount > 0)
        warn(fmt::format("{}: {} of {} texels are voids: their lines miss {}; they are filled from around", args.target,
                         baked.voidCount, baked.texelCount, args.sculpt));
    report.isBaked = true;
    report.overlap = texels.overlap();
    baked.heights.clear(), baked.states.clear();
    report.baked = std::move(baked);
    return map;
}

/// Errors in orange, from a tenth of the tolerance on; lines that miss the sculpt in blue.
void drawHeat(const BakeArgs& args, BakeReport& report) {
    if (args.heatmap.empty()) return;
    DenseMesh& mesh = report.certificate.displaced;
    const double tolerance = std::max(report.tolerance / report.unit, 1e-30);
    for (float& heat : mesh.heights) {
        const double share = std::abs(double(heat)) / tolerance;
        heat = std::signbit(heat) ? -1.0f : float(std::clamp(1 + std::log10(std::max(share, 1e-9)), 0.0, 1.0));
    }
    Device device({.name = args.device});
    writePicture(args.heatmap, drawHeatmap(device, mesh));
    checkValidation(device);
}

int bake(const BakeArgs& args) {
    checkBakeArgs(args);
    const Warn warn = makeWarn(args.output.isQuiet);
    BakeReport report{.cage = args.object.cage,
                      .sculpt = args.sculpt,
                      .map = args.checksOnly ? args.object.height.path : args.target};
    const double start = secondsNow();
    Pair pair = loadPair(args, warn);
    const double unit = pair.object.cage.coordinates.unit;
    const double diagonal = pair.sculptBox.diagonal() * unit;
    const LineReach reach{args.front.cageUnits(diagonal) / unit, args.back.cageUnits(diagonal) / unit};
    const Facing facing =
        chooseFacing(args, findSides(pair.reference, pair.sculpt, reach), summarize(pair.object.cage).bounds,
                     pair.object.cage.coordinates.toWorld(pair.sculptBox), warn);
    report.unit = unit, report.diagonal = diagonal, report.sculptTriangles = pair.triangleCount;
    report.tolerance = args.tolerance.cageUnits(diagonal);
    report.readSeconds = secondsNow() - start;

    // The map: baked, or as it was. Heights on disk are in cage units.
    const double bakeStart = secondsNow();
    HeightMap map;
    if (args.checksOnly) {
        map = *pair.object.height;
    } else {
        map = bakeMap(args, pair,
                      {.reach = reach,
                       .facing = facing,
                       .wrap = args.object.height.wrap.value_or(Wrap::repeat),
                       .dropsBehind = args.dropsBehind,
                       .progress = args.output.progress},
                      report);
        map.scale /= unit;
    }
    report.width = map.width, report.height = map.height;
    report.mid = map.mid, report.scale = map.scale * unit;
    report.lowest = report.scale * (double(map.lowest) - map.mid);
    report.highest = report.scale * (double(map.highest) - map.mid);
    malloc_trim(0);
    report.bakeSeconds = secondsNow() - bakeStart;

    const double certifyStart = secondsNow();
    constexpr std::uint64_t kFewest = 200'000, kMost = 1'000'000;
    report.certificate = certifyBake(pair.reference, map, pair.sculpt,
                                     {.reach = reach,
                                      .facing = facing,
                                      .triangleCount = std::clamp(2 * pair.triangleCount, kFewest, kMost),
                                      .wantsDistances = !args.heatmap.empty(),
                                      .progress = args.output.progress});
    report.seams = reportSeams(pair.object.surface, pair.reference, map);
    report.certifySeconds = secondsNow() - certifyStart;
    drawHeat(args, report);

    if (args.output.isJson)
        printJson(toJson(report));
    else if (!args.output.isQuiet)
        std::cout << toText(report);
    std::cout.flush(); // before the line on stderr
    if (!report.passes())
        fail(Failure::check, "{}: the displaced surface and {} are {:.4g} apart (RMS); the tolerance is {:.4g}",
             report.map, args.sculpt, report.rms(), report.tolerance);
    return 0;
}

} // namespace

Run addBake(CLI::App& app) {
    auto args = std::make_shared<BakeArgs>();
    addBakeOptions(app, *args);
    return [args] { return bake(*args); };
}

} // namespace relief::app
