#include <filesystem>
#include <iostream>

#include <malloc.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/output.h"

namespace relief::app {
namespace {

struct ExportArgs {
    SurfaceArgs surface;
    TriangleArgs triangles{.path = "dice"};
    CameraArgs camera;
    Output output;
    std::string target, device, heightSpace = "absolute";
    bool weldsPositions = false;
};

/// A mesh and what is told of it, when everything that made it is gone.
struct Exported {
    DenseMesh mesh;
    std::string device;
    std::uint64_t sampleCount = 0;
    double loadSeconds = 0, surfaceSeconds = 0, rateMs = 0, diceMs = 0, writeSeconds = 0;
};

EdgeRates ratesOf(Device& device, const Model& model, const Loaded& loaded, const ExportArgs& args, double& rateMs) {
    View view;
    CameraArgs camera = args.camera;
    enter(loaded.coordinates(), camera);
    if (!args.triangles.rate) view = viewOf(cameraOf(camera, outlineOf(loaded)), camera.size[1]);
    return EdgeRater(device).rates(model, triangleOptions(args.triangles, device), view, &rateMs);
}

/// Whatever made the mesh gives its memory back before the mesh is written.
Exported dice(const ExportArgs& args) {
    Progress progress("dicing", 4, args.output.progress);
    const Loaded loaded = load(args.surface, args.output);
    if (loaded.dense)
        fail(Failure::usage, "{}: only a subdivision surface has triangles to make; name its --scheme",
             args.surface.cage);
    progress.advance();
    Device device({.name = args.device});
    Model model(device, {.surface = &loaded.surface,
                         .cagePositions = loaded.cage.positions,
                         .height = loaded.heightMap(),
                         .encoding = &loaded.heightEncoding});
    const std::unique_ptr<Poser> poser = stretchHeights(device, model, loaded, args.heightSpace);
    progress.advance();

    Exported exported{
        .device = device.traits().name, .loadSeconds = loaded.loadSeconds, .surfaceSeconds = loaded.surfaceSeconds};
    const EdgeRates rates = ratesOf(device, model, loaded, args, exported.rateMs);
    const bool hasTexCoords = loaded.cage.hasTexCoords();
    const DicedMesh diced = Dicer(device).dice(
        model, rates,
        {.normal = normalKind(args.triangles.normal), .wantsTexCoords = hasTexCoords, .memory = args.triangles.memory});
    progress.advance();
    checkMeshSize(args.target, diced.vertexCount, diced.triangleCount, hasTexCoords);
    exported.mesh = readBack(device, diced);
    exported.mesh.coordinates = loaded.coordinates();
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
        std::cerr << fmt::format("{}: {} vertices, {} triangles, {}, diced on {}\n", args.target, vertexCount,
                                 triangleCount, humanBytes(bytes), exported.device);
        if (args.output.isVerbose)
            std::cerr << fmt::format(
                "load {:.0f} ms, surface {:.0f} ms, rates {:.1f} ms, dicing {:.1f} ms, writing {:.0f} ms, {} samples\n",
                1e3 * exported.loadSeconds, 1e3 * exported.surfaceSeconds, exported.rateMs, exported.diceMs,
                1e3 * exported.writeSeconds, exported.sampleCount);
    }
}

int exportMesh(const ExportArgs& args) {
    checkMeshPath(args.target);
    checkOutput(args.target, inputsOf(args.surface));
    Exported exported = dice(args);
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
    addSurface(app, args->surface);
    addTime(app, args->surface.pose);
    app.add_option("-o,--output", args->target, "mesh to write: .ply, .obj or .glb")->required()->option_text("MESH");
    app.add_flag("--weld-positions", args->weldsPositions,
                 "one vertex a position, without texture coordinates: closed for a slicer (.obj always is)");
    addTriangles(app, args->triangles);
    addCamera(app, args->camera);
    addHeightSpace(app, args->heightSpace);
    addDevice(app, args->device);
    addOutput(app, args->output);
    app.footer("the camera is what --edge-pixels are seen by\n"
               "examples:\n"
               "  relief export cage.obj --height map.exr --rate 32 -o dense.ply\n"
               "  relief export cage.obj --height map.exr --edge-pixels 1 --size 3840,2160 -o hero.glb");
    return [args] { return exportMesh(*args); };
}

} // namespace relief::app
