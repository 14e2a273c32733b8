#include "geometry_image/geometry_image.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>

#include <nlohmann/json.hpp>

#include "app/bake_report.h"
#include "app/commands.h"
#include "app/object_options.h"
#include "app/options.h"
#include "app/output.h"
#include "app/picture_options.h"
#include "app/units.h"
#include "base/clock.h"
#include "base/files_together.h"

namespace relief::app {
namespace {

struct GeometryImageArgs {
    ObjectDesc object;
    std::string target, picture, device;
    int size = GeometryImageOptions().size;
    std::optional<int> rate;
    bool isHalf = false;
    std::optional<Distance> tolerance;
    Output output;
};

/// What is reported about an image. Lengths are in units of the positions.
struct GeometryImageFacts {
    GeometryImageReport spread;
    int size = 0;
    std::size_t vertices = 0, triangles = 0;
    std::vector<std::uint64_t> openEdges; ///< per mip
    std::uint64_t turnedCount = 0;        ///< triangles that look against the normals at their corners
    SurfaceDistance distance;             ///< from the image to the source, and back
    double unit = 1, diagonal = 1;        ///< of the source's box, in the world
    std::optional<double> tolerance;      ///< in the world
    double sourceSeconds = 0, spreadSeconds = 0, sampleSeconds = 0, measureSeconds = 0, writeSeconds = 0;
    std::uint64_t bytes = 0;

    /// The larger root mean square of both directions, in the world.
    [[nodiscard]] double rms() const { return unit * std::max(distance.forth.rms, distance.back.rms); }
    [[nodiscard]] bool passes() const { return !tolerance || rms() <= *tolerance; }
};

/// What an image is made of: the mesh that is spread, and a finer one of the same surface, which samples are points of
/// and which the image is measured against; empty where the mesh is all that there is.
struct Source {
    DenseMesh mesh, finer;

