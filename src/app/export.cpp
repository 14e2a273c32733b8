#include <algorithm>
#include <array>
#include <filesystem>
#include <iostream>

#include <malloc.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/object_options.h"
#include "app/output.h"
#include "app/picture_options.h"
#include "base/clock.h"
#include "geometry_image/geometry_image.h"

namespace relief::app {
namespace {

struct ExportArgs {
    SceneDesc scene; ///< its camera is what --edge-pixels are measured by
    TriangleOptions triangles{.path = Path::dice};
    Output output;
    std::string target, device;
    bool weldsPositions = false;
    std::string unusedByImages; ///< an option that is given and that geometry images do not have
};

/// A mesh and what is reported of it, after everything that made it is freed.
struct Exported {
    DenseMesh mesh;
    std::string device;
    std::uint64_t sampleCount = 0;
    double loadSeconds = 0, surfaceSeconds = 0, rateMs = 0, diceMs = 0, writeSeconds = 0;
};

/// The first option on the command line that the triangles of a geometry image do not listen to; empty where there is
/// none.
std::string findUnusedOption(const CLI::App& app) {
    constexpr std::array kUsed{"--help",  "--output",  "--mip",      "--weld-positions", "--json",
                               "--quiet", "--verbose", "--progress", "--device"};
    for (const CLI::Option* option : app.get_options())
        if (option->count() > 0 && !option->get_positional() &&
            std::ranges::none_of(kUsed, [&](const char* name) { return option->check_name(name); }))
            return option->get_name();
    return "";
}

/// The mesh of a geometry image, with each point once: no device is needed for it.
Exported sew(const ExportArgs& args) {
    const double start = secondsNow();
    const ObjectDesc& desc = args.scene.object;
    if (!args.unusedByImages.empty())
        fail(Failure::usage,
             "{}: {} is for cages; the triangles of a geometry image are exported as they are, those of --mip",
             desc.cage, args.unusedByImages);
    const GeometryImage image = readGeometryImage(desc.cage);
    if (desc.mip.value_or(0) >= image.mipCount())
        fail(Failure::usage, "{}: --mip {} is none of its mips, which are 0 to {}", desc.cage, *desc.mip,
             image.mipCount() - 1);
    Exported exported{.mesh = toMesh(image, desc.mip.value_or(0))};
    exported.sampleCount = exported.mesh.positions.size();
    checkMeshSize(args.target, exported.sampleCount, exported.mesh.indices.size() / 3, false);
    exported.loadSeconds = secondsNow() - start;
    return exported;
}

EdgeRates computeRates(Device& device, const SurfaceModel& model, const LoadedObject& object, const ExportArgs& args,
                       double& rateMs) {
    View view;
    if (!args.triangles.rate) // only lengths on screen need a camera
        view = viewOf(makeCamera(args.scene, object.coordinates(), computeOutline(object)), args.scene.size.y);
    return EdgeRater(device).rates(model, args.triangles, view, &rateMs);
}

/// Whatever made the mesh is freed before the mesh is written.
Exported dice(const ExportArgs& args) {
    // The object on the host, then on the device.
    Progress progress("dicing", 4, args.output.progress);
    const ObjectDesc& desc = args.scene.object;
    LoadedObject object = load(desc, CageState::posed, makeWarn(args.output.isQuiet));
    if (object.dense)
        fail(Failure::usage, "{}: only a subdivision surface can be diced into triangles; name its --scheme",
             desc.cage);
    progress.advance();

    Device device({.name = args.device});
    measureFunction(device, object, desc.height, {{object.time}}, makeWarn(args.output.isQuiet));
    SurfaceModel model = makeSurfaceModel(device, object);
    keepRestPose(device, model, object, desc.height.space);
    progress.advance();

    // The size of the mesh is known once it is diced, and checked before it is read back.
    Exported exported{
        .device = device.traits().name, .loadSeconds = object.loadSeconds, .surfaceSeconds = object.surfaceSeconds};
    const EdgeRates rates = computeRates(device, model, object, args, exported.rateMs);
    const bool hasTexCoords = object.cage.hasTexCoords();
    const DicedMesh diced = Dicer(device).dice(
        model, rates,
        {.normal = args.triangles.normal, .wantsTexCoords = hasTexCoords, .memory = args.triangles.memory});
    progress.advance();
    checkMeshSize(args.target, diced.vertexCount, diced.triangleCount, hasTexCoords);

    exported.mesh = readBack(device, diced);
    exported.mesh.coordinates = object.coordinates();
    exported.sampleCount = diced.sampleCount;
    exported.diceMs = diced.milliseconds;
    progress.advance();
    checkValidation(device);
    return exported;
}

void report(const ExportArgs& args, const Exported& exported) {
    const std::size_t vertexCount = exported.mesh.positions.size(), triangleCount = exported.mesh.indices.size() / 3;
    const std::uint64_t bytes = std::filesystem::file_size(args.target);
    if (args.output.isJson) {
        // Programs read these names.
        printJson({{"mesh", args.target},
                   {"device", exported.device},
                   {"vertices", vertexCount},
                   {"triangles", triangleCount},
                   {"samples", exported.sampleCount},
                   {"bytes", bytes},
                   {"load_ms", 1e3 * exported.loadSeconds},
                   {"surface_ms", 1e3 * exported.surfaceSeconds},
                   {"rate_ms", exported.rateMs},
                   {"dice_ms", exported.diceMs},
                   {"write_ms", 1e3 * exported.writeSeconds}});
    } else if (!args.output.isQuiet) {
        // One line for people, and a second one with the time of every step.
        std::cerr << fmt::format("{}: {} vertices, {} triangles, {}, {}\n", args.target, vertexCount, triangleCount,
                                 humanBytes(bytes),
                                 exported.device.empty() ? "sewn on the host" : "diced on " + exported.device);
        if (args.output.isVerbose)
            std::cerr << fmt::format(
                "load {:.0f} ms, surface {:.0f} ms, rates {:.1f} ms, dicing {:.1f} ms, writing {:.0f} ms, {} samples\n",
                1e3 * exported.loadSeconds, 1e3 * exported.surfaceSeconds, exported.rateMs, exported.diceMs,
                1e3 * exported.writeSeconds, exported.sampleCount);
    }
}

int exportMesh(const ExportArgs& args) {
    checkMeshPath(args.target);
    checkOutput(args.target, listFiles(args.scene));
    Exported exported = lowerExtension(args.scene.object.cage) == ".exr" ? sew(args) : dice(args);
    // OBJ has each position once already, and texture coordinates beside it.
    if (args.weldsPositions && lowerExtension(args.target) != ".obj") exported.mesh = weldPositions(exported.mesh);
    malloc_trim(0);
    const double start = secondsNow();
    writeMesh(args.target, exported.mesh, args.output.progress);
    exported.writeSeconds = secondsNow() - start;
    report(args, exported);
    return 0;
}

} // namespace

Run addExport(CLI::App& app) {
    auto args = std::make_shared<ExportArgs>();
    addObject(app, args->scene.object);
    addTime(app, args->scene.object.motion);
    app.add_option("-o,--output", args->target, "mesh to write: .ply, .obj or .glb")->required()->option_text("MESH");
    app.add_flag("--weld-positions", args->weldsPositions,
                 "write each position once, without texture coordinates, so that the mesh is closed for a slicer "
                 "(.obj always has each position once)");
    addTriangles(app, args->triangles);
    addCamera(app, args->scene.camera, args->scene.size);
    addHeightSpace(app, args->scene.object.height.space);
    addDevice(app, args->device);
    addOutput(app, args->output);
    app.footer("The camera is what --edge-pixels are measured by.\n"
               "examples:\n"
               "  relief export cage.obj --height map.exr --rate 32 -o dense.ply\n"
               "  relief export cage.obj --height map.exr --edge-pixels 1 --size 3840,2160 -o hero.glb");
    return [args, &app] {
        args->unusedByImages = findUnusedOption(app);
        return exportMesh(*args);
    };
}

} // namespace relief::app
