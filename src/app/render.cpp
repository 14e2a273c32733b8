#include <future>
#include <iostream>

#include <malloc.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/empty.h"
#include "app/output.h"
#include "app/weld.h"

namespace relief::app {
namespace {

struct RenderArgs {
    SurfaceArgs surface;
    PictureArgs picture;
    Output output;
    std::string target;
};

/// A picture and what is told of it, when everything that made it is gone.
struct Drawn {
    Picture picture;
    std::string device;
    std::string mapFormat; ///< empty without a map
    std::string complaint; ///< where there is nothing to see
    std::uint64_t cageBytes = 0, mapBytes = 0, deviceBytes = 0;
    std::uint64_t peakDeviceBytes = 0; ///< of everything that the frame has on the device
    double loadSeconds = 0, surfaceSeconds = 0, tableSeconds = 0;
};

void report(const RenderArgs& args, const Drawn& drawn) {
    const FrameStats& stats = drawn.picture.stats;
    if (args.output.isJson) {
        printJson({{"picture", args.target},
                   {"device", drawn.device},
                   {"triangles", stats.triangleCount},
                   {"faces", stats.faceCount},
                   {"hidden_faces", stats.hiddenFaceCount},
                   {"draws", stats.drawCount},
                   {"max_rate", stats.maxRate},
                   {"cage_bytes", drawn.cageBytes},
                   {"map_bytes", drawn.mapBytes},
                   {"map_format", drawn.mapFormat},
                   {"vertices", stats.vertexCount},
                   {"dense_bytes", denseBytes(stats.vertexCount, stats.triangleCount)},
                   {"device_bytes", drawn.deviceBytes},
                   {"peak_device_bytes", drawn.peakDeviceBytes},
                   {"load_ms", 1e3 * drawn.loadSeconds},
                   {"surface_ms", 1e3 * drawn.surfaceSeconds},
                   {"table_ms", 1e3 * drawn.tableSeconds},
                   {"rate_ms", stats.rateMs},
                   {"dice_ms", stats.diceMs},
                   {"shadow_ms", stats.shadowMs},
                   {"color_ms", stats.colorMs},
                   {"light_ms", stats.lightMs},
                   {"frame_ms", stats.wallMs}});
    } else if (!args.output.isQuiet) {
        std::cerr << fmt::format("{}: {} triangles, {:.0f} ms on {}\n", args.target, stats.triangleCount, stats.wallMs,
                                 drawn.device);
        if (args.output.isVerbose)
            std::cerr << fmt::format(
                "load {:.0f} ms, surface {:.0f} ms (OpenSubdiv {:.0f}), rates {:.1f} ms, shadow {:.1f} ms, "
                "color {:.1f} ms, light {:.1f} ms, {} faces in {} draws, rate up to {}, {} on the device\n",
                1e3 * drawn.loadSeconds, 1e3 * drawn.surfaceSeconds, 1e3 * drawn.tableSeconds, stats.rateMs,
                stats.shadowMs, stats.colorMs, stats.lightMs, stats.faceCount, stats.drawCount, stats.maxRate,
                humanBytes(drawn.deviceBytes));
    }
}

/// Memory goes back as soon as it is not needed: the peak is the frame itself, not everything that led to it.
Drawn draw(const RenderArgs& args, Progress& progress) {
    // A driver takes its time to load: it does so while files are read.
    std::future<std::unique_ptr<Device>> opening =
        std::async([&] { return std::make_unique<Device>(DeviceDesc{.name = args.picture.device}); });
    Loaded loaded = load(args.surface, args.output, args.picture.albedo);
    warnOfPlainTags(loaded, args.surface, args.output.warn());
    progress.advance();
    Shading shading = loadShading(args.picture, args.surface, loaded.cage, args.output.warn());
    const std::vector<dvec3> points = outlineOf(loaded);
    progress.advance();

    const std::unique_ptr<Device> opened = opening.get();
    Device& device = *opened;
    PictureArgs picture = args.picture;
    enter(loaded.coordinates(), picture.camera);
    RenderOptions options = renderOptions(picture, device, points);
    options.unit = loaded.coordinates().unit;
    if (shading.environment) options.lighting.environment = &*shading.environment;
    Model model(device, {.surface = &loaded.surface,
                         .cagePositions = loaded.cage.positions,
                         .height = loaded.heightMap(),
                         .encoding = &loaded.heightEncoding,
                         .dense = loaded.dense ? &*loaded.dense : nullptr,
                         .albedo = shading.albedo ? &*shading.albedo : nullptr});
    const std::unique_ptr<Poser> poser = stretchHeights(device, model, loaded, args.picture.heightSpace);
    Drawn drawn{.device = device.traits().name,
                .mapFormat = loaded.height ? wordOf(kMapFormats, loaded.heightEncoding.format) : "",
                .cageBytes = loaded.cage.byteCount(),
                .mapBytes = model.heightBytes(),
                .deviceBytes = model.byteCount(),
                .loadSeconds = loaded.loadSeconds,
                .surfaceSeconds = loaded.surfaceSeconds,
                .tableSeconds = loaded.surface.tableSeconds};
    const Coordinates coordinates = loaded.coordinates();
    loaded = {};
    shading.albedo.reset();
    malloc_trim(0);
    progress.advance();
    Renderer renderer(device, {.width = args.picture.camera.size[0], .height = args.picture.camera.size[1]});
    device.startPeak();
    drawn.picture = renderer.render(model, options);
    drawn.peakDeviceBytes = device.peakBytes();
    const std::vector<int>& size = args.picture.camera.size;
    drawn.complaint = complaintOf(drawn.picture, {points, options.camera, size[0], size[1], coordinates});
    progress.advance();
    checkValidation(device);
    return drawn;
}

int render(const RenderArgs& args) {
    checkPicturePath(args.target, args.picture);
    checkOutput(args.target, inputsOf(args.surface, args.picture));
    Progress progress("rendering", 5, args.output.progress);
    const Drawn drawn = draw(args, progress);
    writePicture(args.target, drawn.picture, finishOf(args.picture));
    progress.advance();
    if (!drawn.complaint.empty()) args.output.warn()(fmt::format("{}: {}", args.surface.cage, drawn.complaint));
    report(args, drawn);
    return 0;
}

} // namespace

Run addRender(CLI::App& app) {
    auto args = std::make_shared<RenderArgs>();
    addSurface(app, args->surface);
    app.add_option("-o,--output", args->target, "picture to write: .png or .exr")->required()->option_text("PICTURE");
    addPicture(app, args->picture);
    addTime(app, args->surface.pose);
    addOutput(app, args->output);
    app.footer(
        "examples:\n"
        "  relief render meshes/torus.obj --height golf.exr -o golf.png\n"
        "  relief render cage.obj --height wrinkles.png --scale 0.05 --albedo skin.png --edge-pixels 1 -o face.png\n"
        "  relief render cage.obj --show wireframe --rate 8 --size 800,600 --azimuth 45 -o wire.png\n"
        "  relief render dense.obj -o dense.exr");
    return [args] { return render(*args); };
}

} // namespace relief::app
