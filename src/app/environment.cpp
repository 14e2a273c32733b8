// relief environment: pictures of the light from all directions, from one shape to another.
#include <iostream>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/light_options.h"
#include "app/options.h"
#include "app/output.h"

namespace relief::app {
namespace {

struct EnvironmentArgs {
    std::string source, target;
    std::optional<EnvironmentShape> sourceShape, shape;
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

int convertFile(const EnvironmentArgs& args) {
    const SampleType sample = chooseSample(args.target);
    const std::vector<std::string> targets = listEnvironmentFiles(args.target);
    const EnvironmentShape shape =
        args.shape.value_or(targets.size() > 1 ? EnvironmentShape::cube : EnvironmentShape::equirect);
    for (const std::string& target : targets) checkOutput(target, listEnvironmentFiles(args.source));
    const EnvironmentFile file = readEnvironment(args.source, args.sourceShape);

    // Blurred in the shape it has: the result is then as sharp as it is large.
    EnvironmentPicture picture = args.blur > 0 ? blur(file.picture, args.blur) : file.picture;
    const int side = args.side.value_or(sideOf(picture, shape));
    if (shape != picture.shape || side != picture.side()) picture = convert(picture, shape, side);
    const CubeLayout layout = targets.size() > 1 ? CubeLayout::files : args.layout;
    writeEnvironment(args.target, picture, layout, sample);

    const std::string from = describe(file.picture, file.layout), to = describe(picture, layout);
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
        ->required()
        ->option_text("IN");
    app.add_option("-o,--output", args->target, "picture to write: .exr .tif .png; six files where the name has {face}")
        ->required()
        ->option_text("OUT");
    const char* group = "environment";
    addEnvironmentShape(app, args->sourceShape);
    listIn(group, "SHAPE",
           addEnum(app, "--shape", args->shape, kEnvironmentShapes,
                   "shape of the output (default: cube for six files, else equirect)"));
    listIn(group, "LAYOUT",
           addEnum(app, "--layout", args->layout, kCubeLayouts, "where the faces of a cube are in one picture"));
    listIn(group, "N",
           app.add_option("--side", args->side,
                          "height of the output, or side of a face (default: about as many texels per degree as the "
                          "input has)")
               ->check(CLI::Range(4, 8192)));
    listIn(group, "R",
           app.add_option("--blur", args->blur, "blur as a surface of that roughness does what it mirrors, 0.05..1")
               ->check(numberIn(0.05, 1)));
    app.add_flag("--json", args->isJson, "print the result as JSON on stdout")->group("output");
    app.add_flag("-q,--quiet", args->isQuiet, "print no summary")->group("output");
    app.footer("-Z is in the middle of an equirectangular picture and in face pz, +X to the right of it.\n"
               "A sphere map shows +Z in the middle; within 4 / sqrt(side) radians of -Z its texels are smeared.\n"
               "examples:\n"
               "  relief environment sky.hdr -o sky_{face}.exr --side 512\n"
               "  relief environment sky_{face}.exr -o ball.exr --shape sphere\n"
               "  relief environment ball.exr -o soft.exr --shape cube --layout strip --blur 0.5");
    return [args] { return convertFile(*args); };
}

} // namespace relief::app
