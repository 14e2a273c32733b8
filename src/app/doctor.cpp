#include <iostream>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/object_options.h"
#include "app/options.h"
#include "app/output.h"
#include "doctor/doctor.h"

namespace relief::app {
namespace {

using nlohmann::json;

struct DoctorArgs {
    ObjectDesc object; ///< its height path is empty: maps are named by position
    std::vector<std::string> maps;
    std::string picture;
    int side = 1024;
    bool isJson = false, isQuiet = false;
};

json toJson(const Finding& finding) {
    json result{{"kind", wordOf(kFindingKinds, finding.kind)},
                {"severity", finding.isFault ? "fault" : "note"},
                {"figure", finding.figure},
                {"text", finding.text},
                {"advice", finding.advice}};
    if (finding.at) result["at"] = {{"face", finding.at->face}, {"u", finding.at->uv.x}, {"v", finding.at->uv.y}};
    return result;
}

json toJson(const Examination& examination, double unit) {
    json settings = json::object(), findings = json::array();
    for (const RendererSetting& setting : listRendererSettings(examination, unit))
        settings[setting.renderer][setting.name] = setting.value;
    for (const Finding& finding : examination.findings) findings.push_back(toJson(finding));
    return {{"map", examination.path},
            {"tiles", examination.map.addressing == Addressing::tiles ? examination.map.tiles.size() : 0},
            {"faces", examination.map.addressing == Addressing::faces ? examination.map.tiles.size() : 0},
            {"width", examination.map.width},
            {"height", examination.map.height},
            {"mid", examination.map.mid},
            {"scale", examination.map.scale * unit},
            {"displacement_bound", examination.bound},
            {"findings", findings},
            {"settings", settings}};
}

void print(const Examination& examination, double unit) {
    std::cout << onOneLine(examination.path) << '\n';
    if (examination.findings.empty()) std::cout << "  nothing is wrong\n";
    for (const Finding& finding : examination.findings)
        std::cout << fmt::format("  {:5} {:10} {}\n{:19}{}\n", finding.isFault ? "fault" : "note",
                                 wordOf(kFindingKinds, finding.kind), onOneLine(finding.text), "", finding.advice);
    std::cout << "  the same look elsewhere\n";
    for (const RendererSetting& setting : listRendererSettings(examination, unit))
        std::cout << fmt::format("    {:10} {:36} {}\n", setting.renderer, setting.name, setting.value);
}

void checkUsage(const DoctorArgs& args) {
    if (args.picture.empty()) return;
    if (args.maps.size() > 1)
        fail(Failure::usage, "-o {}: a picture is of one map, and {} are named", args.picture, args.maps.size());
    const std::string extension = lowerExtension(args.picture);
    if (extension != ".png") fail(Failure::usage, "{}: findings are drawn into a .png", args.picture);
    std::vector<std::string> inputs{args.object.cage};
    for (const std::string& map : args.maps) {
        inputs.push_back(map);
        if (!findTilePattern(map)) continue;
        for (const TileFile& tile : listTiles(map)) inputs.push_back(tile.path);
    }
    checkOutput(args.picture, inputs);
}

/// The surface that the maps are for.
LoadedObject loadSubject(const DoctorArgs& args) {
    ObjectDesc bare = args.object; // without a map: the cage alone
    bare.height.vectors.reset();
    LoadedObject object = load(bare, CageState::posed, makeWarn(args.isQuiet));
    if (object.dense)
        fail(Failure::usage,
             "{}: heights displace a subdivision surface, and this is drawn as plain polygons; name --scheme catmark, "
             "loop or bilinear",
             args.object.cage);
    if (!args.picture.empty() && !object.surface.hasTexCoords())
        fail(Failure::usage, "{}: there are no texture coordinates whose layout -o could draw", args.object.cage);
    return object;
}

int examine(const DoctorArgs& args) {
    checkUsage(args);
    for (const std::string& map : args.maps) // before anything takes long
        readImageInfo(findTilePattern(map) ? listTiles(map).front().path : map);
    const LoadedObject object = loadSubject(args);
    const ReferenceSurface reference(object.cage, object.options);
    const SurfaceLayout layout = makeLayout(object.surface, reference);
    const double unit = object.coordinates().unit;
    const DoctorSubject subject{&object.surface, &reference, &layout, unit, hashTopology(object.cage)};

    // All maps are examined before anything is printed: a map that cannot be read is one line.
    const HeightDesc& height = args.object.height;
    DoctorOptions options{.height = {.mid = height.mid, .scale = height.scale, .channel = height.channel, .limits = {}},
                          .vectors = height.vectors,
                          .namesWrap = height.wrap.has_value()};
    options.height.wrap = height.wrap.value_or(options.height.wrap);
    std::vector<Examination> examinations;
    for (const std::string& map : args.maps) examinations.push_back(examineMap(map, options, subject));
    if (!args.picture.empty())
        writeImage(args.picture, drawFindings(examinations.front(), subject, args.side), SampleType::uint8);

    // What was found, and on stderr which maps have faults.
    json all = json::array();
    std::size_t faults = 0;
    for (const Examination& examination : examinations) {
        if (args.isJson)
            all.push_back(toJson(examination, unit));
        else if (!args.isQuiet)
            print(examination, unit);
        for (const Finding& finding : examination.findings) faults += finding.isFault ? 1 : 0;
    }
    if (args.isJson) printJson(all);
    std::cout.flush();
    const auto isIll = [](const Examination& examination) { return !examination.isHealthy(); };
    if (faults > 0)
        fail(Failure::check, "{}: {} {} in {} of {} {}", args.object.cage, faults, faults == 1 ? "fault" : "faults",
             std::ranges::count_if(examinations, isIll), examinations.size(),
             examinations.size() == 1 ? "map" : "maps");
    return 0;
}

std::string describeKinds() {
    std::string lines;
    for (const Word<FindingKind>& row : kFindingKinds) lines += fmt::format("\n  {:10} {}", row.word, row.help);
    return lines;
}

} // namespace

Run addDoctor(CLI::App& app) {
    auto args = std::make_shared<DoctorArgs>();
    app.add_option("cage", args->object.cage, "control cage: .obj .gltf .glb")->required()->option_text("CAGE");
    app.add_option("maps", args->maps,
                   "height maps, or with --vector-space vector maps: .exr .tif .png .hdr .jpg; sets of tiles (<UDIM>), "
                   "maps per "
                   "face")
        ->required()
        ->option_text("MAP...");
    addSurface(app, args->object);
    addHeightValues(app, args->object.height);
    addVectorKind(app, args->object.height);
    listIn("height", "WRAP",
           addEnum(app, "--wrap", args->object.height.wrap, kWraps,
                   "what lies outside of the map (default: repeat, and coordinates there are a finding)"));
    app.add_option("-o,--output", args->picture, "picture of the findings over the layout of texture coordinates: .png")
        ->option_text("PICTURE")
        ->group("output");
    listIn("output", "PIXELS",
           app.add_option("--side", args->side, fmt::format("its width (default: {})", args->side))
               ->check(CLI::Range(64, 8192)));
    app.add_flag("--json", args->isJson, "print findings and settings as JSON on stdout")->group("output");
    app.add_flag("-q,--quiet", args->isQuiet, "print no findings and no warnings: the exit code says it")
        ->group("output");
    app.footer("What is found, with its figure and what to do:" + describeKinds() +
               "\n\nThe settings of Blender, Arnold and RenderMan are those that displace the same cage to the same\n"
               "surface: midlevel, scale, space, and the displacement bound.\n"
               "Ends with exit code 6 when there is a fault; notes change no code.\n"
               "examples:\n"
               "  relief doctor cage.obj heights.exr --scale 0.2\n"
               "  relief doctor cage.obj heights.tif --scale 0.2 --mid 0.5 -o findings.png\n"
               "  relief doctor cage.obj 'skin.<UDIM>.exr' --scale 0.2 -o findings.png\n"
               "  relief doctor cage.obj vectors.exr --vector-space tangent --vector-preset mudbox");
    return [args] { return examine(*args); };
}

} // namespace relief::app
