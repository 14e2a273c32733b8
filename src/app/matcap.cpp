// relief matcap and relief shading-table: the pictures that --shading matcap and table look up.
#include <iostream>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/light_options.h"
#include "app/options.h"
#include "app/output.h"
#include "app/picture_options.h"

namespace relief::app {
namespace {

struct BallArgs {
    MaterialDesc material;
    LightingDesc lighting;
    PhongCoefficients phong;
    double azimuth = CameraOptions().azimuth, elevation = CameraOptions().elevation;
    int side = 512;
    std::string target, device;
    bool isJson = false, isQuiet = false;
};

void addFile(CLI::App& app, BallArgs& args) {
    app.add_option("-o,--output", args.target, "picture to write: .exr with linear light, or .png as it is seen")
        ->required()
        ->option_text("PICTURE");
    app.add_flag("--json", args.isJson, "print the result as JSON on stdout")->group("output");
    app.add_flag("-q,--quiet", args.isQuiet, "print no summary")->group("output");
}

void addColor(CLI::App& app, MaterialDesc& material) {
    listIn("shading", "R,G,B",
           addVector<vec3>(app, "--color", material.color, "linear albedo 0..1 (default: as of relief render)")
               ->check(numberIn(0, 1)));
}

/// Writes linear light as .exr, or as sRGB codes, which --matcap reads as such again.
void writeLight(const std::string& path, Image image) {
    if (lowerExtension(path) == ".exr") return writeImage(path, image, SampleType::real);
    if (lowerExtension(path) != ".png") fail(Failure::usage, "{}: pictures are written as .png or .exr", path);
    for (float& x : image.texels)
        x = x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(std::min(x, 1.0f), 1 / 2.4f) - 0.055f;
    writeImage(path, image, SampleType::uint8);
}

void report(const BallArgs& args, const Image& image, const char* what) {
    if (args.isJson)
        printJson({{"output", args.target}, {"width", image.width}, {"height", image.height}});
    else if (!args.isQuiet)
        std::cerr << fmt::format("{}: {} of {} x {} texels\n", args.target, what, image.width, image.height);
}

int drawBall(const BallArgs& args) {
    checkOutput(args.target, listEnvironmentFiles(args.lighting.environment));
    LoadedScene loaded;
    if (!args.lighting.environment.empty())
        loaded.environment =
            makeEnvironment(readEnvironment(args.lighting.environment, args.lighting.shape).picture, true);
    Device device({.name = args.device});
    const std::optional<GpuEnvironment> environment = makeEnvironment(device, loaded);
    const Lighting lighting = makeLighting(args.lighting, args.azimuth, environment ? &*environment : nullptr);
    const Image ball =
        renderMatcap(device, makeMaterial(args.material), lighting, {args.azimuth, args.elevation}, args.side);
    writeLight(args.target, ball);
    report(args, ball, "a ball");
    checkValidation(device);
    return 0;
}

/// The table as a picture: eq. 16.20 for the material's color in white light.
int writeTable(const BallArgs& args) {
    checkOutput(args.target, {});
    const vec3 color = makeMaterial(args.material).albedo;
    const Image table = makeShadingTable(args.phong);
    Image colors = table;
    for (std::size_t i = 0; i < table.texels.size(); i += 3)
        for (std::size_t c = 0; c < 3; ++c)
            colors.texels[i + c] = color[int(c)] * table.texels[i] + table.texels[i + 1];
    writeLight(args.target, colors);
    report(args, colors, "a table, n.l to the right and v.r down,");
    return 0;
}

} // namespace

Run addMatcap(CLI::App& app) {
    auto args = std::make_shared<BallArgs>();
    addFile(app, *args);
    addColor(app, args->material);
    addReflection(app, args->material);
    addLighting(app, args->lighting);
    listIn("camera", "A", app.add_option("--azimuth", args->azimuth, "of the eye, degrees")->check(anyNumber()));
    listIn("camera", "E",
           app.add_option("--elevation", args->elevation, "of the eye, degrees")->check(numberIn(-90, 90)));
    listIn("camera", "N", app.add_option("--side", args->side, "pixels each way")->check(CLI::Range(16, 4096)));
    addDevice(app, args->device);
    app.footer("example:\n  relief matcap -o ball.exr --color 0.8,0.3,0.1 --metallic 1 --roughness 0.3\n"
               "  relief render cage.obj --shading matcap --matcap ball.exr -o p.png");
    return [args] { return drawBall(*args); };
}

Run addShadingTable(CLI::App& app) {
    auto args = std::make_shared<BallArgs>();
    addFile(app, *args);
    addColor(app, args->material);
    addPhong(app, args->phong);
    app.footer("example:\n  relief shading-table -o table.exr --phong 0.2,0.8,0.5,60");
    return [args] { return writeTable(*args); };
}

} // namespace relief::app
