// relief environment: pictures of the light from all directions, from one shape to another.
#include <iostream>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/light_options.h"
#include "app/object_options.h"
#include "app/options.h"
#include "app/output.h"
#include "app/picture_options.h"

namespace relief::app {
namespace {

struct EnvironmentArgs {
    std::string source, target;
    SceneDesc scene; ///< of --from; its environment's shape is that of the source too
    PictureArgs picture;
    std::optional<dvec3> at;
    std::optional<EnvironmentShape> shape;
    CubeLayout layout = CubeLayout::cross;
    std::optional<int> side;
    double blur = 0;
    bool isJson = false, isQuiet = false;
};

SampleType chooseSample(const std::string& target) {
    const std::string extension = lowerExtension(target);
    if (extension == ".exr" || extension == ".tif" || extension == ".tiff") return SampleType::real;
    if (extension == ".png") return SampleType::uint16;
    fail(Failure::usage, "{}: unknown kind of picture '{}'; use .exr, .tif or .png", target, extension);
}

/// What is seen from the point of --at of a scene.
EnvironmentPicture capture(const EnvironmentArgs& args) {
    const Warn warn = makeWarn(args.isQuiet);
    LoadedScene loaded = load(args.scene, CageState::posed, warn);
    Device device({.name = args.picture.device});
    measureFunction(device, loaded.object, args.scene.object.height, {{loaded.object.time}}, warn);
    checkFilter(args.picture, device, warn);

    // The scene as relief render draws it, and the picture behind it.
    RenderOptions options = toRenderOptions(args.picture, args.scene, loaded.object, device);
    const std::optional<GpuEnvironment> environment = makeEnvironment(device, loaded);
    options.lighting =
        makeLighting(args.scene.lighting, args.scene.camera.azimuth, environment ? &*environment : nullptr);
    options.bounds = computeBounds(computeOutline(loaded.object));
    const Model model = makeModel(device, loaded.object);
    const Instance instance(model, makeMaterial(args.scene.object.material, loaded.object.textureColor));
    std::optional<EnvironmentPicture> behind;
    if (environment) behind = readEnvironment(args.scene.lighting.environment, args.scene.lighting.shape).picture;
    EnvironmentPicture cube = captureSurroundings(device, std::span(&instance, 1), options,
                                                  {.at = loaded.object.coordinates().toLocal(*args.at),
                                                   .side = args.side.value_or(SurroundingsDesc().side),
                                                   .behind = behind ? &*behind : nullptr});
    checkValidation(device);
    return cube;
}

/// The picture that is converted, read or captured.
EnvironmentFile readSource(const EnvironmentArgs& args) {
    if (args.source.empty()) return {.picture = capture(args), .layout = CubeLayout::files, .isChosen = false};
    return readEnvironment(args.source, args.scene.lighting.shape);
}

int convertFile(const EnvironmentArgs& args) {
    const bool isCaptured = args.source.empty();
    if (isCaptured == args.scene.object.cage.empty())
        fail(Failure::usage, "name an environment to convert, or a scene with --from CAGE --at X,Y,Z");
    if (isCaptured && !args.at) fail(Failure::usage, "--from needs --at X,Y,Z: the point to see the scene from");
    // What can be refused is refused before anything is read or drawn. Six files, or a scene, are a cube by default.
    const SampleType sample = chooseSample(args.target);
    const std::vector<std::string> targets = listEnvironmentFiles(args.target);
    const bool isCube = targets.size() > 1 || isCaptured;
    const EnvironmentShape shape = args.shape.value_or(isCube ? EnvironmentShape::cube : EnvironmentShape::equirect);
    std::vector<std::string> inputs = listFiles(args.scene);
    for (const std::string& file : listEnvironmentFiles(args.source)) inputs.push_back(file);
    for (const std::string& target : targets) checkOutput(target, inputs);
    const EnvironmentFile file = readSource(args);

    // Blurred in the shape it has: the result is then as sharp as it is large.
    EnvironmentPicture picture = args.blur > 0 ? blur(file.picture, args.blur) : file.picture;
    const int side = args.side && !isCaptured ? *args.side : sideOf(picture, shape);
    if (shape != picture.shape || side != picture.side()) picture = convert(picture, shape, side);
    const CubeLayout layout = targets.size() > 1 ? CubeLayout::files : args.layout;
    writeEnvironment(args.target, picture, layout, sample);

    // Captured faces have the size that was asked for; what is read is described as its file was understood.
    const std::string from = isCaptured ? args.scene.object.cage : describe(file.picture, file.layout);
    const std::string to = describe(picture, layout);
    if (args.isJson)
        printJson({{"output", args.target},
                   {"shape", wordOf(kEnvironmentShapes, shape)},
                   {"side", side},
                   {"description", to},
                   {"source", from},
                   {"source_shape", wordOf(kEnvironmentShapes, file.picture.shape)}});
    else if (!args.isQuiet)
        std::cerr << fmt::format("{}: {}, from {}\n", args.target, to, from);
    return 0;
}

} // namespace

Run addEnvironment(CLI::App& app) {
    auto args = std::make_shared<EnvironmentArgs>();
    app.add_option(
           "environment", args->source,
           "environment: .hdr .exr .tif .png; six files where the name has {face}, which stands for px nx py ny "
           "pz nz")
        ->option_text("IN");
    app.add_option("-o,--output", args->target, "picture to write: .exr .tif .png; six files where the name has {face}")
        ->required()
        ->option_text("OUT");
    const char* group = "environment";
    listIn(group, "CAGE",
           app.add_option("--from", args->scene.object.cage,
                          "capture a scene instead: the cage of its object, which the options of relief render "
                          "displace, shade and light. What is put at the point and mirrors it is no part of it"));
    listIn(group, "X,Y,Z",
           addVector<dvec3>(app, "--at", args->at, "the point that the scene is seen from, in cage units")
               ->check(anyCoordinate()));
    listIn(group, "SHAPE",
           addEnum(app, "--shape", args->shape, kEnvironmentShapes,
                   "shape of the output (default: cube for six files, else equirect)"));
    listIn(group, "LAYOUT",
           addEnum(app, "--layout", args->layout, kCubeLayouts, "where the faces of a cube are in one picture"));
    listIn(group, "N",
           app.add_option("--side", args->side,
                          "height of the output, or side of a face; of a scene, of the faces that are captured "
                          "(default: about as many texels per degree as the input has; 256 of a scene)")
               ->check(CLI::Range(4, 8192)));
    listIn(group, "R",
           app.add_option("--blur", args->blur, "blur as a surface of that roughness does what it mirrors, 0.05..1")
               ->check(numberIn(0.05, 1)));
    addSurfaceOptions(app, args->scene.object);
    addHeightFunction(app, args->scene.object.height);
    addPicture(app, args->scene, args->picture);
    addTime(app, args->scene.object.motion);
    app.add_flag("--json", args->isJson, "print the result as JSON on stdout")->group("output");
    app.add_flag("-q,--quiet", args->isQuiet, "print no summary")->group("output");
    app.footer("-Z is in the middle of an equirectangular picture and in face pz, +X to the right of it.\n"
               "A sphere map shows +Z in the middle; within 4 / sqrt(side) radians of -Z its texels are smeared.\n"
               "examples:\n"
               "  relief environment sky.hdr -o sky_{face}.exr --side 512\n"
               "  relief environment sky_{face}.exr -o ball.exr --shape sphere\n"
               "  relief environment --from room.obj --at 0,1,0 -o room_{face}.exr --side 256\n"
               "  relief environment ball.exr -o soft.exr --shape cube --layout strip --blur 0.5");
    return [args] { return convertFile(*args); };
}

} // namespace relief::app
