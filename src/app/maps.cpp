#include <iostream>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/object_options.h"
#include "app/options.h"
#include "app/output.h"
#include "maps/maps.h"

namespace relief::app {
namespace {

/// What both verbs take.
struct MapArgs {
    std::string source, target;
    std::optional<dvec2> size;
    Wrap wrap = Wrap::repeat;
    NormalY y = NormalY::up;
    bool isJson = false, isQuiet = false;
};

void addMap(CLI::App& app, MapArgs& args, const char* yHelp) {
    listIn("map", "W,H",
           addVector<dvec2>(app, "--size", args.size,
                            "true width and height of the unit square of texture space, in the unit of the heights "
                            "(default: a width of 1, and square texels)")
               ->check(numberIn(1e-30, 1e30)));
    listIn("map", "WRAP", addEnum(app, "--wrap", args.wrap, kWraps, "what lies outside of the map"));
    listIn("map", "Y", addEnum(app, "--normal-y", args.y, kNormalYs, yHelp));
    app.add_flag("--json", args.isJson, "print the result as JSON on stdout")->group("output");
    app.add_flag("-q,--quiet", args.isQuiet, "print no warnings and no summary")->group("output");
}

/// The samples of a picture by its extension; `bits` are 8 or 16, or 0 where none are asked for.
SampleType chooseSample(const std::string& target, int bits) {
    const std::string extension = lowerExtension(target);
    if (extension == ".exr") {
        if (bits > 0) fail(Failure::usage, "{}: EXR holds floats; --bits is for .png and .tif", target);
        return SampleType::real;
    }
    if (extension == ".png" || extension == ".tif" || extension == ".tiff")
        return bits == 8 ? SampleType::uint8 : SampleType::uint16;
    fail(Failure::usage, "{}: unknown kind of picture '{}'; use .png, .exr, .tif or .tiff", target, extension);
}

// --- normals from heights -----------------------------------------------------------------------------------------

struct NormalMapArgs : MapArgs {
    HeightDesc height;
    int bits = 0;
};

int makeNormalMapFile(const NormalMapArgs& args) {
    const SampleType sample = chooseSample(args.target, args.bits);
    checkOutput(args.target, {args.source});
    const HeightOptions options{.mid = args.height.mid,
                                .scale = args.height.scale,
                                .channel = args.height.channel,
                                .wrap = args.wrap,
                                .limits = {}};
    const HeightMap heights = loadHeightMap(args.source, options, makeWarn(args.isQuiet)).decoded;
    if (heights.addressing != Addressing::texture)
        fail(Failure::usage, "{}: normals are made of one map over the unit square, not of tiles", args.source);
    // Slopes need the size of the map in the units of its heights: by default its shape with a longer side of 1.
    const MapSize size = args.size.value_or(computeMapSize(heights.width, heights.height));
    const NormalMap normals = computeNormalMap(heights, size);
    writeImage(args.target, toCodes(normals, args.y), sample);
    const double steepest = computeSteepestSlope(normals);
    if (args.isJson)
        printJson({{"output", args.target},
                   {"width", normals.width},
                   {"height", normals.height},
                   {"size", {size.x, size.y}},
                   {"wrap", wordOf(kWraps, args.wrap)},
                   {"normal_y", wordOf(kNormalYs, args.y)},
                   {"steepest_degrees", steepest}});
    else if (!args.isQuiet)
        std::cerr << fmt::format(
            "{}: {} x {} normals, up to {:.1f} degrees steep where the unit square is {:g} by {:g}\n", args.target,
            normals.width, normals.height, steepest, size.x, size.y);
    return 0;
}

// --- heights from normals -----------------------------------------------------------------------------------------

struct HeightMapArgs : MapArgs {
    NormalSpace space = NormalSpace::tangent;
};

/// Stored values of heights, and what makes heights of them again.
struct StoredHeights {
    Image image;
    double mid = 0, scale = 1;
};

/// Floats are the heights themselves; integers span their range.
StoredHeights toStored(const HeightMap& heights, SampleType sample) {
    StoredHeights stored{
        .image = {.width = heights.width, .height = heights.height, .channels = 1, .texels = heights.texels}};
    const double range = double(heights.highest) - heights.lowest;
    if (sample == SampleType::real || range == 0) return stored;
    for (float& texel : stored.image.texels) texel = float((double(texel) - heights.lowest) / range);
    stored.mid = -heights.lowest / range;
    stored.scale = range;
    return stored;
}

/// A slope that goes on and on cannot repeat; most other parts that no height has are noise.
void warnOfMeanSlope(const HeightMapArgs& args, const IntegratedHeights& result, const Warn& warn) {
    constexpr double kNoticeable = 0.05; // of the slopes, as lengths
    const double mean = glm::length(result.meanSlope);
    if (args.wrap == Wrap::repeat && mean > kNoticeable * result.slopeRms)
        warn(fmt::format("{}: the mean slope ({:.3g}, {:.3g}) cannot repeat, and is ignored; --wrap clamp keeps it",
                         args.source, result.meanSlope.x, result.meanSlope.y));
}

void report(const HeightMapArgs& args, const IntegratedHeights& result, const StoredHeights& stored,
            const NormalMap& normals, const MapSize& size) {
    const HeightMap& heights = result.heights;
    const double percent = 100 * result.residualShare();
    if (args.isJson)
        printJson({{"output", args.target},
                   {"width", heights.width},
                   {"height", heights.height},
                   {"size", {size.x, size.y}},
                   {"wrap", wordOf(kWraps, args.wrap)},
                   {"lowest", heights.lowest},
                   {"highest", heights.highest},
                   {"mid", stored.mid},
                   {"scale", stored.scale},
                   {"slope_rms", result.slopeRms},
                   {"mean_slope", {result.meanSlope.x, result.meanSlope.y}},
                   {"not_integrable_percent", percent},
                   {"empty_texels", normals.emptyCount}});
    else if (!args.isQuiet)
        std::cerr << fmt::format("{}: {} x {} heights from {:.4g} to {:.4g} where the unit square is {:g} by {:g}; use "
                                 "--mid {:.6g} --scale {:.6g}\n"
                                 "not integrable: {:.2f} % of the slopes\n",
                                 args.target, heights.width, heights.height, heights.lowest, heights.highest, size.x,
                                 size.y, stored.mid, stored.scale, percent);
}

int makeHeightMapFile(const HeightMapArgs& args) {
    const SampleType sample = chooseSample(args.target, 0);
    checkNormalSpace(args.space, args.source);
    checkOutput(args.target, {args.source});
    // What is said of the map is said once it has heights: an error is one line.
    std::vector<std::string> warnings;
    const Warn collect = [&](const std::string& line) { warnings.push_back(line); };
    const NormalMap normals = loadNormalMap(args.source, {.y = args.y, .wrap = args.wrap, .limits = {}}, collect);
    const MapSize size = args.size.value_or(computeMapSize(normals.width, normals.height));
    const IntegrationOptions options{.size = size, .rounding = computeSlopeRounding(readImageInfo(args.source))};
    const IntegratedHeights result = integrateNormals(normals, options, args.source);
    const Warn warn = makeWarn(args.isQuiet);
    for (const std::string& line : warnings) warn(line);
    warnOfMeanSlope(args, result, warn);
    const StoredHeights stored = toStored(result.heights, sample);
    writeImage(args.target, stored.image, sample);
    report(args, result, stored, normals, size);
    return 0;
}

} // namespace

Run addNormalMap(CLI::App& app) {
    auto args = std::make_shared<NormalMapArgs>();
    app.add_option("height", args->source, "height map: .exr .tif .png .hdr .jpg")->required()->option_text("HEIGHT");
    app.add_option("-o,--output", args->target, "normal map, codes (n + 1) / 2: .png .tif, or .exr with floats")
        ->required()
        ->option_text("NORMAL");
    addHeightValues(app, args->height);
    addMap(app, *args, "which way the second channel points");
    listIn("output", "8|16",
           app.add_option("--bits", args->bits, "bits per channel of .png and .tif (default: 16)")
               ->check(CLI::IsMember({8, 16})));
    app.footer("Slopes are central differences over one texel, those that --height displaces and bumps with.\n"
               "--mid moves all heights alike and changes no normal.\n"
               "example:\n"
               "  relief normal-map bricks.exr -o bricks_normal.png --scale 0.02 --size 2,1");
    return [args] { return makeNormalMapFile(*args); };
}

Run addHeightMap(CLI::App& app) {
    auto args = std::make_shared<HeightMapArgs>();
    app.add_option("normal", args->source, "normal map in tangent space: .png .tif .exr .hdr .jpg")
        ->required()
        ->option_text("NORMAL");
    app.add_option("-o,--output", args->target, "height map: .exr with floats, or .png .tif with 16 bits")
        ->required()
        ->option_text("HEIGHT");
    addMap(app, *args, "which way the second channel of the file points");
    listIn("map", "SPACE",
           addEnum(app, "--normal-space", args->space, kNormalSpaces, "what normals are components along"));
    app.footer(
        "The heights whose slopes come nearest to those of the normals (a Poisson equation). What of the slopes no\n"
        "height has, because they were painted or rounded, is printed as a share of their root mean square.\n"
        "example:\n"
        "  relief height-map bricks_normal.png -o bricks.exr --size 2,1 --normal-y down");
    return [args] { return makeHeightMapFile(*args); };
}

} // namespace relief::app
