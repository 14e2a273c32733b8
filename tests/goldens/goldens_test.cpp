// Pictures through the command line against committed ones. RELIEF_UPDATE_GOLDENS=1 writes them anew: look at them
// then. A test that fails leaves its picture, and ten times the difference, in the build folder.
#include "scenes.h"

namespace relief::test {
namespace {

struct Golden {
    const char* name;
    const char* words; ///< see SceneFolder::render
};

void PrintTo(const Golden& golden, std::ostream* stream) { *stream << golden.name; }

// White behind most: the studio's noise does not compress. Uniform and adaptive rates, both paths, every kind of cage.
constexpr Golden kGoldens[] = {
    {"cube_creases_tessellation", "^cube --rate 32 --azimuth 35 --elevation 25 --background 1,1,1"},
    {"cube_creases_grid", "^cube --rate 32 --azimuth 35 --elevation 25 --background 1,1,1 --path grid"},
    {"torus_waves_tessellation", "^torus --height @waves.exr --scale 0.06 --rate 12 --elevation 35 --background 1,1,1"},
    {"torus_waves_grid",
     "^torus --height @waves.exr --scale 0.06 --rate 12 --elevation 35 --background 1,1,1 --path grid"},
    {"lantern_tessellation", "^lantern --edge-pixels 4 --azimuth 20 --elevation 18 --background 1,1,1"},
    {"lantern_grid", "^lantern --edge-pixels 4 --azimuth 20 --elevation 18 --background 1,1,1 --path grid"},
    {"octahedron_loop_tessellation",
     "@octahedron.obj --scheme loop --height @waves.exr --scale 0.02 --rate 32 --background 1,1,1"},
    {"octahedron_loop_grid",
     "@octahedron.obj --scheme loop --height @waves.exr --scale 0.02 --rate 32 --background 1,1,1 --path grid"},
    {"plane_terrain",
     "^plane --height @terrain.png --scale 0.8 --wrap clamp --path grid --edge-pixels 2 --elevation 30 "
     "--roughness 0.9 --color 0.4,0.45,0.3"},
    {"ball_albedo",
     "^ball --height @waves.exr --scale 0.05 --albedo @checker.png --path grid --rate 12 --roughness 0.2 "
     "--transparent --light -60,20"},
    {"ball_wireframe", "^ball --height @waves.exr --scale 0.1 --rate 6 --show wireframe --background 1,1,1"},
    {"lantern_faces", "^lantern --path grid --rate 4 --show faces --azimuth 20 --elevation 18 --background 1,1,1"},
    {"torus_normal",
     "^torus --height @waves.exr --scale 0.06 --path grid --rate 12 --show normal --elevation 35 --background 1,1,1"},
    {"torus_rate", "^torus --edge-pixels 3 --show rate --elevation 35 --background 1,1,1 --path grid"},
    {"plane_height", "^plane --height @terrain.png --scale 0.8 --wrap clamp --path grid --rate 16 --show height "
                     "--elevation 50 --background 1,1,1"},
    {"cube_polygons", "^cube --scheme none --azimuth 35 --elevation 25 --background 1,1,1"},
};

/// OpenImageIO's rule for "the same picture", in values of 0..1: one step of 8 bits is 0.0039.
constexpr float kVisible = 0.004f, kWrong = 0.012f;
constexpr double kVisibleShare = 0.0002;

struct Comparison {
    std::size_t visibleCount = 0, wrongCount = 0, valueCount = 0;
    float largest = 0;
    Image tenfold; ///< ten times the difference
};

Comparison compare(const Image& a, const Image& b) {
    Comparison result{.valueCount = a.texels.size(), .tenfold = a};
    for (std::size_t i = 0; i < a.texels.size(); ++i) {
        const float difference = std::abs(a.texels[i] - b.texels[i]);
        const bool isAlpha = a.channels == 4 && i % 4 == 3;
        result.visibleCount += difference > kVisible;
        result.wrongCount += difference > kWrong;
        result.largest = std::max(result.largest, difference);
        result.tenfold.texels[i] = isAlpha ? 1 : std::min(1.0f, 10 * difference);
    }
    return result;
}

bool isSame(const Comparison& c) {
    return c.wrongCount == 0 && double(c.visibleCount) <= kVisibleShare * double(c.valueCount);
}

class Goldens : public ::testing::TestWithParam<Golden> {
protected:
    static void SetUpTestSuite() {
        // Other devices round otherwise at outlines; the goldens are the CPU driver's.
        hasDevice_ = contains(relief({"info", "--devices"}).out, kDevice);
    }
    void SetUp() override {
        if (!hasDevice_) GTEST_SKIP() << "the goldens were drawn by " << kDevice << ", which is not here";
    }

    static constexpr const char* kDevice = "llvmpipe";
    static inline bool hasDevice_ = false;
    SceneFolder scenes_;
};

TEST_P(Goldens, areReproduced) {
    const Golden& golden = GetParam();
    const std::string committed = fmt::format("{}/tests/goldens/{}.png", RELIEF_SOURCE, golden.name);
    const std::string left = fmt::format("{}/goldens", RELIEF_BINARY_DIR);
    const std::string drawn = fmt::format("{}/{}.png", left, golden.name);
    const std::string difference = fmt::format("{}/{}_x10.png", left, golden.name);
    std::filesystem::create_directories(left);
    scenes_.render(fmt::format("{} --size 256,256 --device {}", golden.words, kDevice), drawn);
    if (HasFailure()) return;
    if (std::getenv("RELIEF_UPDATE_GOLDENS") != nullptr) {
        std::filesystem::copy_file(drawn, committed, std::filesystem::copy_options::overwrite_existing);
        GTEST_SKIP() << "wrote " << committed;
    }

    const Image now = readImage(drawn), before = readImage(committed);
    ASSERT_TRUE(now.width == before.width && now.height == before.height && now.channels == before.channels) << drawn;
    const Comparison result = compare(now, before);
    if (isSame(result)) {
        std::filesystem::remove(drawn);
        std::filesystem::remove(difference);
        return;
    }
    writeImage(difference, result.tenfold, SampleType::uint8);
    ADD_FAILURE() << result.visibleCount << " of " << result.valueCount << " values differ by over " << kVisible << ", "
                  << result.wrongCount << " by over " << kWrong << ", the most by " << result.largest
                  << "\n  drawn      " << drawn << "\n  committed  " << committed << "\n  difference " << difference;
}

INSTANTIATE_TEST_SUITE_P(Pictures, Goldens, ::testing::ValuesIn(kGoldens),
                         [](const auto& info) { return std::string(info.param.name); });

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

} // namespace
} // namespace relief::test