    [[nodiscard]] const DenseMesh& finest() const { return finer.indices.empty() ? mesh : finer; }
};

/// The rate at which a surface has so many triangles.
int chooseRate(double triangles, std::size_t faceCount) {
    const double perFace = triangles / double(std::max<std::size_t>(faceCount, 1));
    return int(std::clamp(std::ceil(std::sqrt(perFace / 2)), 1.0, 1024.0));
}

/// Spread are twice as many triangles as the image has quads, within what takes seconds; the surface itself is diced
/// into eight times as many, and into a million at most.
Source diceObject(const GeometryImageArgs& args, LoadedObject object, const Warn& warn) {
    Device device({.name = args.device});
    measureFunction(device, object, args.object.height, {{object.time}}, warn);
    SurfaceModel model = makeSurfaceModel(device, object);
    keepRestPose(device, model, object, args.object.height.space);
    const double wanted = std::clamp(2.0 * args.size * args.size, 2e4, 2e5);
    const std::size_t faceCount = object.cage.faceCount();
    const int rate = args.rate.value_or(chooseRate(wanted, faceCount));
    const int finerRate = chooseRate(std::min(8 * wanted, 1e6), faceCount);
    EdgeRater rater(device);
    Dicer dicer(device);
    const auto dice = [&](int segments) {
        const TriangleOptions triangles{.path = Path::dice, .rate = segments};
        DenseMesh mesh = dicer.diceToHost(model, rater.rates(model, triangles, {}), {.normal = triangles.normal});
        mesh.coordinates = object.coordinates();
        return mesh;
    };
    Source source{.mesh = dice(rate), .finer = {}};
    if (!args.rate && finerRate > rate) source.finer = dice(finerRate);
    checkValidation(device);
    return source;
}

/// Turns triangles of a file so that all are wound alike.
DenseMesh windSource(DenseMesh mesh, const std::string& path, const Warn& warn) {
    TriangleMesh triangles{.positions = mesh.positions, .indices = std::move(mesh.indices)};
    const SculptFaults faults = windAlike(triangles);
    if (faults.turnedCount > 0)
        warn(fmt::format("{}: {} of {} triangles were wound against those around them; they are turned over", path,
                         faults.turnedCount, triangles.indices.size() / 3));
    mesh.indices = std::move(triangles.indices);
    return mesh;
}

Source loadSource(const GeometryImageArgs& args, const Warn& warn) {
    const std::string& path = args.object.cage;
    if (isTriangleFile(path)) {
        const ObjectDesc& desc = args.object;
        if (desc.subdivision || !desc.height.path.empty() || !desc.height.function.empty() || desc.weld || desc.mip ||
            args.rate || !desc.motion.isStill())
            fail(Failure::usage,
                 "{}: the triangles of a file are taken as they are; what displaces, moves and divides "
                 "surfaces is for cages",
                 path);
        TriangleMesh read = readTriangles(path);
        return {windSource({.positions = std::move(read.positions),
                            .indices = std::move(read.indices),
                            .coordinates = read.coordinates},
                           path, warn),
                {}};
    }
    LoadedObject object = load(args.object, CageState::posed, warn);
    if (object.dense) return {windSource(std::move(*object.dense), path, warn), {}};
    return diceObject(args, std::move(object), warn);
}

/// The normals as colors: what the square shows.
void writeNormals(const std::string& path, const GeometryImage& image) {
    Image picture{.width = image.size, .height = image.size, .channels = 3, .texels = {}};
    for (const vec3& n : image.normals)
        for (int axis = 0; axis < 3; ++axis) picture.texels.push_back(0.5f + 0.5f * n[axis]);
    writeImage(path, picture, SampleType::uint8);
}

/// Measures the image, as a file will hold it, against the source, whose coordinates are those of `place`.
void measure(const GeometryImage& image, const MeasuredSurface& original, const Coordinates& place,
             GeometryImageFacts& facts) {
    for (int mip = 0; mip < image.mipCount(); ++mip) {
        const MeshFaults faults = findFaults(toMesh(image, mip).indices);
        RELIEF_CHECK(faults.otherEdges == 0u);
        facts.openEdges.push_back(faults.openEdges);
    }
    DenseMesh mesh = toMesh(image);
    facts.size = image.size, facts.vertices = mesh.positions.size(), facts.triangles = mesh.indices.size() / 3;
    facts.turnedCount = countTurned(mesh);
    for (vec3& p : mesh.positions) p = vec3(place.toLocal(image.coordinates.toWorld(dvec3(p))));
    facts.distance = measureDistance(MeasuredSurface({mesh.positions, mesh.indices}), original);
}

std::string toText(const GeometryImageArgs& args, const GeometryImageFacts& facts) {
    const GeometryImageReport& spread = facts.spread;
    const double percent = 100 * spread.cutLength * facts.unit / facts.diagonal;
    std::string text = fmt::format("{:<18} {} triangles, genus {}, {} boundaries\n", "source", spread.triangles,
                                   spread.genus, spread.boundaryCount);
    text += fmt::format("{:<18} {} paths, {:.4g} long ({:.0f} % of the diagonal)\n", "cut", spread.pathCount,
                        spread.cutLength * facts.unit, percent);
    text += fmt::format("{:<18} {:.3f} (L2; {:.3f} by mean value coordinates alone)\n", "stretch", spread.stretch,
                        spread.firstStretch);
    text += fmt::format("{:<18} {} x {}, {} mips, {}\n", "image", facts.size, facts.size, facts.openEdges.size(),
                        humanBytes(facts.bytes));
    text += fmt::format("{:<18} {} vertices, {} triangles, {} open edges{}\n", "sewn", facts.vertices, facts.triangles,
                        facts.openEdges.front(),
                        spread.boundaryCount == 0 ? " at every mip" : ", all of them on boundaries of the source");
    text += fmt::format("{:<18} {} triangles ({:.2f} %) look against the normals of their samples\n", "turned over",
                        facts.turnedCount, 100 * double(facts.turnedCount) / double(facts.triangles));
    text += describeDistance("image to source", facts.distance.forth, facts.unit, facts.diagonal);
    text += describeDistance("source to image", facts.distance.back, facts.unit, facts.diagonal);
    if (facts.tolerance)
        text += fmt::format("{:<18} RMS {:.4g}, tolerance {:.4g}\n", facts.passes() ? "PASS" : "FAIL", facts.rms(),
                            *facts.tolerance);
    if (args.output.isVerbose)
        text += fmt::format(
            "source {:.0f} ms, spreading {:.0f} ms, sampling {:.0f} ms, measuring {:.0f} ms, writing {:.0f} ms\n",
            1e3 * facts.sourceSeconds, 1e3 * facts.spreadSeconds, 1e3 * facts.sampleSeconds, 1e3 * facts.measureSeconds,
            1e3 * facts.writeSeconds);
    return text;
}

nlohmann::json toJson(const GeometryImageArgs& args, const GeometryImageFacts& facts) {
    // Programs read these names.
    nlohmann::json all{{"source", args.object.cage},
                       {"image", args.target},
                       {"source_triangles", facts.spread.triangles},
                       {"genus", facts.spread.genus},
                       {"boundaries", facts.spread.boundaryCount},
                       {"cut_paths", facts.spread.pathCount},
                       {"cut_length", facts.spread.cutLength * facts.unit},
                       {"stretch", facts.spread.stretch},
                       {"first_stretch", facts.spread.firstStretch},
                       {"size", facts.size},
                       {"mips", facts.openEdges.size()},
                       {"vertices", facts.vertices},
                       {"triangles", facts.triangles},
                       {"open_edges", facts.openEdges},
                       {"turned_triangles", facts.turnedCount},
                       {"bytes", facts.bytes},
                       {"diagonal", facts.diagonal},
                       {"image_to_source", distanceToJson(facts.distance.forth, facts.unit, facts.diagonal)},
                       {"source_to_image", distanceToJson(facts.distance.back, facts.unit, facts.diagonal)},
                       {"rms", facts.rms()},
                       {"passes", facts.passes()},
                       {"source_ms", 1e3 * facts.sourceSeconds},
                       {"spread_ms", 1e3 * facts.spreadSeconds},
                       {"sample_ms", 1e3 * facts.sampleSeconds},
                       {"measure_ms", 1e3 * facts.measureSeconds},
                       {"write_ms", 1e3 * facts.writeSeconds}};
    if (facts.tolerance) all["tolerance"] = *facts.tolerance;
    return all;
}

/// Calls a step and returns the seconds that it took.
template <typename Step>
double timed(const Step& step) {
    const double start = secondsNow();
    step();
    return secondsNow() - start;
}

int makeImage(const GeometryImageArgs& args) {
    if (lowerExtension(args.target) != ".exr")
        fail(Failure::usage, "{}: a geometry image is written as .exr", args.target);
    checkOutput(args.target, listFiles(args.object));
    if (!args.picture.empty()) {
        if (lowerExtension(args.picture) != ".png") fail(Failure::usage, "{}: --picture writes a .png", args.picture);
        checkOutput(args.picture, listFiles(args.object));
    }
    // The source.
    const Warn warn = makeWarn(args.output.isQuiet);
    GeometryImageFacts facts;
    Source source;
    facts.sourceSeconds = timed([&] { source = loadSource(args, warn); });
    const DenseMesh& finest = source.finest();
    facts.unit = finest.coordinates.unit;
    facts.diagonal = computeBounds(finest.positions).diagonal() * facts.unit;
    if (args.tolerance) facts.tolerance = args.tolerance->cageUnits(facts.diagonal);
    // The image, and how far it is from the source.
    std::optional<SpreadSurface> surface;
    facts.spreadSeconds = timed([&] {
        surface.emplace(source.mesh, args.object.cage,
                        GeometryImageOptions{.size = args.size, .progress = args.output.progress});
    });
    facts.spread = surface->report();
    const SampleType sample = args.isHalf ? SampleType::half : SampleType::real;
    const MeasuredSurface original({finest.positions, finest.indices});
    GeometryImage image;
    facts.sampleSeconds = timed([&] {
        SpreadSurface::Settle settle;
        if (&finest == &source.finer)
            settle = [&](dvec3& position, dvec3& normal) { moveToNearest(finest, original, position, normal); };
        image = surface->sample(args.size, settle);
    });
    surface.reset();
    facts.measureSeconds = timed([&] { measure(roundSamples(image, sample), original, finest.coordinates, facts); });
    facts.writeSeconds = timed([&] {
        FilesTogether files;
        writeGeometryImage(args.target, image, sample);
        if (!args.picture.empty()) writeNormals(args.picture, image);
        files.takePlaces();
    });
    facts.bytes = std::filesystem::file_size(args.target);
    if (args.output.isJson)
        printJson(toJson(args, facts));
    else if (!args.output.isQuiet)
        std::cout << toText(args, facts);
    std::cout.flush(); // before the line on stderr
    if (!facts.passes())
        fail(Failure::check, "{}: the image and {} are {:.4g} apart (RMS); the tolerance is {:.4g}", args.target,
             args.object.cage, facts.rms(), *facts.tolerance);
    return 0;
}

} // namespace

Run addGeometryImage(CLI::App& app) {
    auto args = std::make_shared<GeometryImageArgs>();
    addObject(app, args->object);
    app.get_option("cage")->description("the surface: a mesh (.ply .stl), or a cage or mesh (.obj .gltf .glb)");
    addTime(app, args->object.motion);
    const char* group = "geometry image";
    app.add_option("-o,--output", args->target, "image to write: .exr")->required()->option_text("IMAGE");
    listIn(
        group, "N",
        app.add_option("--size", args->size, "samples per side; those of the form 2^k m + 1 have mips (default: 257)")
            ->check(CLI::Range(17, kLargestGeometryImage)));
    listIn(group, "N",
           app.add_option("--rate", args->rate,
                          "segments per edge that a cage is diced with before it is spread, and of what is measured "
                          "(default: twice as many triangles as the image has samples, 20,000 to 200,000; samples are "
                          "then points of a dicing into eight times as many)")
               ->check(CLI::Range(1, 1024)));
    listIn(group, "", app.add_flag("--half", args->isHalf, "16-bit floats, relative to the box around the surface"));
    listIn(group, "D",
           app.add_option_function<std::string>(
                  "--tolerance",
                  [args = args.get()](const std::string& word) { args->tolerance = parseDistance(word); },
                  "largest RMS distance between image and surface, either way: cage units, or a percentage of the "
                  "diagonal; exit code 6 where it is larger")
               ->check(distanceFromZero()));
    listIn(
        group, "PICTURE",
        app.add_option("--picture", args->picture, "picture to write of the normals over the square, as colors: .png"));
    addDevice(app, args->device);
    addOutput(app, args->output);
    app.footer(
        "The surface is cut open to a disk and spread over a square; the image holds its points and normals, and\n"
        "how its border is sewn. render, animate, view and export read it, info describes it.\n"
        "examples:\n"
        "  relief geometry-image bunny.ply -o bunny.exr --size 513\n"
        "  relief geometry-image cage.obj --height map.exr --rate 32 -o gi.exr\n"
        "  relief render gi.exr -o picture.png\n"
        "  relief export gi.exr --mip 2 -o coarse.ply");
    return [args] { return makeImage(*args); };
}

} // namespace relief::app
