#include "displacement/displacement.h"

#include <cmath>
#include <numbers>

#include "support.h"

namespace relief::test {
namespace {

constexpr double kTight = 1e-12;

HeightMap makeMap(int width, int height, std::vector<float> texels, Wrap wrap = Wrap::repeat) {
    return makeHeightMap(width, height, std::move(texels), 0, 1, wrap);
}

/// 4 x 3 stored values, all different; the first row is the top one.
HeightMap smallMap(Wrap wrap) { return makeMap(4, 3, {0, 1, 4, 9, 16, 25, 36, 49, 64, 81, 100, 121}, wrap); }

double at(const HeightMap& map, double s, double t) { return sampleHeight(map, {s, t}).h; }

TEST(SampleHeight, findsTexelsAtTheirCentresTopRowAtTheTop) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
        const HeightMap map = smallMap(wrap);
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 4; ++i)
                EXPECT_NEAR(at(map, (i + 0.5) / 4, 1 - (j + 0.5) / 3), map.texels[j * 4 + i], kTight);
    }
}

TEST(SampleHeight, isBilinearBetweenCentres) {
    const HeightMap map = smallMap(Wrap::clamp);
    EXPECT_NEAR(at(map, 0.25, 1 - 0.5 / 3), 0.5, kTight);  // between 0 and 1
    EXPECT_NEAR(at(map, 0.5 / 4, 1 - 1.0 / 3), 8, kTight); // between 0 and 16
    EXPECT_NEAR(at(map, 0.25, 1 - 1.0 / 3), (0 + 1 + 16 + 25) / 4.0, kTight);
    EXPECT_NEAR(at(map, 0.5 / 4 + 0.1 / 4, 1 - 0.5 / 3), 0.1, kTight);
}

TEST(SampleHeight, repeatsBeyondTheEdges) {
    const HeightMap map = smallMap(Wrap::repeat);
    for (const double s : {0.0, 0.13, 0.5, 0.99})
        for (const double t : {0.0, 0.3, 0.77})
            for (const int turns : {-7, -1, 1, 1000}) {
                EXPECT_NEAR(at(map, s + turns, t), at(map, s, t), 1e-9);
                EXPECT_NEAR(at(map, s, t + turns), at(map, s, t), 1e-9);
            }
    EXPECT_NEAR(at(map, 0, 1 - 0.5 / 3), (0 + 9) / 2.0, kTight); // left edge: between last and first column
    EXPECT_NEAR(at(map, 0.5 / 4, 1), (0 + 64) / 2.0, kTight);    // top edge: between last and first row
    EXPECT_NEAR(at(map, -1e-20, 1 - 0.5 / 3), 4.5, kTight);      // rounds to 1, not below 0
}

TEST(SampleHeight, clampsToTheBorder) {
    const HeightMap map = smallMap(Wrap::clamp);
    EXPECT_NEAR(at(map, 0, 1), 0, kTight);
    EXPECT_NEAR(at(map, -3, 7), 0, kTight);
    EXPECT_NEAR(at(map, 5, -5), 121, kTight);
    EXPECT_NEAR(at(map, 1e30, 1 - 0.5 / 3), 9, kTight);
    EXPECT_NEAR(at(map, 0.25, 1e300), 0.5, kTight);
}

TEST(SampleHeight, appliesScaleAndMid) {
    const HeightMap map = makeHeightMap(1, 1, {0.75f}, 0.5, -8, Wrap::repeat);
    const HeightSample sample = sampleHeight(map, {0.3, 0.9});
    EXPECT_NEAR(sample.h, -2, kTight);
    EXPECT_NEAR(sample.hs, 0, kTight);
    EXPECT_NEAR(sample.ht, 0, kTight);
}

