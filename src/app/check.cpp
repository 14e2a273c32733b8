#include <cmath>
#include <iostream>

#include "app/commands.h"
#include "app/heatmap.h"
#include "app/object_options.h"
#include "app/output.h"
#include "app/picture_options.h"

namespace relief::app {
namespace {

struct CheckArgs {
    ObjectDesc object;
    TriangleArgs triangles;
    Output output;
    const CLI::Option* edgePixels = nullptr; ///< of the command line: whether triangles.options.edgePixels was given
    std::size_t pointCount = 200'000;
    std::string heatmap, device;
};

constexpr std::size_t kPointsAtOnce = 1u << 18; // keeps the device's buffers below 40 MB
constexpr int kPictureSide = 1024;              // pixels of the views, by which --edge-pixels are measured

/// Azimuth and elevation: along the axes, from both sides.
constexpr double kViews[][2] = {{0, 0}, {90, 0}, {180, 0}, {270, 0}, {0, 90}, {0, -90}};

// --- triangles

std::vector<Path> choosePaths(const CheckArgs& args, const DeviceTraits& traits) {
    return args.triangles.path ? std::vector{*args.triangles.path} : listCapturablePaths(traits);
}

/// Certifies the triangles of one path after another.
class PathChecker {
public:
    PathChecker(Device& device, const SurfaceModel& model, const LoadedObject& object, const CheckArgs& args)
        : model_(model), args_(args), rater_(device), capturer_(device),
          renderer_(device, {.width = kPictureSide, .height = kPictureSide, .shadowSide = 1}),
          canSeeCracks_(enclosesVolume(object.surface)), points_(computeOutline(object)) {}

    /// Where no rate was given: makes segments longer until each path makes at most kMostCheckedTriangles. A face has
    /// as many segments each way as its longest side, so that faces of poles, long and thin, have hundreds of times too
    /// many. Returns their length in pixels where it had to.
    std::optional<double> limitTriangles(TriangleOptions& options, const std::vector<Path>& paths, const Warn& warn) {
        if (options.rate || args_.edgePixels->count() > 0) return {};
        const double pixels = options.edgePixels;
        std::uint64_t first = 0; // with the length of before
        const auto planned = [&](double length) {
            std::uint64_t most = 0;
            TriangleOptions each = options;
            each.edgePixels = length;
            for (const Path path : paths) {
                each.path = path;
                most = std::max(most, plannedTriangles(model_, path, ratesOf(each)));
            }
            if (length == pixels) first = most;
            return most;
        };
        options.edgePixels = limitEdgePixels(pixels, kPictureSide, planned);
        if (options.edgePixels == pixels) return {};
        warn(fmt::format("checked with --edge-pixels {}: segments of {} pixels would make {} triangles",
                         options.edgePixels, pixels, first));
        return options.edgePixels;
    }

    /// `shift`: how far the crack pictures move every other vertex, cage units.
    PathReport check(const TriangleOptions& triangles, double shift) {
        RenderOptions options{triangles};
        const Path path = options.path;
        options.lighting.castsShadows = false;
        options.bounds = computeBounds(points_);
        PathReport report{.path = wordOf(kPaths, path), .triangles = checkTriangles(options)};
        if (canSeeCracks_) report.crackPixels = countCrackPixels(options, shift);
        return report;
    }

private:
    EdgeRates ratesOf(const TriangleOptions& options) {
        return rater_.rates(model_, options, viewOf(frameCamera(points_, {}, 1), kPictureSide));
    }

    Watertightness checkTriangles(const TriangleOptions& options) {
        const EdgeRates rates = ratesOf(options);
        return checkWatertight(capturer_.capture(model_, options, rates), boundarySegments(model_, rates),
                               plannedTriangles(model_, options.path, rates));
    }

    std::uint64_t countCrackPixels(RenderOptions options, double shift) {
        const dvec3 direction = glm::normalize(dvec3(3, 4, 5)); // no view looks along it
        std::uint64_t count = 0;
        for (const auto& [azimuth, elevation] : kViews) {
            options.camera = frameCamera(points_, {.azimuth = azimuth, .elevation = elevation}, 1);
            count += renderer_.crackPixels(model_, options, vec3(shift * direction));
        }
        return count;
    }

