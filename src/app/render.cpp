#include <future>
#include <iostream>

#include <malloc.h>

#include <nlohmann/json.hpp>

#include "app/commands.h"
#include "app/compare.h"
#include "app/empty.h"
#include "app/library_pages.h"
#include "app/object_options.h"
#include "app/options.h"
#include "app/output.h"
#include "app/picture_options.h"

namespace relief::app {
namespace {

struct RenderArgs {
    SceneDesc scene;
    std::vector<Detail> compared; ///< draws all of these side by side in place of one
    PictureArgs picture;
    Output output;
    std::string target;
};

/// A picture and what is reported of it, after everything that made it is freed.
struct Drawn {
    Picture picture;
    std::string device;
    std::string environmentNote; ///< LoadedScene's
    std::string mapFormat;       ///< empty without a map
    std::optional<HeightFunction::Costs> function;
    std::string complaint; ///< why there is nothing to see, or empty
    std::uint64_t cageBytes = 0, mapBytes = 0, deviceBytes = 0;
    std::uint64_t peakDeviceBytes = 0; ///< the most that was allocated on the device while the frame was drawn
    double loadSeconds = 0, surfaceSeconds = 0, tableSeconds = 0;
};

/// Programs read these names: relief bench does.
nlohmann::json toJson(const RenderArgs& args, const Drawn& drawn) {
    const FrameStats& stats = drawn.picture.stats;
    nlohmann::json all{{"picture", args.target},
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
                       {"occlusion_ms", stats.occlusionMs},
                       {"light_ms", stats.lightMs},
                       {"other_lights_ms", stats.otherLightsMs},
                       {"environment", drawn.environmentNote},
                       {"frame_ms", stats.wallMs}};
    if (drawn.function)
        all.update({{"function_compiled", drawn.function->compiledCount},
                    {"function_cached", drawn.function->cachedCount},
                    {"function_ms", drawn.function->milliseconds}});
    return all;
}

void report(const RenderArgs& args, const Drawn& drawn) {
    const FrameStats& stats = drawn.picture.stats;
    if (args.output.isJson) {
        printJson(toJson(args, drawn));
    } else if (!args.output.isQuiet) {
        if (!drawn.environmentNote.empty()) std::cerr << drawn.environmentNote << '\n';
        // One line for people, and a second one with the time of every step.
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

/// Techniques that are compared have one camera, which holds the displaced surface and the smooth one.
std::vector<dvec3> outlineOf(LoadedObject& object, bool isCompared) {
    if (!isCompared) return computeOutline(object);
    const Detail detail = std::exchange(object.detail, Detail::none);
    std::vector<dvec3> points = computeOutline(object);
    object.detail = Detail::displacement;
    const std::vector<dvec3> displaced = computeOutline(object);
    points.insert(points.end(), displaced.begin(), displaced.end());
    object.detail = detail;
    return points;
}

/// Bytes of heights on the device: the map's words, and its slopes where they bend normals.
std::uint64_t mapBytesOf(const Model& model) {
    const auto* surface = std::get_if<SurfaceModel>(&model);
    const std::uint64_t words = surface != nullptr && surface->height ? surface->height->words.buffer.bytes : 0;
    const auto slopesOf = [](const auto& either) -> std::uint64_t {
        return either.pictures.slopes ? either.pictures.slopes->byteCount : 0;
    };
    return words + std::visit(slopesOf, model);
}

/// Memory is freed as soon as it is not needed: the peak is that of the frame itself, not of what led to it.
Drawn draw(const RenderArgs& args, const Warn& warn, Progress& progress) {
    // Loading a driver takes its time: it does so while files are read.
    std::future<std::unique_ptr<Device>> opening =
        std::async([&] { return std::make_unique<Device>(DeviceDesc{.name = args.picture.device}); });
    LoadedScene loaded = load(withFittingMip(args.scene), CageState::posed, warn);
    progress.advance();
    std::unique_ptr<Device> opened;
    if (loaded.object.function) { // what it displaces by is known to the device alone
        opened = opening.get();
        measureFunction(*opened, loaded.object, args.scene.object.height, {{loaded.object.time}}, warn);
    }
    const std::vector<dvec3> points = outlineOf(loaded.object, !args.compared.empty());
    progress.advance();

    // What the picture shows, and the model of it.
    if (!opened) opened = opening.get();
    Device& device = *opened;
    checkShown(args.picture, args.scene.object.cage, loaded.object);
    checkFilter(args.picture, device, warn);
    const Coordinates coordinates = loaded.object.coordinates();
    RenderOptions options = toRenderOptions(args.picture, args.scene, loaded.object, device);
    const std::optional<GpuEnvironment> environment = makeEnvironment(device, loaded);
    options.lighting =
        makeLighting(args.scene.lighting, args.scene.camera.azimuth, environment ? &*environment : nullptr);
    const std::optional<GpuMatcap> matcap = makeMatcap(device, loaded);
    options.matcap = matcap ? &*matcap : nullptr;
    options.camera = makeCamera(args.scene, coordinates, points);
    options.bounds = computeBounds(points);
    Model model = makeModel(device, loaded.object);
    SurfaceModel* surface = std::get_if<SurfaceModel>(&model);
    if (surface != nullptr) keepRestPose(device, *surface, loaded.object, args.scene.object.height.space);

    // From here on the device holds everything that is drawn.
    const LoadedObject& object = loaded.object;
    Drawn drawn{.device = device.traits().name,
                .environmentNote = loaded.environmentNote,
                .mapFormat = object.height ? wordOf(kMapFormats, object.heightEncoding.format) : "",
                .cageBytes = object.cage.byteCount(),
                .mapBytes = mapBytesOf(model),
                .deviceBytes = byteCountOf(model),
                .loadSeconds = object.loadSeconds,
                .surfaceSeconds = object.surfaceSeconds,
                .tableSeconds = object.surface.tableSeconds};
    const Material material = makeMaterial(args.scene.object.material, object.textureColor);
    loaded = {};
    malloc_trim(0);
    releaseLibraryPages();
    progress.advance();

    const ivec2& size = args.scene.size;
    Renderer renderer(device, {.width = size.x, .height = size.y});
    device.startPeak();
    drawn.picture = drawPicture(renderer, Instance(model, material), options, args.picture, device);
    warnOfLongSegments(options, device, drawn.picture.stats, warn);
    // The first frame compiles shaders: times that are compared are those of a second one.
    if (!args.compared.empty()) drawn.picture = renderer.render(Instance(model, material), options);
    drawn.peakDeviceBytes = device.peakBytes();
    if (surface != nullptr && surface->function) drawn.function = surface->function->costs();
    drawn.complaint = complaintOf(drawn.picture, {points, options.camera, size, coordinates});
    progress.advance();
    checkValidation(device);
    return drawn;
}

std::string captionOf(Detail detail, const FrameStats& stats) {
    return fmt::format("{}: {:.0f} ms, {} triangles", wordOf(kDetails, detail), stats.wallMs, stats.triangleCount);
}

int compare(const RenderArgs& args) {
    // Panels have captions and one range of colours: a picture for people, not layers.
    if (!args.target.ends_with(".png")) fail(Failure::usage, "{}: --compare writes a .png", args.target);
    if (args.scene.object.height.path.empty() && args.scene.object.height.function.empty())
        fail(Failure::usage, "--compare shows what heights do; name a --height map or a --height-function");
    Progress progress("comparing", 5 * args.compared.size(), args.output.progress);
    const Warn warn = makeWarn(args.output.isQuiet);
    std::vector<Panel> panels;
    nlohmann::json reports = nlohmann::json::array();
    for (const Detail detail : args.compared) {
        // Everything but the technique is the same, so that differences are its own.
        RenderArgs one = args;
        one.scene.object.height.detail = detail;
        const Drawn drawn = draw(one, warn, progress);
        if (!drawn.complaint.empty()) warn(fmt::format("{}: {}", args.scene.object.cage, drawn.complaint));
        panels.push_back({displayed(drawn.picture, args.picture.finish), captionOf(detail, drawn.picture.stats)});
        reports.push_back(toJson(one, drawn));
        reports.back()["detail"] = wordOf(kDetails, detail);
        progress.advance();
    }
    writeImage(args.target, arrangePanels(panels, warn), SampleType::uint8);
    if (args.output.isJson) {
        printJson(reports);
    } else if (!args.output.isQuiet) {
        for (const Panel& panel : panels) std::cerr << fmt::format("{}: {}\n", args.target, panel.caption);
    }
    return 0;
}

int render(const RenderArgs& args) {
    // What libraries free goes back to the system at once: by itself malloc keeps up to 64 MB after large allocations.
    mallopt(M_TRIM_THRESHOLD, 64 << 10);
    checkPicturePath(args.target, args.picture);
    checkOutput(args.target, listFiles(args.scene));
    if (!args.compared.empty()) return compare(args);
    Progress progress("rendering", 5, args.output.progress);
    const Warn warn = makeWarn(args.output.isQuiet);
    const Drawn drawn = draw(args, warn, progress);
    writePicture(args.target, drawn.picture, args.picture.finish);
    progress.advance();
    if (!drawn.complaint.empty()) warn(fmt::format("{}: {}", args.scene.object.cage, drawn.complaint));
    report(args, drawn);
    return 0;
}

/// Takes spaces off both ends of a word: lists are written with spaces after their commas.
CLI::Validator trimmed() {
    const auto trim = [](std::string& word) {
        CLI::detail::trim(word);
        return std::string();
    };
    return {trim, ""};
}

void addCompare(CLI::App& app, std::vector<Detail>& compared) {
    const std::vector<WordHelp> words = listWords(kDetails);
    const auto set = [&compared](const std::vector<std::string>& names) {
        compared.clear();
        for (const std::string& name : names)
            for (const Word<Detail>& row : kDetails)
                if (name == row.word) compared.push_back(row.value);
    };
    CLI::Option* option = app.add_option_function<std::vector<std::string>>(
        "--compare", set, "draw the view by each of these, side by side with their times; words as of --detail");
    option->excludes(app.get_option("--detail"));
    listIn("height", "HOW,HOW", option->delimiter(',')->transform(trimmed())->check(oneOf(words)));
}

} // namespace

Run addRender(CLI::App& app) {
    auto args = std::make_shared<RenderArgs>();
    addObject(app, args->scene.object);
    app.add_option("-o,--output", args->target, "picture to write: .png or .exr")->required()->option_text("PICTURE");
    addPicture(app, args->scene, args->picture);
    addCompare(app, args->compared);
    addTime(app, args->scene.object.motion);
    addOutput(app, args->output);
    app.footer(
        "examples:\n"
        "  relief render meshes/torus.obj --height golf.exr -o golf.png\n"
        "  relief render cage.obj --height wrinkles.png --scale 0.05 --albedo skin.png --edge-pixels 1 -o face.png\n"
        "  relief render meshes/torus.obj --height-function golf --scale 0.5 -o golf.png\n"
        "  relief render cage.obj --show wireframe --rate 8 --size 800,600 --azimuth 45 -o wire.png\n"
        "  relief render cage.obj --height map.exr --compare bump,displacement,both -o compared.png\n"
        "  relief render dense.obj -o dense.exr");
    return [args] { return render(*args); };
}

} // namespace relief::app