TEST(SampleHeight, slopesAreCentralDifferencesOverOneTexel) {
    const HeightMap map = smallMap(Wrap::repeat);
    for (const dvec2 st : {dvec2(0.2, 0.3), dvec2(0.61, 0.05), dvec2(0.999, 0.5)}) {
        const HeightSample sample = sampleHeight(map, st);
        EXPECT_NEAR(sample.hs, (at(map, st.x + 0.25, st.y) - at(map, st.x - 0.25, st.y)) * 2, 1e-10);
        EXPECT_NEAR(sample.ht, (at(map, st.x, st.y + 1.0 / 3) - at(map, st.x, st.y - 1.0 / 3)) * 1.5, 1e-10);
    }
}

TEST(SampleHeight, slopesOfARampAreExactAndTPointsUp) {
    std::vector<float> texels;
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 16; ++i) texels.push_back(float(3 * i - 5 * j));
    const HeightMap map = makeMap(16, 8, texels, Wrap::clamp);
    const HeightSample sample = sampleHeight(map, {0.4, 0.6});
    EXPECT_NEAR(sample.hs, 3 * 16, 1e-9);
    EXPECT_NEAR(sample.ht, 5 * 8, 1e-9); // rows run down, t up
}

TEST(SampleHeight, approachesASmoothFunction) {
    const auto f = [](double s, double t) {
        return std::sin(2 * std::numbers::pi * s) * std::cos(2 * std::numbers::pi * t);
    };
    const auto error = [&](int size) {
        std::vector<float> texels;
        for (int j = 0; j < size; ++j)
            for (int i = 0; i < size; ++i) texels.push_back(float(f((i + 0.5) / size, 1 - (j + 0.5) / size)));
        const HeightMap map = makeMap(size, size, texels);
        double largest = 0;
        for (int k = 0; k < 1000; ++k) {
            const double s = std::fmod(0.618034 * k, 1), t = k / 1000.0;
            largest = std::max(largest, std::abs(at(map, s, t) - f(s, t)));
        }
        return largest;
    };
    EXPECT_LT(error(256), 2e-4);
    EXPECT_LT(error(256), error(64) / 10); // second order: 16 times smaller
}

TEST(HeightMap, boundIsTheLargestHeight) {
    EXPECT_DOUBLE_EQ(makeHeightMap(2, 1, {0.25f, 1}, 0.5, 3, Wrap::repeat).heightBound(), 1.5);
    EXPECT_DOUBLE_EQ(makeHeightMap(2, 1, {-4, 1}, 0, -2, Wrap::repeat).heightBound(), 8);
    EXPECT_DOUBLE_EQ(makeHeightMap(2, 1, {2, 2}, 2, 5, Wrap::repeat).heightBound(), 0);
    const HeightMap map = makeMap(2, 1, {-4, 1});
    EXPECT_EQ(map.lowest, -4);
    EXPECT_EQ(map.highest, 1);
    EXPECT_EQ(map.byteCount(), 8u);
}

TEST(HeightMap, refusesSizesThatDisagree) {
    expectFailure(Failure::input, {"2 x 2", "3 texels"}, [] { makeMap(2, 2, {1, 2, 3}); });
    expectFailure(Failure::input, {"0 x 2"}, [] { makeMap(0, 2, {}); });
    expectFailure(Failure::input, {"-1 x -1"}, [] { makeMap(-1, -1, {1}); });
}

TEST(HeightMap, refusesTexelsThatAreNotFinite) {
    expectFailure(Failure::input, {"column 1, row 2", "nan"}, [] { makeMap(2, 3, {0, 0, 0, 0, 0, NAN}); });
    expectFailure(Failure::input, {"column 0, row 0", "inf"}, [] { makeMap(2, 1, {INFINITY, 0}); });
}

TEST(HeightMap, refusesMidAndScaleThatAreNotFinite) {
    expectFailure(Failure::usage, {"mid", "nan"}, [] { makeHeightMap(1, 1, {0}, NAN, 1, Wrap::repeat); });
    expectFailure(Failure::usage, {"scale", "inf"}, [] { makeHeightMap(1, 1, {0}, 0, INFINITY, Wrap::repeat); });
}

struct LoadHeightMap : testing::Test {
    TemporaryFolder folder;
    Warnings warnings;
    Image image{.width = 2, .height = 1, .channels = 1, .texels = {0, 1}};

