#include "app/options.h"

#include <algorithm>
#include <chrono>

#include "app/units.h"
#include "app/weld.h"

namespace relief::app {
namespace {

Scheme schemeOf(const std::string& word) {
    return word == "loop" ? Scheme::loop : word == "bilinear" ? Scheme::bilinear : Scheme::catmark;
}

/// Numbers from `lowest` to `highest`, both of them finite: CLI::Range lets "nan" through.
CLI::Validator numberIn(double lowest, double highest) {
    const auto check = [=](const std::string& word) {
        double value = 0;
        const bool isNumber = CLI::detail::lexical_cast(word, value);
        if (isNumber && value >= lowest && value <= highest) return std::string();
        return fmt::format("{} is not a number in {}..{}", word, lowest, highest);
    };
    return {check, ""};
}

CLI::Validator notNegative() {
    const auto check = [](const std::string& word) {
        return word.starts_with('-') ? fmt::format("{} is no channel; they count from 0", word) : std::string();
    };
    return {check, ""};
}

CLI::Validator anyNumber() { return numberIn(-1e12, 1e12); }
CLI::Validator anyPlace() { return numberIn(-kFarthestCoordinate, kFarthestCoordinate); } // in the units of any cage

/// What --help calls an option's value, and the group where it lists it.
CLI::Option* listed(CLI::Option* option, const char* value, const char* group) {
    return option->option_text(value)->group(group);
}

CLI::Option* addWord(CLI::App& app, const char* name, std::string& word, const std::string& help,
                     const std::vector<std::string>& words) {
    return app.add_option(name, word, help)->check(CLI::IsMember(words));
}

/// Numbers with commas between them: a size, a point, a color.
template <typename T>
CLI::Option* addNumbers(CLI::App& app, const char* name, std::vector<T>& numbers, const char* help, int count) {
    return app.add_option(name, numbers, help)->delimiter(',')->expected(count);
}

void addShading(CLI::App& app, PictureArgs& args) {
    const char* group = "shading";
    listed(app.add_option("--albedo", args.albedo, "color map (sRGB)"), "MAP", group);
    listed(addNumbers(app, "--color", args.color, "linear albedo, times the map (0.52,0.50,0.47; 1,1,1 with a map)", 3)
               ->check(numberIn(0, 1)),
           "R,G,B", group);
    listed(app.add_option("--roughness", args.roughness, "of the surface, 0.05..1 (0.4)")->check(numberIn(0.05, 1)),
           "R", group);
    listed(app.add_option("--environment", args.environment, "equirectangular light: .hdr .exr (a neutral studio)"),
           "HDR", group);
    listed(addNumbers(app, "--light", args.light, "key light: azimuth,elevation in degrees (camera - 55, 50)", 2)
               ->check(anyNumber()),
           "AZ,EL", group);
    app.add_flag("--no-shadows", args.hasNoShadows, "the key light passes through")->group(group);
    listed(addWord(app, "--show", args.show, "shaded, normal, height, rate, faces or wireframe (shaded)",
                   {"shaded", "normal", "height", "rate", "faces", "wireframe"}),
           "WHAT", group);
    listed(app.add_option("--layers", args.layers, "into an .exr: depth,normal,face,uv,height,motion or all")
               ->delimiter(',')
               ->check(CLI::IsMember({"depth", "normal", "face", "uv", "height", "motion", "all"})),
           "LAYERS", group);
    CLI::Option* background =
        addNumbers(app, "--background", args.background, "sRGB color of a .png's background (a grey studio)", 3);
    listed(background->check(numberIn(0, 1)), "R,G,B", group);
    app.add_flag("--transparent", args.isTransparent, "no background in a .png")->excludes(background)->group(group);
}

void addPose(CLI::App& app, PoseArgs& args) {
    const char* group = "pose";
    CLI::Option* cache = app.add_option("--cache", args.cache, "point cache: .pc2 .mdd, or cages 'name.{frame:4}.obj'");
    listed(cache, "FILE", group);
    CLI::Option* skin =
        app.add_option("--skin", args.skin, "skin, morph targets and node animation of a .gltf or .glb");
    listed(skin->excludes(cache), "FILE", group);
    listed(app.add_option("--clip", args.clip, "the glTF's animation by its name or number (the first)")->needs(skin),
           "NAME", group);
    app.add_flag("--bind-nearest", args.bindsNearest, "cage points take the skin of the nearest vertex, however far")
        ->needs(skin)
        ->group(group);
    listed(
        app.add_option("--deform", args.deform,
                       "deformers over t in seconds, such as \"twist(axis=y, angle=90*sin(t))\"; see animate --help"),
        "WORDS", group);
    listed(addWord(app, "--interpolation", args.interpolation, "between the keys of a cache: linear or step (linear)",
                   {"linear", "step"}),
           "HOW", group);
    app.add_flag("--cache-frames", args.countsCacheFrames,
                 "frame k of a .pc2 or .mdd, from 0, is frame k, whatever times it has")
        ->needs(cache)
        ->group(group);
    listed(app.add_option("--fps", args.fps, "frames a second (24)")->check(numberIn(1e-3, 1e4)), "FPS", group);
}

} // namespace

Warn Output::warn() const {
    if (isQuiet) return [](const std::string&) {};
    return [lines = warned](const std::string& line) {
        if (lines->insert(line).second) warnOnStderr(line);
    };
}

void addOutput(CLI::App& app, Output& output) {
    const char* group = "output";
    app.add_flag("--json", output.isJson, "print the result as JSON on stdout")->group(group);
    app.add_flag("-q,--quiet", output.isQuiet, "no warnings, no summary")->group(group);
    app.add_flag("-v,--verbose", output.isVerbose, "times of every step")->group(group);
    addProgress(app, output.progress);
}

void addProgress(CLI::App& app, ShowProgress& progress) {
    static const std::map<std::string, ShowProgress> words{
        {"auto", ShowProgress::automatic}, {"always", ShowProgress::always}, {"never", ShowProgress::never}};
    const auto choose = [&progress](const std::string& word) { progress = words.at(word); };
    listed(app.add_option_function<std::string>("--progress", choose, "auto, always or never")
               ->check(CLI::IsMember({"auto", "always", "never"})),
           "WHEN", "output");
}

void addSurface(CLI::App& app, SurfaceArgs& args) {
    app.add_option("cage", args.cage, "control cage or mesh (.obj .gltf .glb)")->required()->option_text("CAGE");
    addSurfaceOptions(app, args);
    addPose(app, args.pose);
}

void addSurfaceOptions(CLI::App& app, SurfaceArgs& args) {
    listed(addWord(app, "--scheme", args.scheme,
                   "catmark, loop, bilinear, or none: draw the polygons as they are (default: none for a mesh of "
                   "triangles, else catmark)",
                   {"catmark", "loop", "bilinear", "none"}),
           "SCHEME", "surface");
    listed(app.add_option("--isolation", args.isolation, "levels of refinement around features, 0..10 (6)")
               ->check(CLI::Range(0, 10)),
           "N", "surface");
    addWeld(app, args.weld);
    const char* group = "height";
    listed(app.add_option("--height", args.height, "height map: .exr .tif .png .hdr"), "MAP", group);
    listed(app.add_option("--scale", args.scale, "cage units for one unit of stored height (1)")->check(anyPlace()),
           "S", group);
    listed(app.add_option("--mid", args.mid, "stored value without displacement (0; 0.5 in files of unsigned integers)")
               ->check(anyNumber()),
           "M", group);
    listed(app.add_option("--channel", args.channel, "channel or layer of the map by name, or by number from 0 (0)")
               ->check(notNegative()),
           "C", group);
    listed(addWord(app, "--wrap", args.wrap, "outside the map: repeat it, or clamp to its border (repeat)",
                   {"repeat", "clamp"}),
           "WRAP", group);
    listed(
        addWord(app, "--map-format", args.mapFormat,
                "the map on the device: float, half, unorm16, unorm8, bc4, or auto: the smallest that keeps what the "
                "file says (auto)",
                {"auto", "float", "half", "unorm16", "unorm8", "bc4"}),
        "FORMAT", group);
}

void addTime(CLI::App& app, PoseArgs& args) {
    listed(
        app.add_option("--time", args.time, "seconds: the pose of --cache, --skin or --deform (0)")->check(anyNumber()),
        "T", "pose");
}

void addHeightSpace(CLI::App& app, std::string& word) {
    listed(addWord(app, "--height-space", word,
                   "heights of a moved cage: absolute, or stretch with the surface (absolute)",
                   {"absolute", "stretch"}),
           "SPACE", "height");
}

void addPath(CLI::App& app, std::string& word, const std::string& defaultWords) {
    listed(addWord(app, "--path", word,
                   fmt::format("how triangles are made: tessellation, grid or dice ({})", defaultWords),
                   {"tessellation", "grid", "dice"}),
           "PATH", "triangles");
}

void addTriangles(CLI::App& app, TriangleArgs& args) {
    const char* group = "triangles";
    CLI::Option* rate = app.add_option("--rate", args.rate, "segments a cage edge, the same everywhere");
    listed(rate, "N", group);
    listed(app.add_option("--edge-pixels", args.edgePixels, "segments of this length on screen (2)")
               ->check(numberIn(1e-3, 1e6))
               ->excludes(rate),
           "P", group);
    listed(addWord(app, "--spacing", args.spacing,
                   "equal segments, or fractional: no sample jumps while rates change (equal)",
                   {"equal", "fractional"}),
           "SPACING", group);
    const auto setMemory = [&args](const std::string& word) { args.memory = bytesOf(word); };
    listed(
        app.add_option_function<std::string>(
               "--memory", setMemory, "most bytes that a diced mesh may take: 512M, 2G (half of the device's memory)")
            ->check(sizeInBytes()),
        "SIZE", group);
    addNormal(app, args.normal);
}

void addNormal(CLI::App& app, std::string& word) {
    listed(addWord(app, "--normal", word, "limit, first-order (no curvature term) or full (full)",
                   {"limit", "first-order", "full"}),
           "KIND", "normal");
}

void addCamera(CLI::App& app, CameraArgs& args) {
    const char* group = "camera";
    listed(addNumbers(app, "--size", args.size, "pixels: width,height (1024,1024)", 2)->check(CLI::Range(1, 16384)),
           "W,H", group);
    listed(app.add_option("--azimuth", args.options.azimuth, "degrees around Y; 0 looks along -Z (30)")
               ->check(anyNumber()),
           "A", group);
    listed(app.add_option("--elevation", args.options.elevation, "degrees above the horizon, -90..90 (20)")
               ->check(numberIn(-90, 90)),
           "E", group);
    listed(app.add_option("--distance", args.distance, "cage units from the point looked at (frames the object)")
               ->check(numberIn(kSmallestSide, kFarthestCoordinate)),
           "D", group);
    listed(addNumbers(app, "--look-at", args.lookAt, "point in cage units (the object's centre)", 3)->check(anyPlace()),
           "X,Y,Z", group);
    listed(app.add_option("--fov", args.options.fieldOfView, "vertical field of view in degrees, 1..150 (30)")
               ->check(numberIn(1, 150)),
           "F", group);
}

void addDevice(CLI::App& app, std::string& name) {
    listed(app.add_option("--device", name, "part of the name of the Vulkan device to use"), "NAME", "device");
}

void addPicture(CLI::App& app, PictureArgs& args) {
    addPath(app, args.triangles.path, "tessellation where there is one");
    addTriangles(app, args.triangles);
    addCamera(app, args.camera);
    addShading(app, args);
    addHeightSpace(app, args.heightSpace);
    addDevice(app, args.device);
}

NormalKind normalKind(const std::string& word) {
    return word == "limit" ? NormalKind::limit : word == "first-order" ? NormalKind::firstOrder : NormalKind::full;
}

Path pathOf(const std::string& word, const Device& device) {
    if (word.empty()) return device.traits().hasTessellation ? Path::tessellation : Path::grid;
    return word == "grid" ? Path::grid : word == "dice" ? Path::dice : Path::tessellation;
}

TriangleOptions triangleOptions(const TriangleArgs& args, const Device& device) {
    return {.path = pathOf(args.path, device),
            .rate = args.rate,
            .edgePixels = args.edgePixels,
            .spacing = args.spacing == "fractional" ? Spacing::fractional : Spacing::equal,
            .normal = normalKind(args.normal),
            .memory = args.memory};
}

double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

namespace {

/// Errors of the surface name the file it came from.
Surface surfaceOf(const Loaded& loaded, const std::string& path) {
    try {
        return buildSurface(loaded.cage, loaded.options);
    } catch (const Error& error) {
        fail(error.failure, "{}: {}", path, error.what());
    }
}

} // namespace

void checkValidation(const Device& device) {
    const std::size_t count = device.validationMessages().size();
    if (count > 0) fail(Failure::internal, "the Vulkan validation layer has {} complaints", count);
}

HeightSpace heightSpaceOf(const std::string& word) {
    return word == "stretch" ? HeightSpace::stretch : HeightSpace::absolute;
}

std::unique_ptr<Poser> stretchHeights(Device& device, SurfaceModel* model, const Loaded& loaded,
                                      const std::string& heightSpace) {
    if (model == nullptr || heightSpaceOf(heightSpace) == HeightSpace::absolute || loaded.restPositions.empty() ||
        !loaded.height)
        return nullptr;
    auto poser = std::make_unique<Poser>(device, *model,
                                         PoserDesc{.surface = &loaded.surface,
                                                   .heightSpace = HeightSpace::stretch,
                                                   .restPositions = loaded.restPositions});
    poser->pose({.positions = loaded.cage.positions, .joints = {}, .morphWeights = {}});
    return poser;
}

Loaded load(const SurfaceArgs& args, const Output& output, const std::string& albedo) {
    Loaded loaded;
    const double start = secondsNow();
    loaded.cage = readCage(args.cage, output.warn());
    checkTexCoords(loaded.cage, {args.height, albedo}, output.warn());
    const bool isDense = args.scheme == "none" || (args.scheme.empty() && loaded.cage.isAllTriangles());
    if (isDense && !args.height.empty())
        fail(Failure::usage,
             "{}: heights displace a subdivision surface, and this is drawn as plain polygons; name --scheme "
             "catmark, loop or bilinear",
             args.cage);
    if (std::optional<EncodedMap> map = loadHeights(args, loaded.cage, output.warn()))
        loaded.height = std::move(map->decoded), loaded.heightEncoding = std::move(map->encoding);
    if (loaded.height) suitHeights(loaded, output.warn());
    loaded.animation = animationOf(args.pose, loaded.cage, output); // the unit is known now
    weldLoaded(loaded, args.weld);
    if (!isDense && args.weld.empty()) warnOfCoincidence(loaded.cage, args.cage, output.warn());
    takePose(loaded, args.pose, args.cage);
    const double loadEnd = secondsNow();
    if (isDense) {
        loaded.dense = denseMesh(loaded.cage);
    } else {
        loaded.options = {.scheme = schemeOf(args.scheme), .isolation = args.isolation};
        loaded.surface = surfaceOf(loaded, args.cage);
    }
    loaded.loadSeconds = loadEnd - start;
    loaded.surfaceSeconds = secondsNow() - loadEnd;
    return loaded;
}

std::vector<dvec3> outlineOf(const Loaded& loaded) {
    if (loaded.dense) return {loaded.dense->positions.begin(), loaded.dense->positions.end()};
    const ReferenceSurface coarse(loaded.cage, {.scheme = loaded.options.scheme, .isolation = 2});
    return outline(coarse, loaded.heightMap());
}

} // namespace relief::app
