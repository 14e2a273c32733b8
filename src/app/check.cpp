#include <cmath>
#include <iostream>

#include "app/commands.h"
#include "app/heatmap.h"
#include "app/output.h"

namespace relief::app {
namespace {

struct CheckArgs {
    SurfaceArgs surface;
    TriangleArgs triangles;
    Output output;
    std::size_t pointCount = 200'000;
    std::string heatmap, device;
};

constexpr std::size_t kPointsAtOnce = 1u << 18; // keeps the device's buffers below 40 MB
constexpr int kPictureSide = 1024;              // of the views, and what --edge-pixels are measured in

/// Azimuth and elevation: along the axes, from both sides.
constexpr double kViews[][2] = {{0, 0}, {90, 0}, {180, 0}, {270, 0}, {0, 90}, {0, -90}};

// --- triangles

std::vector<std::string> pathsOf(const CheckArgs& args, const DeviceTraits& traits) {
    if (!args.triangles.path.empty()) return {args.triangles.path};
    if (traits.hasTessellation && traits.hasTransformFeedback) return {"tessellation", "grid", "dice"};
    return {"grid", "dice"};
}

/// Measures one path after another.
class PathChecker {
public:
    PathChecker(Device& device, const Model& model, const Loaded& loaded, const CheckArgs& args)
        : device_(device), model_(model), args_(args), rater_(device), capturer_(device),
          renderer_(device, {.width = kPictureSide, .height = kPictureSide, .shadowSide = 1}),
          canSeeCracks_(enclosesVolume(loaded.surface)) {
        const ReferenceSurface coarse(loaded.cage, {.scheme = loaded.options.scheme, .isolation = 2});
        points_ = outline(coarse, loaded.heightMap());
    }

    /// `shift`: how far the crack pictures move every other vertex, cage units.
    PathReport check(const std::string& path, double shift) {
        RenderOptions options{triangleOptions(args_.triangles, device_)};
        options.path = pathOf(path, device_);
        options.lighting.castsShadows = false;
        for (const dvec3& p : points_) options.bounds.add(p);
        PathReport report{.path = path, .triangles = checkTriangles(options)};
        if (canSeeCracks_) report.crackPixels = countCrackPixels(options, shift);
        return report;
    }

private:
    Watertightness checkTriangles(const TriangleOptions& options) {
        const View view = viewOf(frameCamera(points_, {}, 1), kPictureSide);
        const EdgeRates rates = rater_.rates(model_, options, view);
        return checkWatertight(capturer_.capture(model_, options, rates), boundarySegments(model_, rates),
                               plannedTriangles(model_, options.path, rates));
    }

    std::uint64_t countCrackPixels(RenderOptions options, double shift) {
        const dvec3 aslant = glm::normalize(dvec3(3, 4, 5)); // no view looks along it
        std::uint64_t count = 0;
        for (const auto& [azimuth, elevation] : kViews) {
            options.camera = frameCamera(points_, {.azimuth = azimuth, .elevation = elevation}, 1);
            count += renderer_.crackPixels(model_, options, vec3(shift * aslant));
        }
        return count;
    }