    HeightMap load(const std::string& name, const HeightOptions& options = {}) {
        return loadHeightMap(folder / name, options, warnings.warn()).decoded;
    }
};

TEST_F(LoadHeightMap, integerFilesHaveTheirMidAtOneHalf) {
    writeImage(folder / "a.png", image, SampleType::uint16);
    const HeightMap map = load("a.png", {.scale = 4});
    EXPECT_EQ(map.mid, 0.5);
    EXPECT_EQ(map.scale, 4);
    EXPECT_NEAR(at(map, 0.25, 0.5), -2, kTight);
    EXPECT_NEAR(at(map, 0.75, 0.5), 2, kTight);
    EXPECT_TRUE(warnings.lines.empty());
}

TEST_F(LoadHeightMap, floatFilesHoldHeightsInCageUnits) {
    image.texels = {-3.5f, 7};
    for (const std::string name : {"a.exr", "a.tif"}) {
        writeImage(folder / name, image, SampleType::real);
        const HeightMap map = load(name);
        EXPECT_EQ(map.mid, 0);
        EXPECT_EQ(map.scale, 1);
        EXPECT_EQ(map.texels, image.texels);
    }
    writeImage(folder / "half.exr", image, SampleType::half);
    EXPECT_EQ(load("half.exr").mid, 0);
    EXPECT_TRUE(warnings.lines.empty());
}

TEST_F(LoadHeightMap, givenMidAndScaleWin) {
    writeImage(folder / "a.exr", image, SampleType::real);
    const HeightMap map = load("a.exr", {.mid = 0.25, .scale = 0, .wrap = Wrap::clamp});
    EXPECT_EQ(map.mid, 0.25);
    EXPECT_EQ(map.scale, 0);
    EXPECT_EQ(map.wrap, Wrap::clamp);
    EXPECT_EQ(map.heightBound(), 0);
}

TEST_F(LoadHeightMap, warnsOfStairsIn8Bits) {
    writeImage(folder / "a.png", image, SampleType::uint8);
    load("a.png", {.scale = 1});
    ASSERT_EQ(warnings.lines.size(), 1u);
    EXPECT_TRUE(warnings.has(folder / "a.png"));
    EXPECT_TRUE(warnings.has("8-bit"));
}

TEST_F(LoadHeightMap, warnsOfIntegersWithoutAScale) {
    writeImage(folder / "a.tif", image, SampleType::uint16);
    EXPECT_EQ(load("a.tif").scale, 1);
    ASSERT_EQ(warnings.lines.size(), 1u);
    EXPECT_TRUE(warnings.has("no scale"));
}

TEST_F(LoadHeightMap, takesOneChannel) {
    image = {.width = 1, .height = 1, .channels = 3, .texels = {1, 2, 3}};
    writeImage(folder / "a.exr", image, SampleType::real);
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_EQ(load("a.exr", {.channel = std::to_string(channel)}).texels, std::vector<float>{float(channel + 1)});
    for (const int channel : {3, -1})
        expectFailure(Failure::input, {folder / "a.exr", fmt::format("channel {}", channel), "0 to 2"},
                      [&] { load("a.exr", {.channel = std::to_string(channel)}); });
}

TEST_F(LoadHeightMap, refusesTexelsThatAreNotFinite) {
    image.texels = {0, NAN};
    writeImage(folder / "a.exr", image, SampleType::real);
    expectFailure(Failure::input, {folder / "a.exr", "column 1, row 0", "nan"}, [&] { load("a.exr"); });
}

TEST_F(LoadHeightMap, keepsToTheLimits) {
    writeImage(folder / "a.exr", image, SampleType::real);
    expectFailure(Failure::input, {folder / "a.exr", "2 x 1"}, [&] { load("a.exr", {.limits = {.side = 1}}); });
    expectFailure(Failure::file, {folder / "none.exr"}, [&] { load("none.exr"); });
}

} // namespace
} // namespace relief::test
