#include <algorithm>
#include <cmath>
#include <iostream>

#include <malloc.h>

#include <nlohmann/json.hpp>

#include "app/bake_maps.h"
#include "app/commands.h"
#include "app/heatmap.h"
#include "base/clock.h"

namespace relief::app {
namespace {

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

/// What is said of the map itself.
void describeMap(BakeReport& report, const HeightMap& map) {
    report.addressing = map.addressing, report.tileCount = map.tiles.size();
    report.width = map.width, report.height = map.height;
    report.mid = map.mid, report.scale = map.scale * report.unit;
    report.lowest = report.scale * (double(map.lowest) - map.mid);
    report.highest = report.scale * (double(map.highest) - map.mid);
}

int bake(const BakeArgs& args) {
    checkBakeArgs(args);
    const Warn warn = makeWarn(args.output.isQuiet);
    BakeReport report{.cage = args.object.cage,
                      .sculpt = args.sculpt,
                      .map = args.checksOnly ? args.object.height.path : args.target};
    const double start = secondsNow();
    BakePair pair(args, warn);
    report.unit = pair.unit, report.diagonal = pair.diagonal, report.sculptTriangles = pair.triangleCount;
    report.tolerance = args.tolerance.cageUnits(pair.diagonal);
    report.readSeconds = secondsNow() - start;

    // The map: baked, or as it was. Heights on disk are in cage units.
    const double bakeStart = secondsNow();
    HeightMap map;
    if (args.checksOnly) {
        map = *pair.object.height;
    } else {
        map = bakeMaps(args, pair, report);
        map.scale /= pair.unit;
    }
    malloc_trim(0); // what baking has freed is for the certificate
    describeMap(report, map);
    report.bakeSeconds = secondsNow() - bakeStart;

    const double certifyStart = secondsNow();
    constexpr std::uint64_t kFewest = 200'000, kMost = 1'000'000;
    report.certificate = certifyBake(pair.reference, map, pair.sculpt,
                                     {.lines = pair.lines,
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
