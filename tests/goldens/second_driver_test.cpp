// The goldens by a second driver, SwiftShader: it shares no code with Mesa's, rounds in its own ways, and offers the
// least that Vulkan promises. RELIEF_SWIFTSHADER is a compile definition: its manifest, or nothing.
#include "goldens.h"

namespace relief::test {
namespace {

/// Vulkan's loader sees this driver alone until the end of the scope.
class OnlyDriver {
public:
    explicit OnlyDriver(const char* manifest) {
        if (const char* value = std::getenv(kVariable)) before_ = value;
        setenv(kVariable, manifest, 1);
    }
    OnlyDriver(const OnlyDriver&) = delete;
    OnlyDriver& operator=(const OnlyDriver&) = delete;
    ~OnlyDriver() { before_ ? setenv(kVariable, before_->c_str(), 1) : unsetenv(kVariable); }

private:
    static constexpr const char* kVariable = "VK_DRIVER_FILES";
    std::optional<std::string> before_;
};

class SecondDriver : public ::testing::TestWithParam<Golden> {
protected:
    void SetUp() override {
        const bool isHere = contains(relief({"info", "--devices"}).out, kDevice);
        if (!isHere) GTEST_SKIP() << kDevice << " is not here; on Debian the package chromium-common holds it";
    }

    static constexpr const char* kDevice = "SwiftShader";
    OnlyDriver driver_{RELIEF_SWIFTSHADER};
    SceneFolder scenes_;
};

/// Drivers turn sRGB texels into light by polynomials of their own: one value in fourteen is another code.
double calmMeanOf(const std::string& golden) { return golden == "ball_albedo" ? 0.1 : kCalmMean; }

TEST_P(SecondDriver, drawsTheGoldens) {
    const Golden& golden = GetParam();
    const std::string drawn = drawGolden(scenes_, golden.name, golden.words, kDevice);
    if (HasFailure()) return;
    expectGolden(drawn, golden.name,
                 [&](const Comparison& c) { return isSameOfAnotherDriver(c, calmMeanOf(golden.name)); });
}

/// All goldens but those of tessellation, which this driver has not.
std::vector<Golden> goldensOfSecondDriver() {
    std::vector<Golden> all;
    for (const Golden& golden : kGoldens)
        if (!contains(golden.words, "--path tessellation")) all.push_back(golden);
    return all;
}

INSTANTIATE_TEST_SUITE_P(Pictures, SecondDriver, ::testing::ValuesIn(goldensOfSecondDriver()),
                         [](const auto& info) { return std::string(info.param.name); });

using SecondDriverPromises = SecondDriver;

// Dicing evaluates what the grid evaluates: waves at one rate, rates by the size on screen, and colors of a texture.
TEST_F(SecondDriverPromises, drawTheGoldensByDicing) {
    for (const Golden& golden : kGoldens) {
        const std::string name = golden.name, grid = "--path grid";
        if (name != "torus_waves_grid" && name != "lantern_grid" && name != "ball_albedo") continue;
        std::string words = golden.words;
        words.replace(words.find(grid), grid.size(), "--path dice");
        const std::string drawn = drawGolden(scenes_, name + "_diced", words, kDevice);
        if (HasFailure()) return;
        expectGolden(drawn, name, [&](const Comparison& c) { return isSameOfAnotherDriver(c, calmMeanOf(name)); });
    }
}

// Maps and tables of more than the 65,536 elements that it reads from a texel buffer.
TEST_F(SecondDriverPromises, keepLargeMapsWatertightAndExact) {
    writeImage(scenes_ / "large.exr", sineImage(2048, 16), SampleType::half);
    const Outcome outcome = relief({"check", cagePath("octopus"), "--height", scenes_ / "large.exr", "--scale", "0.01",
                                    "--path", "dice", "--rate", "3", "--points", "1000", "--device", kDevice});
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err << outcome.out;
}

// Compiled at run time for its way of reading tables.
TEST_F(SecondDriverPromises, keepHeightFunctionsWatertightAndExact) {
    const Outcome outcome = relief({"check", cagePath("torus"), "--height-function", "fractal"},
                                   "-q --path dice --rate 3 --points 1000 --device " + std::string(kDevice));
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err << outcome.out;
}

} // namespace
} // namespace relief::test
