// Pictures through the command line against committed ones, drawn by the driver that drew those.
// RELIEF_UPDATE_GOLDENS=1 writes them anew: look at them then. A test that fails leaves its picture, and ten times the
// difference, in the build folder.
#include "goldens.h"

namespace relief::test {
namespace {

class Goldens : public ::testing::TestWithParam<Golden> {
protected:
    static void SetUpTestSuite() { hasDevice_ = contains(relief({"info", "--devices"}).out, kDevice); }
    void SetUp() override {
        if (!hasDevice_) GTEST_SKIP() << "the goldens were drawn by " << kDevice << ", which is not here";
    }

    static constexpr const char* kDevice = "llvmpipe";
    static inline bool hasDevice_ = false;
    SceneFolder scenes_;
};

TEST_P(Goldens, areReproduced) {
    const Golden& golden = GetParam();
    const std::string drawn = drawGolden(scenes_, golden.name, golden.words, kDevice);
    if (HasFailure()) return;
    if (std::getenv("RELIEF_UPDATE_GOLDENS") != nullptr) {
        std::filesystem::copy_file(drawn, committedPath(golden.name),
                                   std::filesystem::copy_options::overwrite_existing);
        GTEST_SKIP() << "wrote " << committedPath(golden.name);
    }
    expectGolden(drawn, golden.name, isSame);
}

INSTANTIATE_TEST_SUITE_P(Pictures, Goldens, ::testing::ValuesIn(kGoldens),
                         [](const auto& info) { return std::string(info.param.name); });

using GoldenMutants = Goldens;

TEST_F(GoldenMutants, areSeen) {
    for (const Mutant& mutant : kMutants) {
        const std::string name = fmt::format("{}_mutant", mutant.golden);
        const auto result = compareWithGolden(drawGolden(scenes_, name, mutatedWords(mutant), kDevice), mutant.golden);
        ASSERT_TRUE(result);
        EXPECT_FALSE(isSame(*result)) << mutant.golden << ' ' << mutant.to << ": " << *result;
        EXPECT_FALSE(isSameOfAnotherDriver(*result)) << mutant.golden << ' ' << mutant.to << ": " << *result;
    }
}

TEST(GoldenComparison, seesWhatAPersonWould) {
    Image a{100, 100, 3, std::vector<float>(30000, 0.5f)}, b = a;
    EXPECT_TRUE(isSame(compare(a, b)));
    for (float& value : b.texels) value += 0.0039f; // one step of 8 bits everywhere
    EXPECT_TRUE(isSame(compare(a, b)));
    for (int i = 0; i < 6; ++i) b.texels[i] = 0.509f;
    EXPECT_TRUE(isSame(compare(a, b)));
    b.texels[6] = 0.509f;
    EXPECT_FALSE(isSame(compare(a, b)));
    b = a;
    b.texels[123] = 0.52f;
    EXPECT_FALSE(isSame(compare(a, b)));
}

TEST(GoldenComparison, ofTwoDriversForgivesOutlinesAndRounding) {
    Image golden{100, 100, 3, std::vector<float>(30000, 1.0f)};
    const auto fill = [](Image& image, int from, float value) { // a square
        for (int y = from; y < 80; ++y)
            for (int x = from; x < 80; ++x) std::fill_n(image.at(x, y), 3, value);
    };
    fill(golden, 20, 0.5f);
    Image drawn = golden;
    fill(drawn, 19, 0.8f); // covers some of the pixels around it
    fill(drawn, 20, 0.5f);
    for (int i = 0; i < 900; ++i) drawn.texels[30 * i] += 1.0f / 255; // rounds one in thirty to the next code
    EXPECT_TRUE(isSameOfAnotherDriver(compare(drawn, golden))) << compare(drawn, golden);
    fill(drawn, 18, 0.5f); // two pixels larger
    EXPECT_FALSE(isSameOfAnotherDriver(compare(drawn, golden))) << compare(drawn, golden);
}

/// The light grey of heights at rest, with all that is nearly as light, by two codes.
Image withAColorOffByTwoCodes(Image image) {
    const std::vector<float> background(3, 1.0f);
    for (auto color = image.texels.begin(); color != image.texels.end(); color += 3) {
        const bool isRest = *color > 0.85f && !std::equal(background.begin(), background.end(), color);
        if (isRest) std::transform(color, color + 3, color, [](float value) { return value - 2.0f / 255; });
    }
    return image;
}

TEST(GoldenComparison, seesAColorThatIsOffByTwoCodes) {
    const Image golden = readImage(committedPath("plane_height"));
    const Comparison result = compare(withAColorOffByTwoCodes(golden), golden);
    EXPECT_FALSE(isSame(result)) << result;
    EXPECT_FALSE(isSameOfAnotherDriver(result)) << result;
}

} // namespace
} // namespace relief::test
