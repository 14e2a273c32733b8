// relief_bench: the same displaced triangles drawn by each path and as a static dense mesh, in one run; what splitting
// draws is worth on this device; what a cold start costs; what other evaluators take on the processor. Absolute times
// are noise between runs: quote the ratios.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <thread>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "frame/frame.h"
#include "timing.h"
#ifdef RELIEF_EVALUATORS
#include "evaluators.h"
#endif

namespace {

using namespace relief;
using bench::median;
using bench::millisecondsOf;

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

struct Series {
    const char* name;
    const Model* model;
    Path path;
    std::vector<double> device, wall, dice;
    std::uint64_t triangles = 0;
};

/// Interleaved rounds, so that a slow spell of the machine hits all alike.
void measure(Renderer& renderer, const RenderOptions& base, std::vector<Series>& all) {
    for (int round = 0; round <= kRounds; ++round)
        for (Series& series : all) {
            RenderOptions options = base;
            options.path = series.path;
            const Picture picture = renderer.render(*series.model, options);
            if (round == 0) continue; // compiles the shaders
            series.device.push_back(picture.stats.diceMs + picture.stats.colorMs);
            series.dice.push_back(picture.stats.diceMs);
            series.wall.push_back(picture.stats.wallMs);
            series.triangles = picture.stats.triangleCount;
        }
}

void print(const std::vector<Series>& all) {
    const Series& base = all.back();
    for (const Series& series : all)
        std::cout << fmt::format(
            "{:28} {:9} triangles  color pass {:8.1f} ms  {:5.2f} x   frame {:8.1f} ms  {:5.2f} x   dicing {:6.1f} ms\n", series.name,
            series.triangles, median(series.device), median(series.device) / median(base.device), median(series.wall),
            median(series.wall) / median(base.wall), median(series.dice));
}

int benchFrame() {
    Subject subject;
    Device device;
    const Model displaced(
        device, {.surface = &subject.surface, .cagePositions = subject.cage.positions, .height = &subject.map});
    const DenseMesh mesh = denseMesh(subject.reference, &subject.map, subject.rate);
    const Model dense(device, {.dense = &mesh});
    Renderer renderer(device, {});
    std::cout << fmt::format("frame: {} at rate {}, 1024 x 1024, 4 samples, full normals, {} on {}\n", subject.path,
                             subject.rate, "2048 x 2048 float map", device.traits().name);
    std::vector<Series> all;
    if (device.traits().hasTessellation) all.push_back({"tessellation", &displaced, Path::tessellation, {}, {}});
    all.push_back({"grid", &displaced, Path::grid, {}, {}});
    all.push_back({"dicing and its draw", &displaced, Path::dice, {}, {}});
    all.push_back({"static dense mesh", &dense, Path::grid, {}, {}});
    measure(renderer, subject.options, all);
    print(all);
    std::cout << fmt::format("on the device: cage + map {}, dense mesh {}\n", humanBytes(displaced.byteCount()),
                             humanBytes(dense.byteCount()));
    return 0;
}

/// Displaced vertices per second of the dicer.
int benchDice() {
    Subject subject;
    Device device;
    const Model displaced(
        device, {.surface = &subject.surface, .cagePositions = subject.cage.positions, .height = &subject.map});
    const Model smooth(device, {.surface = &subject.surface, .cagePositions = subject.cage.positions});
    EdgeRater rater(device);
    Dicer dicer(device);
    const EdgeRates rates = rater.rates(displaced, subject.options, {});
    for (const auto& [name, model, normal] :
         {std::tuple{"full normals, heights", &displaced, NormalKind::full},
          std::tuple{"first-order normals, heights", &displaced, NormalKind::firstOrder},
          std::tuple{"limit normals, heights", &displaced, NormalKind::limit},
          std::tuple{"limit normals, no heights", &smooth, NormalKind::limit}}) {
        std::vector<double> times;
        std::uint32_t vertices = 0;
        for (int round = 0; round <= kRounds; ++round) {
            const DicedMesh mesh = dicer.dice(*model, rates, {.normal = normal});
            vertices = mesh.vertexCount;
            if (round > 0) times.push_back(mesh.milliseconds);
        }
        std::cout << fmt::format("dice: {:30} {:8} vertices {:8.1f} ms (least {:.1f}), {:.2f} million a second\n", name, vertices,
                                 median(times), *std::ranges::min_element(times), vertices / median(times) / 1e3);
    }
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
    const Model model(device,
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

/// Runs the command line of relief with an empty shader cache; returns wall milliseconds and peak memory in KiB.
std::pair<double, long> coldRun(const std::vector<std::string>& words) {
    rusage usage{};
    int status = 0;
    const double ms = millisecondsOf([&] {
        const pid_t child = fork();
        if (child == 0) {
            setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
            std::vector<char*> arguments;
            for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
            arguments.push_back(nullptr);
            execv(RELIEF_BINARY, arguments.data());
            _exit(127);
        }
        wait4(child, &status, 0, &usage);
    });
    if (status != 0) fail(Failure::internal, "{} ended with status {}", words[0], status);
    return {ms, usage.ru_maxrss};
}

/// A whole `relief render` with nothing cached against the warm frame that it contains.
int benchCold() {
    const Subject subject;
    const std::string folder =
        (std::filesystem::temp_directory_path() / fmt::format("relief_bench_{}", getpid())).string();
    std::filesystem::create_directories(folder);
    const std::string map = folder + "/map.exr", picture = folder + "/picture.png";
    writeImage(map, {subject.map.width, subject.map.height, 1, subject.map.texels}, SampleType::real);

    std::vector<double> cold, warm, tables;
    long peak = 0;
    for (int round = 0; round < 5; ++round) {
        const auto [ms, kib] =
            coldRun({"relief", "render", subject.path, "--height", map, "--scale", fmt::format("{}", subject.map.scale),
                     "--edge-pixels", "4", "-q", "-o", picture});
        cold.push_back(ms);
        peak = std::max(peak, kib);
        Device device;
        tables.push_back(1e3 * buildSurface(subject.cage, {}).tableSeconds);
        const Model model(
            device, {.surface = &subject.surface, .cagePositions = subject.cage.positions, .height = &subject.map});
        Renderer renderer(device, {});
        RenderOptions options = subject.options;
        options.rate.reset();
        options.edgePixels = 4;
        options.lighting.castsShadows = true;
        renderer.render(model, options);
        warm.push_back(renderer.render(model, options).stats.wallMs);
    }
    std::filesystem::remove_all(folder);
    std::cout << fmt::format(
        "cold: whole relief render {:.0f} ms, warm frame {:.0f} ms, OpenSubdiv's tables {:.0f} ms: "
        "(render - tables) / frame = {:.2f}; peak memory {}\n",
        median(cold), median(warm), median(tables), (median(cold) - median(tables)) / median(warm),
        humanBytes(std::uint64_t(peak) * 1024));
    return 0;
}

/// Limit points with both first derivatives a second: the CPU evaluators of others.
int benchEvaluators() {
#ifdef RELIEF_EVALUATORS
    constexpr int kRate = 16, kIsolation = 3;
    const std::string path = cagePath();
    const Cage cage = readCage(path);
    const std::vector<bench::PatchPoint> points = bench::gridPoints(cage, kRate);
    std::cout << fmt::format("evaluators: {} at rate {}, isolation {}: {} points with first derivatives, {} threads\n",
                             path, kRate, kIsolation, points.size(), std::thread::hardware_concurrency());
    for (const bench::EvaluatorTime& time : bench::timeEvaluators(cage, kIsolation, points))
        std::cout << fmt::format(
            "{:28} {:8.1f} ms  {:6.2f} Mpoints/s   off by {:.1e}, slopes {:.1e}, end caps {:.1e}\n", time.name, time.ms,
            double(points.size()) / time.ms / 1e3, time.pointError, time.slopeError, time.endCapError);
#else
    std::cout << "evaluators: relief_bench was built without Embree or OpenMP\n";
#endif
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    try {
        const std::vector<std::string> wanted(argv + 1, argv + argc);
        const auto runs = [&](const char* name) {
            return wanted.empty() || std::ranges::find(wanted, name) != wanted.end();
        };
        if (runs("frame")) benchFrame();
        if (runs("dice")) benchDice();
        if (runs("split")) benchSplit();
        if (runs("cold")) benchCold();
        if (runs("evaluators")) benchEvaluators();
        return 0;
    } catch (const relief::Error& error) {
        std::cerr << "relief_bench: " << error.what() << '\n';
        return int(error.failure);
    }
}
