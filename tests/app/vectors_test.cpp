// --vector: vector displacement maps from the command line.
#include "program.h"

namespace relief::test {
namespace {

struct VectorOption : testing::Test {
    TemporaryFolder folder;
    const std::string torus = cagePath("torus"), heights = folder / "heights.exr";
    Image image = sineImage(64, 2);

    void SetUp() override {
        for (float& texel : image.texels) texel *= 0.1f;
        writeImage(heights, image, SampleType::real);
    }
    /// The heights in one of three channels, and nothing in the others.
    [[nodiscard]] std::string vectors(const std::string& name, int channel, int channels = 3) const {
        Image all{.width = image.width, .height = image.height, .channels = channels, .texels = {}};
        for (const float h : image.texels)
            for (int k = 0; k < channels; ++k) all.texels.push_back(k == channel ? h : 0);
        writeImage(folder / name, all, SampleType::real);
        return folder / name;
    }
    /// A small picture by the grid, in which every pixel shows the normal.
    [[nodiscard]] Image picture(const Words& map, const std::string& more = "") const {
        Words words{"render", torus, "-o", folder / "p.png"};
        words.insert(words.end(), map.begin(), map.end());
        expectDone(relief(words, "--path grid --rate 6 --size 64,64 --show normal -q " + more));
        return readImage(folder / "p.png");
    }
};

/// The largest difference of two pictures, and how many values differ.
std::pair<double, std::size_t> compared(const Image& a, const Image& b) {
    EXPECT_EQ(a.texels.size(), b.texels.size());
    double largest = 0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < std::min(a.texels.size(), b.texels.size()); ++i) {
        const double difference = std::abs(double(a.texels[i]) - b.texels[i]);
        largest = std::max(largest, difference), count += difference > 0 ? 1 : 0;
    }
    return {largest, count};
}

TEST_F(VectorOption, ofHeightsAlongTheNormalDrawsThePictureOfTheHeights) {
    const Image expected = picture({"--height", heights});
    const std::string along = vectors("along.exr", 2), green = vectors("green.exr", 1);
    const std::pair<Words, const char*> same[] = {{{"--vector", along}, ""},
                                                  {{"--vector", green}, "--vector-preset mudbox"},
                                                  {{"--vector", green}, "--vector-order xzy"},
                                                  {{"--vector", along}, "--vector-flip z --scale -1"}};
    for (const auto& [map, more] : same) {
        const auto [largest, count] = compared(picture(map, more), expected);
        EXPECT_LE(largest, 1.01 / 255) << more;
        EXPECT_LE(count, expected.texels.size() / 200) << more;
    }
    EXPECT_GT(compared(picture({"--vector", green}), expected).first, 0.1) << "green along t";
    EXPECT_GT(compared(picture({"--vector", along}, "--vector-space object"), expected).first, 0.1);
}

TEST_F(VectorOption, isCertified) {
    const nlohmann::json json = jsonOf(relief({"check", torus, "--vector", vectors("sideways.exr", 0), "--json"},
                                              "--rate 3 --points 2000 --path dice"));
    EXPECT_NEAR(json.at("displacement_bound").get<double>(), 0.1, 0.01);
}

TEST_F(VectorOption, refusesWhatMakesNoSense) {
    const std::string map = vectors("map.exr", 2), two = vectors("two.exr", 0, 2), out = folder / "out.png";
    const Words render{"render", torus, "-o", out, "-q"};
    const auto refused = [&](const Words& more, Failure failure, const Words& parts) {
        Words words = render;
        words.insert(words.end(), more.begin(), more.end());
        expectRefused(relief(words), failure, parts);
    };
    refused({"--vector", two}, Failure::input, {"two.exr", "3 channels", "2"});
    refused({"--vector", map, "--height", heights}, Failure::usage, {"--vector"});
    refused({"--vector", map, "--detail", "bump"}, Failure::usage, {"map.exr", "bump"});
    refused({"--vector", map, "--vector-order", "xxz"}, Failure::usage, {"xxz"});
    refused({"--vector", map, "--vector-flip", "w"}, Failure::usage, {"'w'"});
    refused({"--vector-space", "object"}, Failure::usage, {"--vector"});
    refused({"--vector", map, "--vector-space", "object", "--deform", "twist(axis=y, angle=90)"}, Failure::usage,
            {"map.exr", "tangent"});
    EXPECT_FALSE(std::filesystem::exists(out));
}

} // namespace
} // namespace relief::test