    Device& device_;
    const Model& model_;
    const CheckArgs& args_;
    EdgeRater rater_;
    Capturer capturer_;
    Renderer renderer_;
    bool canSeeCracks_;
    std::vector<dvec3> points_;
};

// --- points

std::vector<SampleResult> sampleDevice(Device& device, const Model& model, std::span<const SampleQuery> queries,
                                       NormalKind normal) {
    SurfaceSampler sampler(device);
    std::vector<SampleResult> results;
    results.reserve(queries.size());
    for (std::size_t first = 0; first < queries.size(); first += kPointsAtOnce) {
        const auto part = queries.subspan(first, std::min(kPointsAtOnce, queries.size() - first));
        const auto frames = sampler.sample(model, part, {.firstRow = first, .normal = normal});
        results.insert(results.end(), frames.begin(), frames.end());
    }
    return results;
}

/// Frames, curvature, corners and seams from the device's answers; returns the heat map that is asked for.
std::optional<Picture> checkPoints(Device& device, const Model& model, const Loaded& loaded, const CheckArgs& args,
                                   Certificate& certificate) {
    const SurfaceSamples samples = sampleEverywhere(loaded.surface, args.pointCount);
    const NormalKind normal = normalKind(args.triangles.normal);
    const std::vector<SampleResult> results = sampleDevice(device, model, samples.queries, normal);
    const ReferenceSurface reference(loaded.cage, loaded.options);
    const std::vector<SampleError> errors =
        sampleErrors({&reference, loaded.heightMap(), normal, certificate.diagonal}, samples.queries, results);
    certificate.frames = summarizeErrors(samples.queries, errors);
    certificate.curvature = reportCurvature(samples, results);
    const std::vector<SampleQuery> corners = cornersOf(loaded.surface);
    certificate.corners = reportCorners(reference, corners, sampleDevice(device, model, corners, normal));
    if (loaded.height) certificate.seams = reportSeams(loaded.surface, reference, *loaded.height);
    if (args.heatmap.empty()) return {};
    const Heat heat{samples, results, errors, promisesAt(certificate.isolation)};
    return drawHeatmap(device, heatMesh(heat, loaded.surface.sideCount));
}

// --- the command

/// Writes the heat map when all else has gone well.
Certificate certify(const CheckArgs& args, const Loaded& loaded) {
    Device device({.name = args.device});
    const Model model(device, {.surface = &loaded.surface,
                               .cagePositions = loaded.cage.positions,
                               .height = loaded.heightMap(),
                               .encoding = &loaded.heightEncoding});
    const std::vector<std::string> paths = pathsOf(args, device.traits());
    Progress progress("checking", 1 + paths.size(), args.output.progress);

    Certificate certificate{.cage = args.surface.cage,
                            .height = args.surface.height,
                            .device = device.traits().name,
                            .faceCount = loaded.surface.faces.size(),
                            .isolation = loaded.options.isolation,
                            .diagonal = summarize(loaded.cage).bounds.diagonal() / loaded.coordinates().unit,
                            .reach = loaded.height ? loaded.height->heightBound() : 0,
                            .coordinates = loaded.coordinates()};
    const std::optional<Picture> heatmap = checkPoints(device, model, loaded, args, certificate);
    progress.advance();
    // DESIGN: 4 % of a face opens any crack to some pixels.
    const double shift = 0.04 * std::sqrt(certificate.curvature.area / double(certificate.faceCount));
    PathChecker checker(device, model, loaded, args);
    for (const std::string& path : paths) {
        certificate.paths.push_back(checker.check(path, shift));
        progress.advance();
    }
    checkValidation(device);
    if (heatmap) writePicture(args.heatmap, *heatmap);
    return certificate;
}

int check(const CheckArgs& args) {
    if (!args.heatmap.empty()) {
        checkHeatmapPath(args.heatmap);
        checkOutput(args.heatmap, inputsOf(args.surface));
    }
    const Loaded loaded = load(args.surface, args.output);
    if (loaded.dense)
        fail(Failure::usage, "{}: certificates are for subdivision surfaces; name its --scheme", args.surface.cage);
    const Certificate certificate = certify(args, loaded);
    if (args.output.isJson)
        printJson(toJson(certificate));
    else if (!args.output.isQuiet)
        std::cout << toText(certificate);
    std::cout.flush(); // before the word on stderr
    const std::vector<std::string> broken = certificate.brokenPromises();
    if (!broken.empty()) fail(Failure::check, "{}: {}", args.surface.cage, fmt::join(broken, "; "));
    return 0;
}

} // namespace

Run addCheck(CLI::App& app) {
    auto args = std::make_shared<CheckArgs>();
    addSurface(app, args->surface);
    addTime(app, args->surface.pose);
    addPath(app, args->triangles.path, "all that the device has");
    addTriangles(app, args->triangles);
    app.add_option("--points", args->pointCount, "points that are compared with the reference, about (200000)")
        ->check(CLI::Range(1, 100'000'000))
        ->option_text("N");
    app.add_option("--heatmap", args->heatmap, "picture of where errors (orange) and folds (blue) are: .png or .exr")
        ->option_text("PICTURE");
    addDevice(app, args->device);
    addOutput(app, args->output);
    app.footer(
        "Ends with 6 when the triangles are not watertight or the frames not exact; folds and seams that disagree\n"
        "are told, and are the map's.\n"
        "examples:\n"
        "  relief check cage.obj --height map.exr --scale 0.2\n"
        "  relief check cage.obj --path dice --rate 16 --json\n"
        "  relief check cage.obj --height map.exr --heatmap wrong.png");
    return [args] { return check(*args); };
}

} // namespace relief::app