    const SurfaceModel& model_;
    const CheckArgs& args_;
    EdgeRater rater_;
    Capturer capturer_;
    Renderer renderer_;
    bool canSeeCracks_;
    std::vector<dvec3> points_;
};

// --- points

std::vector<SampleResult> sampleDevice(Device& device, const SurfaceModel& model, std::span<const SampleQuery> queries,
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

/// Fills in frames, curvature, corners and seams from what the device evaluates; returns the heat map if one is asked
/// for.
std::optional<Picture> checkPoints(Device& device, const SurfaceModel& model, const LoadedObject& object,
                                   const CheckArgs& args, Certificate& certificate) {
    // Points all over the surface against the reference.
    const SurfaceSamples samples = sampleEverywhere(object.surface, args.pointCount);
    const NormalKind normal = args.triangles.options.normal;
    const std::vector<SampleResult> results = sampleDevice(device, model, samples.queries, normal);
    const ReferenceSurface reference(object.cage, object.options);
    std::optional<ReferenceSurface> rest;
    std::optional<FunctionReference> function;
    std::vector<FaceHeight> heights;
    if (object.function) {
        rest.emplace(object.cage, object.options);
        if (!object.restPositions.empty()) rest->pose(object.restPositions);
        function.emplace(device, *object.function, *rest, object.time);
        heights = function->heights(samples.queries);
    }
    const std::vector<SampleError> errors =
        sampleErrors({&reference, object.heightMap(), normal, certificate.diagonal, heights}, samples.queries, results);
    certificate.frames = summarizeErrors(samples.queries, errors);
    const bool hasVectors = object.height && object.height->vectors;
    certificate.curvature = hasVectors ? reportFolds(samples, results, errors) : reportCurvature(samples, results);

    // Where derivatives vanish, and where the map may disagree with itself.
    const std::vector<SampleQuery> corners = cornersOf(object.surface);
    certificate.corners = reportCorners(reference, corners, sampleDevice(device, model, corners, normal));
    if (function) certificate.seams = reportSeams(object.surface, *rest, *function);
    if (object.height) certificate.seams = reportSeams(object.surface, reference, *object.height);

    if (args.heatmap.empty()) return {};
    const Heat heat{samples, results, errors};
    return drawHeatmap(device, heatMesh(heat, object.surface.sideCount));
}

// --- the command

/// The heat map is written last, when nothing else has failed.
Certificate certify(const CheckArgs& args, LoadedObject& object) {
    Device device({.name = args.device});
    measureFunction(device, object, args.object.height, {{object.time}}, makeWarn(args.output.isQuiet));
    SurfaceModel model = makeSurfaceModel(device, object);
    keepRestPose(device, model, object, HeightSpace::absolute);
    const std::vector<Path> paths = choosePaths(args, device.traits());
    Progress progress("checking", 1 + paths.size(), args.output.progress);

    Certificate certificate{.cage = args.object.cage,
                            .height = object.function ? args.object.height.function : args.object.height.path,
                            .device = device.traits().name,
                            .faceCount = object.surface.faces.size(),
                            .isolation = object.options.isolation,
                            .diagonal = summarize(object.cage).bounds.diagonal() / object.coordinates().unit,
                            .displacementBound = object.function ? double(object.function->bound)
                                                 : object.height ? object.height->heightBound()
                                                                 : 0,
                            .coordinates = object.coordinates()};
    // Points of the surface against the reference, then the triangles of each path.
    const std::optional<Picture> heatmap = checkPoints(device, model, object, args, certificate);
    progress.advance();

    // Moving vertices by 4 % of a face's side opens any crack to a width of some pixels.
    const double shift = 0.04 * std::sqrt(certificate.curvature.area / double(certificate.faceCount));
    PathChecker checker(device, model, object, args);
    TriangleOptions triangles = args.triangles.options;
    certificate.limitedEdgePixels = checker.limitTriangles(triangles, paths, makeWarn(args.output.isQuiet));
    for (const Path path : paths) {
        triangles.path = path;
        certificate.paths.push_back(checker.check(triangles, shift));
        progress.advance();
    }
    checkValidation(device);
    if (heatmap) writePicture(args.heatmap, *heatmap);
    return certificate;
}

int check(const CheckArgs& args) {
    if (!args.heatmap.empty()) {
        checkHeatmapPath(args.heatmap);
        checkOutput(args.heatmap, listFiles(args.object));
    }
    LoadedObject object = load(args.object, CageState::posed, makeWarn(args.output.isQuiet));
    if (object.dense)
        fail(Failure::usage, "{}: certificates are for subdivision surfaces; name its --scheme", args.object.cage);
    const Certificate certificate = certify(args, object);
    if (args.output.isJson)
        printJson(toJson(certificate));
    else if (!args.output.isQuiet)
        std::cout << toText(certificate);
    std::cout.flush(); // before the line on stderr
    const std::vector<std::string> broken = certificate.brokenPromises();
    if (!broken.empty()) fail(Failure::check, "{}: {}", args.object.cage, fmt::join(broken, "; "));
    return 0;
}

} // namespace

Run addCheck(CLI::App& app) {
    // What is certified.
    auto args = std::make_shared<CheckArgs>();
    addObject(app, args->object);
    addTime(app, args->object.motion);
    addPath(app, args->triangles.path, "all that the device can read back");
    addTriangles(app, args->triangles.options);
    args->edgePixels = app.get_option("--edge-pixels");
    // How closely, and where results go.
    app.add_option("--points", args->pointCount,
                   fmt::format("about how many points are compared with the double-precision reference (default: {})",
                               args->pointCount))
        ->check(CLI::Range(1, 100'000'000))
        ->option_text("N");
    app.add_option("--heatmap", args->heatmap,
                   "picture to write of where errors (orange) and folds (blue) are: .png or .exr")
        ->option_text("PICTURE");
    addDevice(app, args->device);
    addOutput(app, args->output);
    app.footer(
        "Ends with exit code 6 when the triangles are not watertight or points and tangents are not exact. Folds, and\n"
        "heights that differ along the seams of the texture, come from the map: they are reported and change no code.\n"
        "Without --rate and --edge-pixels segments are longer than 2 pixels where those would make more than\n"
        "2 million triangles, as long thin faces do; \"limited_edge_pixels\" of --json is their length then.\n"
        "examples:\n"
        "  relief check cage.obj --height map.exr --scale 0.2\n"
        "  relief check cage.obj --path dice --rate 16 --json\n"
        "  relief check cage.obj --height map.exr --heatmap wrong.png");
    return [args] { return check(*args); };
}

} // namespace relief::app
