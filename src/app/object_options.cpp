#include "app/object_options.h"

#include "app/layer_options.h"
#include "app/options.h"
#include "app/units.h"

namespace relief::app {
namespace {

constexpr const char* kVectorGroup = "vector displacement";

/// The options of the channels of vector maps, which need the option that says that there are vectors.
void addVectorAxes(CLI::App& app, HeightDesc& height, CLI::Option* needed);

CLI::Validator notNegative() {
    const auto check = [](const std::string& word) {
        return word.starts_with('-') ? fmt::format("{} is no channel; they count from 0", word) : std::string();
    };
    return {check, ""};
}

void addWeld(CLI::App& app, std::optional<Distance>& weld) {
    const auto set = [&weld](const std::string& word) { weld = parseDistance(word); };
    CLI::Option* option = app.add_option_function<std::string>(
        "--weld", set,
        "join boundary vertices that are at the same position, or at most this far apart: cage units, or a percentage "
        "of the diagonal of the cage's bounding box such as 0.01% (0 where the distance is omitted)");
    listIn("surface", "[DISTANCE]", option->check(distanceFromZero()));
}

void addHeights(CLI::App& app, HeightDesc& height) {
    const char* group = "height";
    listIn(group, "MAP",
           app.add_option(
               "--height", height.path,
               "height map: .exr .tif .png .hdr .jpg; a name with <UDIM>, %(UDIM)d, <uvtile> or <UVTILE> is a set of "
               "tiles, and what relief map writes a map per face"));
    addHeightValues(app, height);
    listIn(group, "WRAP",
           addEnum(app, "--wrap", height.wrap, kWraps,
                   "what lies outside of the map (default: repeat, with a warning where that shows)"));
    listIn(group, "FORMAT",
           addEnum(app, "--map-format", height.format, kMapFormatChoices, "how the map is stored on the device"));
}

/// An option whose value is one of the words of a table.
template <typename Table, typename Take>
CLI::Option* addWords(CLI::App& app, const char* name, const Table& table, const char* help, const Take& take) {
    const std::vector<WordHelp> words = listWords(table);
    const auto set = [take, &table](const std::string& word) {
        for (const auto& row : table)
            if (row.word == word) take(row.value);
    };
    return app.add_option_function<std::string>(name, set, describeWords(help, words))->check(oneOf(words));
}

/// A vector map in place of a height map. Options are read in this order: the map, the space, the program's order and
/// flips, then those that are named. They may be read without the map, before that is reported.
void addVectors(CLI::App& app, HeightDesc& height) {
    const auto setPath = [&height](const std::string& path) {
        height.path = path;
        height.vectors.emplace();
    };
    CLI::Option* map = app.add_option_function<std::string>(
        "--vector", setPath,
        "vector displacement map of three channels instead of a height map: .exr .tif .png .hdr .jpg; --scale, --mid, "
        "--channel (the first of the three), --wrap and --map-format are read as for heights");
    listIn(kVectorGroup, "MAP", map->excludes(app.get_option("--height")));
    CLI::Option* space = addWords(app, "--vector-space", kVectorSpaces,
                                  "what the components are along (default: tangent)", [&height](VectorSpace word) {
                                      if (height.vectors) height.vectors->space = word;
                                  });
    listIn(kVectorGroup, "SPACE", space->needs(map));
    addVectorAxes(app, height, map);
}

void addVectorAxes(CLI::App& app, HeightDesc& height, CLI::Option* needed) {
    const auto add = [&](CLI::Option* option, const char* value) {
        listIn(kVectorGroup, value, option->needs(needed));
    };
    add(addWords(app, "--vector-preset", kVectorPresets, "order and signs of a program (default: none)",
                 [&height](VectorPreset preset) {
                     if (height.vectors) applyPreset(*height.vectors, preset);
                 }),
        "PROGRAM");
    add(app.add_option_function<std::string>(
            "--vector-order",
            [&height](const std::string& order) {
                if (height.vectors) height.vectors->order = order;
            },
            "the component that red, green and blue hold (default: xyz)"),
        "AXES");
    add(app.add_option_function<std::string>(
            "--vector-flip",
            [&height](const std::string& flip) {
                if (height.vectors) height.vectors->flip = flip;
            },
            "components whose sign is turned, such as y or xz (default: none)"),
        "AXES");
}

std::string listNames(const std::vector<std::string>& names) {
    std::string list;
    for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
    return list;
}

void addMotion(CLI::App& app, MotionDesc& motion) {
    const char* group = "pose";
    // Where positions come from: a cache or a skin, and deformers after either.
    CLI::Option* cache =
        app.add_option("--cache", motion.cachePath,
                       "point cache with positions of the cage: .pc2 or .mdd, or a sequence 'name.{frame:4}.obj'");
    listIn(group, "FILE", cache);
    CLI::Option* skin = app.add_option("--skin", motion.skinPath,
                                       "glTF file (.gltf .glb) whose skin, morph targets and nodes move the cage");
    listIn(group, "FILE", skin->excludes(cache));
    listIn(group, "NAME",
           app.add_option("--clip", motion.skin.clip,
                          "animation of the glTF file, by its name or its number from 0 (default: the first)")
               ->needs(skin));
    app.add_flag("--bind-nearest", motion.skin.bindsNearest,
                 "bind cage points to the nearest vertex of the skin, however far it is")
        ->needs(skin)
        ->group(group);
    listIn(group, "EXPRESSION",
           app.add_option("--deform", motion.deformers,
                          "deformers over the time t in seconds, such as \"twist(axis=y, angle=90*sin(t))\"; relief "
                          "animate --help lists them"));
    // How times are read.
    listIn(group, "HOW",
           addEnum(app, "--interpolation", motion.cache.interpolation, kInterpolations,
                   "positions between the keys of a cache"));
    app.add_flag("--cache-frames", motion.cache.countsFrames,
                 "key k of a .pc2 or .mdd, from 0, is frame k; the times in the file are ignored")
        ->needs(cache)
        ->group(group);
    listIn(group, "FPS",
           app.add_option("--fps", motion.cache.fps, fmt::format("frames per second (default: {})", motion.cache.fps))
               ->check(numberIn(1e-3, 1e4)));
}

} // namespace

void addObject(CLI::App& app, ObjectDesc& object) {
    app.add_option("cage", object.cage, "control cage, or mesh of triangles: .obj .gltf .glb; or geometry image: .exr")
        ->required()
        ->option_text("CAGE");
    listIn("surface", "K",
           app.add_option("--mip", object.mip,
                          "of a geometry image: every 2^K-th sample (default: 0; render: as many samples as there are "
                          "pixels)")
               ->check(CLI::Range(0, 12)));
    addHeightedSurface(app, object);
    addMotion(app, object.motion);
}

void addHeightedSurface(CLI::App& app, ObjectDesc& object) {
    addSurfaceOptions(app, object);
    addVectors(app, object.height);
    addHeightFunction(app, object.height);
    addLayers(app, object.height);
    for (const char* ofMaps : {"--vector", "--layer"})
        app.get_option("--height-function")->excludes(app.get_option(ofMaps));
    addPlacement(app, object);
}

void addSurface(CLI::App& app, ObjectDesc& object) {
    listIn("surface", "SCHEME",
           addEnum(app, "--scheme", object.subdivision, kSubdivisions,
                   "how the cage is subdivided (default: none where all faces are triangles, else catmark)"));
    listIn("surface", "N",
           app.add_option("--isolation", object.isolation,
                          "levels of refinement around extraordinary vertices and creases, 0..10 (default: 2, and as "
                          "many around semi-sharp creases as they need; 6 with --end-caps gregory)")
               ->check(CLI::Range(0, 10)));
    listIn("surface", "KIND",
           addEnum(app, "--end-caps", object.endCaps, kEndCaps, "what faces at extraordinary vertices are made of"));
    addWeld(app, object.weld);
}

void addVectorKind(CLI::App& app, HeightDesc& height) {
    CLI::Option* space = addWords(app, "--vector-space", kVectorSpaces,
                                  "the maps are vector maps, whose components are along this (default: height maps)",
                                  [&height](VectorSpace word) { height.vectors.emplace().space = word; });
    listIn(kVectorGroup, "SPACE", space);
    addVectorAxes(app, height, space);
}

void addSurfaceOptions(CLI::App& app, ObjectDesc& object) {
    addSurface(app, object);
    addHeights(app, object.height);
}

void addHeightFunction(CLI::App& app, HeightDesc& height) {
    CLI::Option* function =
        app.add_option("--height-function", height.function,
                       "heights by a function instead of a map: a file with float height(vec3 p, vec2 st, float t) in "
                       "GLSL, or one of " +
                           listNames(listHeightFunctions()) +
                           "; p is the point of the smooth surface at rest in cage units, st its texture coordinates, "
                           "t the time in seconds");
    for (const char* ofMaps : {"--height", "--channel", "--wrap", "--map-format"})
        function->excludes(app.get_option(ofMaps));
    listIn("height", "FILE", function);
    listIn("height", "X",
           app.add_option("--height-bound", height.functionBound,
                          "largest absolute value that the function returns (default: its const float kBound, else it "
                          "is measured)")
               ->check(numberIn(0, 1e12))
               ->needs(function));
}

void addHeightValues(CLI::App& app, HeightDesc& height) {
    const char* group = "height";
    listIn(group, "S",
           app.add_option("--scale", height.scale, "cage units per unit of stored height (default: 1)")
               ->check(anyCoordinate()));
    listIn(group, "M",
           app.add_option("--mid", height.mid,
                          "stored height that displaces nothing (default: 0.5 for unsigned integers, which are read "
                          "as 0..1, else 0)")
               ->check(anyNumber()));
    listIn(group, "C",
           app.add_option("--channel", height.channel,
                          "channel or layer of the map, by its name or by its number from 0 (default: 0)")
               ->check(notNegative()));
}

void addTime(CLI::App& app, MotionDesc& motion) {
    listIn("pose", "T",
           app.add_option("--time", motion.time,
                          "time in seconds of the pose by --cache, --skin or --deform, and of a height function "
                          "(default: 0)")
               ->check(anyNumber()));
}

void addHeightSpace(CLI::App& app, HeightSpace& space) {
    listIn("height", "SPACE", addEnum(app, "--height-space", space, kHeightSpaces, "heights on a cage that moves"));
}

} // namespace relief::app
