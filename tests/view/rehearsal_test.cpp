// What a height function costs is paid before the window's own device draws it.
#include <gtest/gtest.h>

#include <thread>

#include "support.h"
#include "view/loader.h"

namespace relief::test {
namespace {

constexpr const char* kWaves = "float height(vec3 p, vec2 st, float t) { return 0.1 * sin(9.0 * p.x); }\n";

class Rehearsal : public ::testing::Test {
protected:
    void SetUp() override {
        setenv("RELIEF_CACHE", (folder_ / "cache").c_str(), 1); // shaders of earlier runs
        putFile(folder_ / "waves.glsl", kWaves);
        putFile(folder_ / "cube.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv 0 0 1\nv 1 0 1\nv 0 1 1\nv 1 1 1\n"
                                      "f 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8 6\n");
        look_.scene.object.cage = folder_ / "cube.obj";
        look_.scene.object.height.function = folder_ / "waves.glsl";
        look_.scene.size = {96, 64};
        desc_.makeOptions = [](const Look& look, const LoadedObject&, const Device&) {
            RenderOptions options;
            options.path = Path::dice;
            options.edgePixels = look.triangles.edgePixels;
            return options;
        };
        loader_.useDevice(device_.traits().name);
    }
    void TearDown() override { EXPECT_TRUE(device_.validationMessages().empty()); }

    Loader::Result load() {
        loader_.ask(look_);
        for (;;) {
            if (auto result = loader_.take()) return std::move(*result);
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
    }

    TemporaryFolder folder_;
    Device device_{{.validate = true}};
    Look look_;
    ViewDesc desc_;
    Loader loader_{desc_};
};

TEST_F(Rehearsal, compilesAllThatAPictureNeeds) {
    Loader::Result first = load();
    ASSERT_TRUE(first.prepared) << first.error;
    EXPECT_FALSE(first.prepared->points.empty()); // measured
    const std::shared_ptr<const HeightFunction> function = first.prepared->loaded.object.function->function;
    const HeightFunction::Costs before = function->costs();
    EXPECT_GE(before.compiledCount, 4); // the evaluator, rates, and what dices
    Renderer renderer(device_, {.width = 96, .height = 64});
    ShownScene scene(device_, desc_, std::move(*first.prepared));
    const Picture picture = scene.draw(renderer, look_, {96, 64});
    EXPECT_GT(picture.stats.triangleCount, 100u);
    EXPECT_EQ(function->costs().compiledCount, before.compiledCount);

    // Other heights by the same function: it is the same object, and nothing is compiled.
    look_.scene.object.height.scale = 2;
    loader_.setShown(scene.pipelineKey());
    const Loader::Result second = load();
    ASSERT_TRUE(second.prepared) << second.error;
    EXPECT_EQ(second.prepared->loaded.object.function->function, function);
    EXPECT_FALSE(second.prepared->points.empty());
    EXPECT_EQ(function->costs().compiledCount, before.compiledCount);
}

TEST_F(Rehearsal, findsWhatTheDeviceAloneKnows) {
    putFile(folder_ / "waves.glsl", "float height(vec3 p, vec2 st, float t) { return sqrt(-1.0 - p.x * p.x); }\n");
    const Loader::Result result = load();
    EXPECT_FALSE(result.prepared);
    EXPECT_NE(result.error.find("waves.glsl: height is nan at face"), std::string::npos) << result.error;
}

} // namespace
} // namespace relief::test
