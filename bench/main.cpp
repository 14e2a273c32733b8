// relief_bench, for developers: what splitting draws is worth on this device; the dicer next to other evaluators.
// Absolute times are noise between runs: quote the ratios. Everything else is `relief bench`.
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
using bench::median;

constexpr int kRounds = 7;
constexpr std::uint64_t kTriangles = 1'000'000;

/// The production cage where it is at hand (RELIEF_DATA), else the project's own torus.
std::string cagePath() {
    const char* data = std::getenv("RELIEF_DATA");
    const std::string folder = data != nullptr ? data : RELIEF_SOURCE "/../shared/data";
    const std::string production = folder + "/bigguy.obj";
    return std::filesystem::exists(production) ? production : RELIEF_SOURCE "/meshes/torus.obj";
}

/// Smooth bumps of a few texels' width, half a percent of the cage high.
HeightMap bumps(int side, double amplitude) {
    std::vector<float> texels(std::size_t(side) * side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            texels[std::size_t(y) * side + x] =
                float(std::sin(x * 64 * 6.2831853 / side) * std::sin(y * 64 * 6.2831853 / side));
    return makeHeightMap(side, side, std::move(texels), 0, amplitude, Wrap::repeat);
}

/// Cage, map, surface and camera that all cases share.
struct Subject {
    std::string path = cagePath();
    Cage cage = readCage(path);
    Surface surface = buildSurface(cage, {});
    ReferenceSurface reference{cage, {.isolation = 3}};
    Bounds bounds;
    HeightMap map;
    RenderOptions options;
    int rate = 1;

    Subject() {
        for (const vec3& p : cage.positions) bounds.add(dvec3(p));
        map = bumps(2048, 0.002 * bounds.diagonal());
        const std::vector<dvec3> points = outline(reference, &map);
        options.camera = frameCamera(points, {}, 1);
        options.bounds = bounds;
        options.lighting.castsShadows = false;
        rate = int(std::lround(std::sqrt(double(kTriangles) / (2.0 * double(surface.faces.size())))));
        options.rate = rate;
    }
};

/// One contestant of `dice`: what it makes, how much of it, and how long that takes.
struct Contestant {
    std::string name, what;
    std::size_t count = 0;
    std::vector<double> rounds; ///< milliseconds

    [[nodiscard]] double rate() const { return double(count) / median(rounds) / 1e3; } ///< million a second
};

/// Dices one model each round; of the same mesh, the vertices alone and with the triangles between them.
class DiceContest {
public:
    DiceContest(Device& device, const SurfaceModel& model, const EdgeRates& rates, NormalKind normal, const std::string& what)
        : dicer_(device), model_(model), rates_(rates),
          normal_(normal), vertices_{"relief dicer, vertices", what, 0, {}}, mesh_{"relief dicer, with triangles",
                                                                                   what,
                                                                                   0,
                                                                                   {}} {}

    /// The first round compiles shaders: it does not count.
    void run() {
        const DicedMesh mesh = dicer_.dice(model_, rates_, {.normal = normal_, .timesVertices = true});
        vertices_.count = mesh_.count = mesh.vertexCount;
        if (isWarm_) {
            vertices_.rounds.push_back(mesh.vertexMilliseconds);
            mesh_.rounds.push_back(mesh.milliseconds);
        }
        isWarm_ = true;
    }
    [[nodiscard]] const Contestant& vertices() const { return vertices_; }
    [[nodiscard]] const Contestant& mesh() const { return mesh_; }

private:
    Dicer dicer_;
    const SurfaceModel& model_;
    const EdgeRates& rates_;
    NormalKind normal_;
    Contestant vertices_, mesh_;
    bool isWarm_ = false;
};

/// The evaluators of others beside `dice`, or none where they are not built in.
std::vector<Contestant> timeOpponents(const Subject& subject, int isolation, const std::function<void()>& dice) {
    std::vector<Contestant> opponents;
#ifdef RELIEF_EVALUATORS
    const std::vector<bench::PatchPoint> points = bench::gridPoints(subject.cage, subject.rate);
    for (const bench::EvaluatorTime& time : bench::timeEvaluators(subject.cage, isolation, points, dice))
        opponents.push_back(
            {time.name,
             fmt::format("p, p_u, p_v; off by {:.0e}, {:.0e} in end caps", time.pointError, time.endCapError),
             points.size(), time.rounds});
#else
    (void)subject, (void)isolation;
    std::cout << "dice: relief_bench was built without Embree or OpenMP: there are no opponents\n";
    for (int round = 0; round <= kRounds; ++round) dice();
#endif
    return opponents;
}

/// Ratios are to the fastest of `opponents`.
void print(const std::vector<Contestant>& own, const std::vector<Contestant>& opponents) {
    double fastest = 0;
    for (const Contestant& c : opponents) fastest = std::max(fastest, c.rate());
    for (const std::vector<Contestant>* all : {&own, &opponents})
        for (const Contestant& c : *all)
            std::cout << fmt::format("{:28} {:8} points {:7.1f} ms (least {:6.1f}) {:6.2f} M/s {:>8}  {}\n", c.name,
                                     c.count, median(c.rounds), *std::ranges::min_element(c.rounds), c.rate(),
                                     fastest > 0 ? fmt::format("{:.2f} x", c.rate() / fastest) : "", c.what);
}

/// Displaced vertices per second of the dicer, next to the evaluators of others on the processor.
int benchDice() {
    constexpr int kIsolation = 3; // of all of them: depth of the patch tables at extraordinary vertices
    Subject subject;
    const Surface surface = buildSurface(subject.cage, {.isolation = kIsolation});
    Device device;
    const SurfaceModel displaced(device,
                          {.surface = &surface, .cagePositions = subject.cage.positions, .height = &subject.map});
    const SurfaceModel smooth(device, {.surface = &surface, .cagePositions = subject.cage.positions});
    EdgeRater rater(device);
    const EdgeRates rates = rater.rates(displaced, subject.options, {});
    std::cout << fmt::format(
        "dice: {} at rate {}, isolation {}, on {}; others: {} threads\n"
        "Others evaluate limit points and first derivatives of (rate + 1)^2 points a face, into arrays that wait for\n"
        "them. The dicer evaluates each distinct point once, with first and second derivatives and the height with "
        "its\n"
        "central differences, and writes displaced points and normals into a new buffer; then the triangles.\n",
        subject.path, subject.rate, kIsolation, device.traits().name, std::thread::hardware_concurrency());
    DiceContest full(device, displaced, rates, NormalKind::full, "full normals, heights");
    DiceContest first(device, displaced, rates, NormalKind::firstOrder, "first-order normals, heights");
    DiceContest limit(device, smooth, rates, NormalKind::limit, "limit normals, no heights: what the others do");
    const std::vector<Contestant> opponents = timeOpponents(subject, kIsolation, [&] {
        for (DiceContest* contest : {&full, &first, &limit}) contest->run();
    });
    std::vector<Contestant> own;
    for (const DiceContest* contest : {&full, &first, &limit})
        own.insert(own.end(), {contest->vertices(), contest->mesh()});
    print(own, opponents);
    return 0;
}

/// Tessellated vertices in one draw against time: where DeviceTraits::tessellatedVerticesPerDraw comes from.
int benchSplit() {
    Subject subject;
    subject.options.rate = std::min(subject.rate, 12);
    Device device;
    if (!device.traits().hasTessellation) {
        std::cout << "split: " << device.traits().name << " has no tessellation shaders\n";
        return 0;
    }
    const SurfaceModel model(device,
                      {.surface = &subject.surface, .cagePositions = subject.cage.positions, .height = &subject.map});
    for (const std::uint32_t limit : {1'000u, 2'500u, 5'000u, 10'000u, 20'000u, 40'000u, 80'000u}) {
        RenderOptions options = subject.options;
        options.tessellatedVerticesPerDraw = limit;
        Renderer renderer(device, {});
        std::vector<double> times;
        for (int round = 0; round < 4; ++round) times.push_back(renderer.render(model, options).stats.colorMs);
        times.erase(times.begin());
        std::cout << fmt::format("split: {:6} vertices a draw: {:8.1f} ms\n", limit, median(times));
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
        if (runs("dice")) benchDice();
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
