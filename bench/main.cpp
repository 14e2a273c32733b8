// relief_bench, for developers: the dicer and the poser beside evaluators of other projects, and draws split by
// vertices. Absolute times vary between runs: quote ratios within one run. (What users measure is `relief bench`:
// src/measure.)
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <iostream>
#include <thread>

#include "frame/frame.h"
#include "timing.h"
#ifdef RELIEF_EVALUATORS
#include "evaluators.h"
#include "posing.h"
#endif

namespace {

using namespace relief;
using bench::computeMedian;

constexpr int kRounds = 7;
constexpr std::uint64_t kTriangles = 1'000'000;

/// The production cage in the folder RELIEF_DATA where it is there, else the project's own torus.
std::string findCage() {
    const char* data = std::getenv("RELIEF_DATA");
    const std::string folder = data != nullptr ? data : RELIEF_SOURCE "/../shared/data";
    const std::string production = folder + "/bigguy.obj";
    return std::filesystem::exists(production) ? production : RELIEF_SOURCE "/meshes/torus.obj";
}

/// A square map of 64 x 64 smooth bumps; `amplitude` in cage units.
HeightMap makeBumps(int side, double amplitude) {
    std::vector<float> texels(std::size_t(side) * side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            texels[std::size_t(y) * side + x] =
                float(std::sin(x * 64 * 6.2831853 / side) * std::sin(y * 64 * 6.2831853 / side));
    return makeHeightMap(side, side, std::move(texels), 0, amplitude, Wrap::repeat);
}

/// The cage, map, surface and camera of all comparisons, at a rate of a million triangles.
struct TestSurface {
    std::string path = findCage();
    Cage cage = readCage(path);
    Surface surface = buildSurface(cage, {});
    ReferenceSurface reference{cage, {.isolation = 3}};
    Bounds bounds;
    HeightMap map;
    RenderOptions options;
    int rate = 1;

    TestSurface() {
        for (const vec3& p : cage.positions) bounds.add(dvec3(p));
        map = makeBumps(2048, 0.002 * bounds.diagonal());
        const std::vector<dvec3> points = outline(reference, &map);
        options.camera = frameCamera(points, {}, 1);
        options.bounds = bounds;
        options.lighting.castsShadows = false;
        rate = int(std::lround(std::sqrt(double(kTriangles) / (2.0 * double(surface.faces.size())))));
        options.rate = rate;
    }
};

/// One line of `dice`: an evaluator, and how long it takes for how many points.
struct Timing {
    std::string name, what;
    std::size_t count = 0;      ///< points
    std::vector<double> rounds; ///< milliseconds

    [[nodiscard]] double pointsPerSecond() const { return double(count) / computeMedian(rounds) / 1e3; } ///< millions
};

/// Dices one model per round, and times its vertices alone and the whole mesh.
class TimedDicing {
public:
    TimedDicing(Device& device, const SurfaceModel& model, const EdgeRates& rates, NormalKind normal,
                const std::string& what)
        : dicer_(device), model_(model), rates_(rates),
          normal_(normal), vertices_{"relief dicer, vertices", what, 0, {}}, mesh_{"relief dicer, with triangles",
                                                                                   what,
                                                                                   0,
                                                                                   {}} {}

    /// One round. The first one compiles shaders and is not counted.
    void run() {
        const DicedMesh mesh = dicer_.dice(model_, rates_, {.normal = normal_, .timesVertices = true});
        vertices_.count = mesh_.count = mesh.vertexCount;
        if (isWarm_) {
            vertices_.rounds.push_back(mesh.vertexMilliseconds);
            mesh_.rounds.push_back(mesh.milliseconds);
        }
        isWarm_ = true;
    }
    [[nodiscard]] const Timing& vertices() const { return vertices_; }
    [[nodiscard]] const Timing& mesh() const { return mesh_; }

private:
    Dicer dicer_;
    const SurfaceModel& model_;
    const EdgeRates& rates_;
    NormalKind normal_;
    Timing vertices_, mesh_;
    bool isWarm_ = false;
};

/// Times other evaluators in rounds interleaved with `dice`; none where they are not built in.
std::vector<Timing> timeEvaluators(const TestSurface& test, int isolation, const std::function<void()>& dice) {
    std::vector<Timing> otherTimings;
#ifdef RELIEF_EVALUATORS
    const std::vector<bench::PatchPoint> points = bench::makeGridPoints(test.cage, test.rate);
    for (const bench::EvaluatorTime& time : bench::timeEvaluators(test.cage, isolation, points, dice))
        otherTimings.push_back(
            {time.name,
             fmt::format("p, p_u, p_v; errors {:.0e}, {:.0e} in end caps", time.pointError, time.endCapError),
             points.size(), time.rounds});
#else
    (void)test, (void)isolation;
    std::cout << "dice: relief_bench was built without Embree or OpenMP: there is nothing to compare with\n";
    for (int round = 0; round <= kRounds; ++round) dice();
#endif
    return otherTimings;
}

/// Prints a line per evaluator, with its speed relative to the fastest of `otherTimings`.
void printTimings(const std::vector<Timing>& own, const std::vector<Timing>& otherTimings) {
    double fastest = 0; // million points per second
    for (const Timing& c : otherTimings) fastest = std::max(fastest, c.pointsPerSecond());
    for (const std::vector<Timing>* all : {&own, &otherTimings})
        for (const Timing& c : *all)
            std::cout << fmt::format("{:28} {:8} points {:7.1f} ms (min {:6.1f}) {:6.2f} M/s {:>8}  {}\n", c.name,
                                     c.count, computeMedian(c.rounds), *std::ranges::min_element(c.rounds),
                                     c.pointsPerSecond(),
                                     fastest > 0 ? fmt::format("{:.2f} x", c.pointsPerSecond() / fastest) : "", c.what);
}

/// Compares the displaced vertices per second of the dicer with evaluators of other projects on the processor.
int benchDice() {
    constexpr int kIsolation = 3; // of all evaluators: depth of the refinement around extraordinary vertices
    TestSurface test;
    const Surface surface = buildSurface(test.cage, {.isolation = kIsolation});
    // Displaced as relief draws it, and smooth as the others evaluate it.
    Device device;
    const SurfaceModel displaced(device,
                                 {.surface = &surface, .cagePositions = test.cage.positions, .height = &test.map});
    const SurfaceModel smooth(device, {.surface = &surface, .cagePositions = test.cage.positions});
    EdgeRater rater(device);
    const EdgeRates rates = rater.rates(displaced, test.options, {});
    std::cout << fmt::format(
        "dice: {} at rate {}, isolation {}, on {}; others: {} threads\n"
        "The others evaluate limit points and first derivatives at (rate + 1)^2 points per face, into arrays that are\n"
        "allocated before. The dicer evaluates each distinct point once, with first and second derivatives, the "
        "height\n"
        "and its central differences, and writes displaced points and normals into a new buffer, then triangles.\n",
        test.path, test.rate, kIsolation, device.traits().name, std::thread::hardware_concurrency());
    TimedDicing full(device, displaced, rates, NormalKind::full, "full normals, heights");
    TimedDicing first(device, displaced, rates, NormalKind::firstOrder, "first-order normals, heights");
    TimedDicing limit(device, smooth, rates, NormalKind::limit, "limit normals, no heights, as the others");
    const std::vector<Timing> otherTimings = timeEvaluators(test, kIsolation, [&] {
        for (TimedDicing* dicing : {&full, &first, &limit}) dicing->run();
    });
    // Vertices and mesh of each, then the others.
    std::vector<Timing> own;
    for (const TimedDicing* dicing : {&full, &first, &limit})
        own.insert(own.end(), {dicing->vertices(), dicing->mesh()});
    printTimings(own, otherTimings);
    return 0;
}

/// The map cut into four tiles, over texture coordinates that are twice as large.
HeightMap cutIntoTiles(const HeightMap& map) {
    const int side = map.width / 2;
    std::vector<HeightMap> tiles;
    std::vector<ivec2> places;
    for (int k = 0; k < 4; ++k) {
        std::vector<float> texels;
        for (int y = 0; y < side; ++y) {
            const auto row = map.texels.begin() + std::ptrdiff_t((k / 2) * side + y) * map.width + (k % 2) * side;
            texels.insert(texels.end(), row, row + side);
        }
        tiles.push_back(makeHeightMap(side, side, std::move(texels), map.mid, map.scale, Wrap::clamp));
        places.emplace_back(k % 2, 1 - k / 2);
    }
    return makeTileSet(tiles, places);
}

/// The heights of a map along the normal, and half of them along T and B.
HeightMap makeVectors(const HeightMap& heights) {
    std::array<HeightMap, 3> components{heights, heights, heights};
    scaleHeights(components[0], 0.5), scaleHeights(components[1], 0.5);
    return joinComponents(components, VectorSpace::tangent, MapFormat::real);
}

/// Compares the ways to look heights up, at a rate that divides the nodes of a map per face: the same heights, and
/// tiles of as many bytes as the one map. Beside them vectors, and the surface without any map: no way of lookup is
/// faster than none.
int benchMaps() {
    constexpr int kLog = 5; // of the segments of a face, and of the rate
    TestSurface test;
    if (!test.cage.hasTexCoords()) {
        std::cout << fmt::format("maps: {} has no texture coordinates\n", test.path);
        return 0;
    }
    Cage tiled = test.cage;
    for (vec2& st : tiled.texCoords) st *= 2.0f;
    const Surface surface = buildSurface(test.cage, {.isolation = 3}),
                  tiledSurface = buildSurface(tiled, {.isolation = 3});
    const HeightMap faces = toFaceMap(test.map, {}, surface, test.reference, 1 << kLog);
    const HeightMap tiles = cutIntoTiles(test.map), vectors = makeVectors(test.map), vectorTiles = makeVectors(tiles);
    Device device;
    const auto modelOf = [&](const Surface& of, const HeightMap* map) {
        return SurfaceModel(device, {.surface = &of, .cagePositions = test.cage.positions, .height = map});
    };
    const SurfaceModel byTexture = modelOf(surface, &test.map), byTile = modelOf(tiledSurface, &tiles),
                       byFace = modelOf(surface, &faces), byVector = modelOf(surface, &vectors),
                       byVectorTile = modelOf(tiledSurface, &vectorTiles), bare = modelOf(surface, nullptr);
    EdgeRater rater(device);
    test.options.rate = 1 << kLog;
    const EdgeRates rates = rater.rates(byFace, test.options, {});

    // In turns, and the first of each is the reference of the speeds.
    TimedDicing texture(device, byTexture, rates, NormalKind::full, "one map over texture coordinates"),
        tile(device, byTile, rates, NormalKind::full, "four tiles of the same bytes"),
        face(device, byFace, rates, NormalKind::full, "a map per face, on its nodes"),
        none(device, bare, rates, NormalKind::limit, "no map, limit normals"),
        vector(device, byVector, rates, NormalKind::full, "vectors over texture coordinates"),
        vectorTile(device, byVectorTile, rates, NormalKind::full, "four tiles of vectors");
    for (int round = 0; round <= kRounds; ++round)
        for (TimedDicing* dicing : {&texture, &tile, &face, &none, &vector, &vectorTile}) dicing->run();
    std::cout << fmt::format("maps: {} at rate {} on {}\n", test.path, 1 << kLog, device.traits().name);
    printTimings({tile.vertices(), face.vertices(), none.vertices()}, {texture.vertices()});
    printTimings({vectorTile.vertices()}, {vector.vertices()});
    return 0;
}

/// Prints the time of a frame against the tessellated vertices per draw: DeviceTraits::tessellatedVerticesPerDraw comes
/// from here.
int benchSplit() {
    TestSurface test;
    test.options.rate = std::min(test.rate, 12);
    Device device;
    if (!device.traits().hasTessellation) {
        std::cout << "split: " << device.traits().name << " has no tessellation shaders\n";
        return 0;
    }
    const SurfaceModel model(device,
                             {.surface = &test.surface, .cagePositions = test.cage.positions, .height = &test.map});
    for (const std::uint32_t limit : {1'000u, 2'500u, 5'000u, 10'000u, 20'000u, 40'000u, 80'000u}) {
        RenderOptions options = test.options;
        options.tessellatedVerticesPerDraw = limit;
        Renderer renderer(device, {});
        std::vector<double> times;
        for (int round = 0; round < 4; ++round) times.push_back(renderer.render(model, options).stats.colorMs);
        times.erase(times.begin());
        std::cout << fmt::format("split: {:6} vertices per draw: {:8.1f} ms\n", limit, computeMedian(times));
    }
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    try {
        const std::vector<std::string> wanted(argv + 1, argv + argc);
        const auto runs = [&](const char* name) {
            return wanted.empty() || std::ranges::find(wanted, name) != wanted.end();
        };
        if (runs("dice")) benchMaps(), benchDice();
#ifdef RELIEF_EVALUATORS
        if (runs("posing")) bench::benchPosing();
#endif
        if (runs("split")) benchSplit();
        return 0;
    } catch (const relief::Error& error) {
        std::cerr << "relief_bench: " << error.what() << '\n';
        return int(error.failure);
    }
}
