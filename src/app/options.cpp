#include "app/options.h"

#include <chrono>

namespace relief::app {
namespace {

double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

Scheme schemeOf(const std::string& word) {
    return word == "loop" ? Scheme::loop : word == "bilinear" ? Scheme::bilinear : Scheme::catmark;
}

} // namespace

Warn Output::warn() const {
    if (isQuiet) return [](const std::string&) {};
    return warnOnStderr;
}

void addOutput(CLI::App& app, Output& output) {
    static const std::map<std::string, ShowProgress> words{
        {"auto", ShowProgress::automatic}, {"always", ShowProgress::always}, {"never", ShowProgress::never}};
    app.add_flag("--json", output.isJson, "print the result as JSON on stdout")->group("output");
    app.add_flag("-q,--quiet", output.isQuiet, "no warnings, no summary")->group("output");
    app.add_flag("-v,--verbose", output.isVerbose, "times of every step")->group("output");
    app.add_option("--progress", output.progress, "auto, always or never")
        ->transform(CLI::CheckedTransformer(words))->option_text("WHEN")->group("output");
}

void addSurface(CLI::App& app, SurfaceArgs& args) {
    app.add_option("cage", args.cage, "control cage or mesh (.obj)")->required()->option_text("CAGE");
    app.add_option("--scheme", args.scheme, "catmark, loop, bilinear, or none: draw the polygons as they are (default: "
                                            "none for a mesh of triangles, else catmark)")
        ->check(CLI::IsMember({"catmark", "loop", "bilinear", "none"}))->option_text("SCHEME")->group("surface");
    app.add_option("--isolation", args.isolation, "levels of refinement around features, 0..10 (6)")
        ->check(CLI::Range(0, 10))->option_text("N")->group("surface");
    app.add_option("--height", args.height, "height map: .exr .tif .png .hdr")->option_text("MAP")->group("height");
    app.add_option("--scale", args.scale, "cage units for one unit of stored height (1)")->option_text("S")->group("height");
    app.add_option("--mid", args.mid, "stored value without displacement (0.5 integer files, 0 float files)")
        ->option_text("M")->group("height");
    app.add_option("--channel", args.channel, "channel of the map, from 0 (0)")
        ->check(CLI::Range(0, 255))->option_text("C")->group("height");
    app.add_option("--wrap", args.wrap, "outside the map: repeat it, or clamp to its border (repeat)")
        ->check(CLI::IsMember({"repeat", "clamp"}))->option_text("WRAP")->group("height");
}

void addPicture(CLI::App& app, PictureArgs& args) {
    const auto positive = CLI::Range(1e-9, 1e9);
    app.add_option("--path", args.path, "how triangles are made: tessellation or grid (tessellation where there is one)")
        ->check(CLI::IsMember({"tessellation", "grid"}))->option_text("PATH")->group("triangles");
    auto* rate = app.add_option("--rate", args.rate, "segments a cage edge, the same everywhere")
                     ->option_text("N")->group("triangles");
    app.add_option("--edge-pixels", args.edgePixels, "segments of this length on screen (2)")
        ->check(positive)->excludes(rate)->option_text("P")->group("triangles");
    app.add_option("--normal", args.normal, "limit, first-order (no curvature term) or full (full)")
        ->check(CLI::IsMember({"limit", "first-order", "full"}))->option_text("KIND")->group("normal");

    app.add_option("--size", args.size, "pixels: width,height (1024,1024)")
        ->delimiter(',')->expected(2)->check(CLI::Range(1, 16384))->option_text("W,H")->group("camera");
    app.add_option("--azimuth", args.camera.azimuth, "degrees around Y; 0 looks along -Z (30)")->option_text("A")->group("camera");
    app.add_option("--elevation", args.camera.elevation, "degrees above the horizon, -90..90 (20)")
        ->check(CLI::Range(-90.0, 90.0))->option_text("E")->group("camera");
    app.add_option("--distance", args.distance, "cage units from the point looked at (frames the object)")
        ->check(positive)->option_text("D")->group("camera");
    app.add_option("--look-at", args.lookAt, "point in cage units (the object's centre)")
        ->delimiter(',')->expected(3)->option_text("X,Y,Z")->group("camera");
    app.add_option("--fov", args.camera.fieldOfView, "vertical field of view in degrees, 1..150 (30)")
        ->check(CLI::Range(1.0, 150.0))->option_text("F")->group("camera");

    app.add_option("--albedo", args.albedo, "color map (sRGB)")->option_text("MAP")->group("shading");
    app.add_option("--color", args.color, "linear albedo, times the map (0.52,0.50,0.47; 1,1,1 with a map)")
        ->delimiter(',')->expected(3)->check(CLI::Range(0.0, 1.0))->option_text("R,G,B")->group("shading");
    app.add_option("--roughness", args.roughness, "of the surface, 0.05..1 (0.4)")
        ->check(CLI::Range(0.05, 1.0))->option_text("R")->group("shading");
    app.add_option("--environment", args.environment, "equirectangular light: .hdr .exr (a neutral studio)")
        ->option_text("HDR")->group("shading");
    app.add_option("--light", args.light, "key light: azimuth,elevation in degrees (camera - 55, 50)")
        ->delimiter(',')->expected(2)->option_text("AZ,EL")->group("shading");
    app.add_flag("--no-shadows", args.hasNoShadows, "the key light passes through")->group("shading");
    app.add_option("--show", args.show, "shaded, normal, height, rate, faces or wireframe (shaded)")
        ->check(CLI::IsMember({"shaded", "normal", "height", "rate", "faces", "wireframe"}))->option_text("WHAT")->group("shading");
    auto* background = app.add_option("--background", args.background, "sRGB color of a .png's background (a grey studio)")
                           ->delimiter(',')->expected(3)->check(CLI::Range(0.0, 1.0))->option_text("R,G,B")->group("shading");
    app.add_flag("--transparent", args.isTransparent, "no background in a .png")->excludes(background)->group("shading");
    app.add_option("--device", args.device, "part of the name of the Vulkan device to use")->option_text("NAME")->group("device");
}

NormalKind normalKind(const std::string& word) {
    return word == "limit" ? NormalKind::limit : word == "first-order" ? NormalKind::firstOrder : NormalKind::full;
}

Loaded load(const SurfaceArgs& args, const Output& output) {
    Loaded loaded;
    const double start = secondsNow();
    loaded.cage = readCage(args.cage, output.warn());
    const bool isDense = args.scheme == "none" || (args.scheme.empty() && loaded.cage.isAllTriangles());
    if (isDense && !args.height.empty())
        fail(Failure::usage, "{}: heights displace a subdivision surface, and this is drawn as plain polygons; name --scheme "
                             "catmark, loop or bilinear", args.cage);
    if (!args.height.empty()) {
        const HeightOptions options{.mid = args.mid, .scale = args.scale, .channel = args.channel,
                                    .wrap = args.wrap == "clamp" ? Wrap::clamp : Wrap::repeat, .limits = {}};
        loaded.height = loadHeightMap(args.height, options, output.warn());
        if (!loaded.cage.hasTexCoords())
            output.warn()(fmt::format("{}: no texture coordinates: every face takes the whole map", args.cage));
    }
    const double loadEnd = secondsNow();
    if (isDense) {
        loaded.dense = denseMesh(loaded.cage);
    } else {
        loaded.options = {.scheme = schemeOf(args.scheme), .isolation = args.isolation};
        loaded.surface = buildSurface(loaded.cage, loaded.options);
    }
    loaded.loadSeconds = loadEnd - start;
    loaded.surfaceSeconds = secondsNow() - loadEnd;
    return loaded;
}

} // namespace relief::app
