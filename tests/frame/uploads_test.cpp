// What a frame sends to the device: its environment, and how often the host waits.
#include <algorithm>

#include "device.h"
#include "meshes.h"

namespace relief::test {
namespace {

class FrameUploads : public OnDevice {};

struct Scenery {
    Cage cage = torusWithSeams();
    HeightMap map = sineMap(64, 0.1);
    Surface surface = buildSurface(cage, {.isolation = 2});
    SurfaceModel model{device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map}};
    Renderer renderer{device(), {.width = 96, .height = 64, .shadowSide = 128}};
    RenderOptions options;

    Scenery() {
        const std::vector<dvec3> points(cage.positions.begin(), cage.positions.end());
        for (const dvec3& p : points) options.bounds.add(p);
        options.camera = frameCamera(points, {}, 1.5);
        options.path = Path::grid;
    }
    std::vector<std::uint16_t> draw() { return renderer.render(model, options).halves; }
};

Environment tinted(const vec3& tint) {
    Environment environment = studioEnvironment();
    for (Image& level : environment.levels)
        for (std::size_t i = 0; i < level.texels.size(); ++i) level.texels[i] *= tint[int(i % 3)];
    for (vec3& each : environment.irradiance) each *= tint;
    return environment;
}

TEST_F(FrameUploads, theStudioIsTheDefaultEnvironment) {
    Scenery s;
    const std::vector<std::uint16_t> before = s.draw();
    const GpuEnvironment studio = uploadEnvironment(device(), studioEnvironment());
    s.options.lighting.environment = &studio;
    EXPECT_EQ(s.draw(), before);
}

// One object holds one environment after another, at the same address.
TEST_F(FrameUploads, anEnvironmentOfNewContentShows) {
    Scenery s;
    GpuEnvironment environment = uploadEnvironment(device(), tinted({1, 0.2f, 0.2f}));
    s.options.lighting.environment = &environment;
    const std::vector<std::uint16_t> red = s.draw();
    environment = uploadEnvironment(device(), tinted({0.2f, 0.2f, 1}));
    const std::vector<std::uint16_t> blue = s.draw();
    EXPECT_NE(blue, red);
    environment = uploadEnvironment(device(), tinted({1, 0.2f, 0.2f}));
    EXPECT_EQ(s.draw(), red);
    // The reflections alone, which are the texture.
    Environment reflections = tinted({1, 0.2f, 0.2f});
    for (Image& level : reflections.levels) std::ranges::fill(level.texels, 0.0f);
    environment = uploadEnvironment(device(), reflections);
    EXPECT_NE(s.draw(), red);
}

TEST_F(FrameUploads, anEnvironmentIsACopy) {
    Scenery s;
    Environment source = tinted({1, 0.2f, 0.2f});
    const GpuEnvironment environment = uploadEnvironment(device(), source);
    s.options.lighting.environment = &environment;
    source = {};
    const std::vector<std::uint16_t> red = s.draw();
    EXPECT_EQ(s.draw(), red);
}

// The rates that the host plans triangles from, the vertices that are diced, the picture: each is waited for, because
// the host reads the first to decide on the second, and times the second by its own clock on CPU devices. Uploads of a
// frame cost no wait.
TEST_F(FrameUploads, aFrameWaitsForWhatTheHostReads) {
    Scenery s;
    s.options.edgePixels = 2;
    for (const auto& [path, waits] : {std::pair(Path::grid, 2u), std::pair(Path::dice, 3u)}) {
        s.options.path = path;
        s.draw(); // makes what is kept per model
        const std::uint64_t before = device().submitCount();
        s.draw();
        EXPECT_EQ(device().submitCount() - before, waits) << int(path);
        s.options.rate = 4;
        s.draw();
        EXPECT_EQ(device().submitCount() - before, waits + waits - 1) << "rates are given: " << int(path);
        s.options.rate.reset();
    }
}

} // namespace
} // namespace relief::test
