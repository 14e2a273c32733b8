#include "app/bake_options.h"

#include <bit>
#include <cmath>

#include "app/heatmap.h"
#include "app/object_options.h"
#include "app/options.h"
#include "app/picture_options.h"
#include "app/units.h"

namespace relief::app {
namespace {

constexpr Word<SampleType> kHeightFormats[] = {
    {"float", SampleType::real, "32-bit floats: .exr .tif"},
    {"half", SampleType::half, "16-bit floats: .exr"},
    {"unorm16", SampleType::uint16,
     "16-bit integers over the range of the heights, or by --mid and --scale: .png .tif"},
};

/// "5%", or "0.1,0.2" for both directions.
void parseReach(const std::string& words, BakeArgs& args) {
    const std::size_t comma = words.find(',');
    const std::optional<Distance> front = parseDistance(words.substr(0, comma));
    const std::optional<Distance> back = comma == std::string::npos ? front : parseDistance(words.substr(comma + 1));
    for (const std::optional<Distance>& distance : {front, back})
        if (!distance || !(distance->value >= 0) || !std::isfinite(distance->value))
            throw CLI::ValidationError("--max-distance", words + " is no distance, or two with a comma between them");
    args.front = *front, args.back = *back, args.hasReach = true;
}

void checkLayer(const LayerFile& file, const std::vector<std::string>& inputs) {
    const std::string extension = lowerExtension(file.path);
    const bool isFloat = extension == ".exr" || extension == ".tif" || extension == ".tiff";
    if (!isFloat && (extension != ".png" || hasUnit(file.layer)))
        fail(Failure::usage, "{}: {}", file.path,
             hasUnit(file.layer) ? "positions, vectors and curvatures are written as .exr or .tif"
                                 : "normals and occlusion are written as .png, .tif or .exr");
    checkOutput(file.path, inputs);
}

/// The lines and the texels.
void addLines(CLI::App& app, BakeArgs& args) {
    const char* group = "baking";
    listIn(group, "W,H",
           addVector<ivec2>(app, "--size", args.size, "texels of the map (default: 1024,1024)")
               ->check(CLI::Range(1, 32768)));
    listIn(group, "N",
           app.add_option("--samples", args.sampleCount, "lines per texel, rounded up to a square number (default: 4)")
               ->check(CLI::Range(1, 256)));
    listIn(group, "D[,D]",
           app.add_option_function<std::string>(
               "--max-distance", [&args](const std::string& words) { parseReach(words, args); },
               "how far lines reach along the normals and against them: cage units, or a percentage of the sculpt's "
               "diagonal (default: 5%)"));
    listIn(group, "FILE",
           app.add_option("--cage", args.lineCage,
                          "the cage with its vertices moved outwards: lines begin as high as its surface is and look "
                          "inwards, and the first hit is the height: .obj .gltf .glb"));
    app.add_flag(
           "--smooth-cage", args.smoothCage,
           "as --cage with the cage itself, its vertices moved along normals that are smooth across sharp edges, "
           "as far as --max-distance (default: half as far again as the sculpt is found to lie above the surface)")
        ->group(group);
    app.add_flag("--drop-behind", args.dropsBehind,
                 "a hit behind the back of another sheet is none: its texel is a void")
        ->group(group);
    listIn(group, "N",
           app.add_option("--dilate", args.margin,
                          "texels beyond the borders of islands that show the surface across the seam (default: 2)")
               ->check(numberIn(0, 64)));
    listIn(group, "FORMAT",
           addEnum(app, "--format", args.sample, kHeightFormats,
                   "how heights are written (default: float, unorm16 in .png)"));
    listIn(group, "PICTURE",
           app.add_option("--voids", args.voids,
                          "picture to write of the texels whose lines miss: .png .tif .exr; with --per-face a map per "
                          "face, .exr"));
}

/// Maps per face and their size.
void addPerFace(CLI::App& app, BakeArgs& args) {
    const char* group = "maps per face";
    app.add_flag(
           "--per-face", args.perFace,
           "a map per face of the cage, which needs no texture coordinates, of about as many heights as --size has "
           "texels")
        ->group(group);
    listIn(group, "N",
           app.add_option("--face-size", args.faceSize, "segments along each side of each face, a power of two")
               ->check(CLI::Range(1, 4096)));
    listIn(group, "D",
           app.add_option_function<std::string>(
                  "--texel-size", [&args](const std::string& word) { args.texelSize = *parseDistance(word); },
                  "length of a segment, of which each side has a power of two: cage units, or a percentage of the "
                  "sculpt's diagonal")
               ->check(distanceFromZero()));
}

/// Throws for what goes with another kind of map.
void checkKind(const BakeArgs& args) {
    if (!args.perFace) {
        if (args.faceSize || args.texelSize)
            fail(Failure::usage, "{} is for maps with --per-face", args.faceSize ? "--face-size" : "--texel-size");
        // Over texture coordinates: one map, or a set of tiles, and then all files are sets.
        const bool isSet = findTilePattern(args.target).has_value();
        if (isSet && args.object.height.wrap)
            fail(Failure::usage, "{}: a set of tiles does not repeat; omit --wrap", args.target);
        std::vector<std::string> others;
        for (const LayerFile& file : listLayers(args)) others.push_back(file.path);
        if (!args.voids.empty()) others.push_back(args.voids);
        for (const std::string& path : others)
            if (findTilePattern(path).has_value() != isSet)
                fail(Failure::usage, "{} and {}: all maps are sets of tiles, or none is", args.target, path);
        return;
    }
    // Per face: the size comes from the face, and what is written are numbers of one kind, in cage units.
    if (args.checksOnly) fail(Failure::usage, "--check reads from the map's header whether it is one per face");
    if (args.faceSize && args.texelSize) fail(Failure::usage, "--face-size and --texel-size: give one of them");
    if (args.faceSize && !std::has_single_bit(unsigned(*args.faceSize)))
        fail(Failure::usage, "--face-size {}: a face has 1, 2, 4, ... 4096 segments per side", *args.faceSize);
    if (args.texelSize && !(args.texelSize->value > 0)) fail(Failure::usage, "--texel-size 0 has no length");
    if (!listLayers(args).empty())
        fail(Failure::usage,
             "{}: --per-face makes heights and --voids alone; normals and other maps lie over texture coordinates",
             listLayers(args).front().path);
    for (const std::string& path : {args.target, args.voids})
        if (!path.empty() && (lowerExtension(path) != ".exr" || findTilePattern(path)))
            fail(Failure::usage, "{}: a map per face is one .exr of floats or halves", path);
    if (args.object.height.mid || args.object.height.scale || args.object.height.wrap)
        fail(Failure::usage, "--per-face has heights in cage units that do not repeat; omit --mid, --scale and --wrap");
}

/// Other maps of the same lines.
void addOtherMaps(CLI::App& app, BakeArgs& args) {
    const char* others = "other maps";
    listIn(others, "PICTURE", app.add_option("--normal", args.normals, "normals of the sculpt: .png .tif .exr"));
    listIn(others, "SPACE",
           addEnum(app, "--normal-space", args.normalSpace, kNormalSpaces, "what normals are components along"));
    listIn(others, "Y",
           addEnum(app, "--normal-y", args.normalY, kNormalYs, "which way the second channel of --normal points"));
    listIn(others, "PICTURE",
           app.add_option("--occlusion", args.occlusion,
                          "share of the sky that the sculpt sees, white where it is open: .png .tif .exr"));
    listIn(others, "N",
           app.add_option("--occlusion-lines", args.occlusionLines, "lines per texel for --occlusion (default: 64)")
               ->check(CLI::Range(1, 65536)));
    listIn(others, "PICTURE",
           app.add_option("--curvature", args.curvature,
                          "mean curvature of the sculpt, 1 / cage unit, above 0 on ridges: .exr .tif"));
    listIn(others, "PICTURE", app.add_option("--position", args.position, "points of the sculpt: .exr .tif"));
    listIn(others, "PICTURE",
           app.add_option("--vector", args.vector,
                          "displacement along x, y and z, from the limit surface to the sculpt: .exr .tif"));
}

/// What is measured afterwards.
void addCertificate(CLI::App& app, BakeArgs& args) {
    app.add_flag("--check", args.checksOnly, "certify the map of --height instead of baking one")->group("certificate");
    listIn("certificate", "D",
           app.add_option_function<std::string>(
                  "--tolerance", [&args](const std::string& word) { args.tolerance = *parseDistance(word); },
                  "largest RMS distance in either direction: cage units, or a percentage of the sculpt's diagonal "
                  "(default: 0.1%)")
               ->check(distanceFromZero()));
    listIn("certificate", "PICTURE",
           app.add_option("--heatmap", args.heatmap,
                          "picture to write of where the surface is off (orange, from a tenth of the tolerance to all "
                          "of it) and where lines miss (blue): .png or .exr"));
}

} // namespace

int BakeArgs::samplesPerSide() const { return int(std::ceil(std::sqrt(double(sampleCount)) - 1e-9)); }

std::vector<LayerFile> listLayers(const BakeArgs& args) {
    const SculptLayer normal =
        args.normalSpace == NormalSpace::tangent ? SculptLayer::tangentNormal : SculptLayer::objectNormal;
    std::vector<LayerFile> files;
    for (const LayerFile& file :
         {LayerFile{args.normals, normal}, LayerFile{args.position, SculptLayer::position},
          LayerFile{args.vector, SculptLayer::vector}, LayerFile{args.occlusion, SculptLayer::occlusion},
          LayerFile{args.curvature, SculptLayer::curvature}})
        if (!file.path.empty()) files.push_back(file);
    return files;
}

bool hasUnit(SculptLayer layer) {
    return layer == SculptLayer::position || layer == SculptLayer::vector || layer == SculptLayer::curvature;
}

SampleType chooseHeightSample(const BakeArgs& args) {
    const std::string extension = lowerExtension(args.target);
    const bool isFloat = extension == ".exr";
    if (extension != ".exr" && extension != ".png" && extension != ".tif" && extension != ".tiff")
        fail(Failure::usage, "{}: heights are written as .exr, .tif or .png", args.target);
    const SampleType sample = args.sample.value_or(extension == ".png" ? SampleType::uint16 : SampleType::real);
    const bool fits = isFloat               ? sample != SampleType::uint16
                      : extension == ".png" ? sample == SampleType::uint16
                                            : sample != SampleType::half;
    if (!fits)
        fail(Failure::usage, "{}: {} holds no {} heights", args.target, extension, wordOf(kHeightFormats, sample));
    return sample;
}

void checkBakeArgs(const BakeArgs& args) {
    const std::vector<std::string> inputs{args.object.cage, args.sculpt, args.object.height.path, args.lineCage};
    if (args.checksOnly) {
        if (args.object.height.path.empty()) fail(Failure::usage, "--check needs the map: name it with --height");
        if (!args.target.empty() || !args.voids.empty() || !listLayers(args).empty())
            fail(Failure::usage, "--check writes no map; -o, --voids and other maps are for baking");
    } else {
        if (args.target.empty())
            fail(Failure::usage, "name the map to write with -o, or the map to check with --check --height");
        if (!args.object.height.path.empty())
            fail(Failure::usage, "--height is for --check; the map to write is named with -o");
        chooseHeightSample(args);
        checkOutput(args.target, inputs);
    }
    checkKind(args);
    if (args.smoothCage && !args.lineCage.empty())
        fail(Failure::usage, "--cage and --smooth-cage: lines begin on one of them");
    if (!args.voids.empty()) checkOutput(args.voids, inputs);
    for (const LayerFile& file : listLayers(args)) checkLayer(file, inputs);
    if (!args.heatmap.empty()) {
        checkHeatmapPath(args.heatmap);
        checkOutput(args.heatmap, inputs);
    }
}

void addBakeOptions(CLI::App& app, BakeArgs& args) {
    // What is baked from what.
    app.add_option("cage", args.object.cage, "control cage: .obj .gltf .glb")->required()->option_text("CAGE");
    app.add_option("sculpt", args.sculpt, "dense surface: .ply .stl .obj .gltf .glb")
        ->required()
        ->option_text("SCULPT");
    app.add_option("-o,--output", args.target,
                   "height map to write: .exr .tif .png; with <UDIM> in its name a set of tiles, those that "
                   "faces lie in")
        ->option_text("HEIGHT");
    addSurfaceOptions(app, args.object);

    addPerFace(app, args);
    addLines(app, args);
    addOtherMaps(app, args);
    addCertificate(app, args);
    addDevice(app, args.device);
    addOutput(app, args.output);
    app.footer(
        "Lines along the normals of the limit surface look for the sculpt on both sides; the nearest hit that\n"
        "faces outwards is the height. Voids are filled, and counted. The certificate displaces the surface again\n"
        "and measures it against the sculpt; exit code 6 where it is not within the tolerance, and the map is\n"
        "written in either case.\n"
        "examples:\n"
        "  relief bake cage.obj sculpt.ply -o height.exr --size 2048,2048\n"
        "  relief bake cage.obj sculpt.ply -o faces.exr --per-face\n"
        "  relief bake cage.obj sculpt.ply -o 'height.<UDIM>.exr' --cage inflated.obj\n"
        "  relief bake cage.obj sculpt.ply --check --height height.exr --json");
}

} // namespace relief::app
