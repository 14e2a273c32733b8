// What the options make of a picture.
#include <set>

#include "program.h"

namespace relief::test {
namespace {

class Drawn : public ::testing::Test {
protected:
    TemporaryFolder folder_;
    int count_ = 0;

    void SetUp() override { writeImage(folder_ / "h.exr", sineImage(64, 6), SampleType::real); }

    /// The ball under waves, with these options.
    Image drawAs(const std::string& target, const std::string& options) {
        expectDone(relief({"render", cagePath("ball"), "--height", folder_ / "h.exr", "-o", target}, options));
        return readImage(target);
    }

    /// 96 pixels square, with more options.
    Image draw(const std::string& more, const std::string& extension = ".png") {
        return drawAs(folder_ / (std::to_string(count_++) + extension), "--scale 0.1 --size 96,96 --rate 8 " + more);
    }
};

/// Share of pixels in which two pictures clearly differ.
double differingShare(const Image& a, const Image& b) {
    EXPECT_EQ(a.texels.size(), b.texels.size());
    int count = 0;
    for (std::size_t i = 0; i < a.texels.size(); i += a.channels)
        for (int c = 0; c < a.channels; ++c)
            if (std::abs(a.texels[i + c] - b.texels[i + c]) > 0.03f) {
                ++count;
                break;
            }
    return double(count) / (double(a.texels.size()) / a.channels);
}

void expectAllDifferent(const std::vector<std::pair<std::string, Image>>& pictures, double share) {
    for (std::size_t i = 0; i < pictures.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            EXPECT_GT(differingShare(pictures[i].second, pictures[j].second), share)
                << pictures[i].first << " and " << pictures[j].first;
}

TEST_F(Drawn, everyShowIsAPictureOfItsOwn) {
    std::vector<std::pair<std::string, Image>> pictures;
    for (const char* show : {"shaded", "normal", "height", "rate", "faces", "wireframe"})
        pictures.emplace_back(show, draw(std::string("--show ") + show));
    expectAllDifferent(pictures, 0.2);
}

TEST_F(Drawn, everyMapFormatDrawsTheSameInItsOwnBytes) {
    const Image floats = draw("--map-format float");
    const std::uint64_t texels = 64 * 64 + 32 * 32 + 16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1;
    for (const auto& [format, bytes] : {std::pair{"half", 2 * texels + 2},
                                        {"unorm16", 2 * texels + 2},
                                        {"unorm8", texels + 3},
                                        {"bc4", std::uint64_t(8 * (256 + 64 + 16 + 4 + 1 + 1 + 1))}}) {
        const std::string target = folder_ / (std::string(format) + ".png");
        const nlohmann::json json =
            jsonOf(relief({"render", cagePath("ball"), "--height", folder_ / "h.exr", "-o", target},
                          std::string("--scale 0.1 --size 96,96 --rate 8 --json --map-format ") + format));
        EXPECT_EQ(json.at("map_bytes"), (bytes + 7) / 8 * 8) << format; // words are kept in pairs
        EXPECT_EQ(json.at("map_format"), format);
        // A block of BC4 keeps eight heights: its slopes are rough.
        EXPECT_LT(differingShare(readImage(target), floats), format == std::string("bc4") ? 0.12 : 0.005) << format;
    }
}

TEST_F(Drawn, everyNormalIsAPictureOfItsOwn) {
    std::vector<std::pair<std::string, Image>> pictures;
    for (const char* normal : {"limit", "first-order", "full"}) // the curvature term grows with height times curvature
        pictures.emplace_back(normal, drawAs(folder_ / "a.png", std::string("--scale 0.3 --size 96,96 --rate 16 ") +
                                                                    "--show normal --normal " + normal));
    expectAllDifferent(pictures, 0.05);
}

TEST_F(Drawn, everyPathSupportsBothSpacings) {
    for (const std::string path : {"tessellation", "grid", "dice"}) {
        const std::string more = "--scale 0.1 --size 96,96 --edge-pixels 7.7 --show wireframe --path " + path;
        expectAllDifferent({{path + " equal", drawAs(folder_ / "a.png", more)},
                            {path + " fractional", drawAs(folder_ / "b.png", more + " --spacing fractional")}},
                           0.02);
    }
}

TEST_F(Drawn, edgesThatTheTessellatorCutsShortAreWarnedOf) {
    const std::string more = "--size 64,64 --edge-pixels 0.3 --json --path ";
    const Outcome named = relief({"render", cagePath("cube"), "-o", folder_ / "a.png"}, more + "tessellation");
    EXPECT_EQ(nlohmann::json::parse(named.out).at("max_rate"), 64) << named.err;
    EXPECT_TRUE(contains(named.err, "warning: --path tessellation makes 64 segments")) << named.err;
    const Outcome diced = relief({"render", cagePath("cube"), "-o", folder_ / "a.png"}, more + "dice");
    EXPECT_GT(nlohmann::json::parse(diced.out).at("max_rate"), 64);
    EXPECT_EQ(diced.err, "");
}

TEST_F(Drawn, negativeAnglesAreAngles) {
    std::vector<std::pair<std::string, Image>> pictures;
    for (const char* options :
         {"--light -40,50", "--light 40,50", "--light=-40,-50", "--azimuth -70", "--elevation -30 --azimuth=-70"})
        pictures.emplace_back(options, draw(options));
    expectAllDifferent(pictures, 0.05);
}

// Light from the eye dims all three channels alike; blue is 150 in a light field and 112 in a dark one.
TEST_F(Drawn, uvShowsTheFieldsOfTheUnitSquare) {
    for (const std::string raster : {"hardware", "compute"}) {
        expectDone(relief(
            {"render", cagePath("plane"), "-o", folder_ / "uv.png"},
            "--show uv --background 0,0,0 --elevation 90 --azimuth 0 --fov 1 --size 96,96 --path dice --raster " +
                raster));
        const Image image = readImage(folder_ / "uv.png");
        std::set<std::pair<int, int>> fields;
        for (int y = 0; y < 96; ++y)
            for (int x = 0; x < 96; ++x) {
                const float* c = image.at(x, y);
                if (c[2] < 0.2f) continue; // the background
                const vec2 field = (vec2(c[0], c[1]) * 150.0f / c[2] - 45.0f) / 26.0f;
                const ivec2 nearest(glm::round(field));
                if (glm::distance(field, vec2(nearest)) > 0.1f || std::min(nearest.x, nearest.y) < 0) continue;
                fields.insert({nearest.x, nearest.y});
                // s goes to the right and t up, over the square that the plane takes of the picture.
                EXPECT_NEAR(nearest.x, x / 12.0 - 0.5, 2);
                EXPECT_NEAR(nearest.y, 7.5 - y / 12.0, 2);
            }
        EXPECT_EQ(fields.size(), 64u) << raster;
    }
    writeFile(folder_ / "bare.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    expectRefused(relief({"render", folder_ / "bare.obj", "-o", folder_ / "no.png"}, "--show uv"), Failure::input,
                  {"bare.obj", "texture coordinates"});
}

TEST_F(Drawn, sizeIsWidthThenHeight) {
    const Image image = drawAs(folder_ / "a.png", "--size 80,48 --rate 2");
    EXPECT_EQ(image.width, 80);
    EXPECT_EQ(image.height, 48);
}

TEST_F(Drawn, backgroundIsTheColorGiven) {
    const Image image = draw("--background 1,0,0.2");
    EXPECT_EQ(image.channels, 3);
    const float* corner = image.at(0, 0);
    EXPECT_EQ(corner[0], 1);
    EXPECT_EQ(corner[1], 0);
    EXPECT_NEAR(corner[2], 0.2, 1e-6);
}

TEST_F(Drawn, colorAndAlbedoMapMultiply) {
    Image green{8, 8, 3, {}};
    for (int i = 0; i < 64; ++i) green.texels.insert(green.texels.end(), {0, 1, 0});
    writeImage(folder_ / "green.png", green, SampleType::uint8);
    const Image image = draw("--no-shadows --roughness 1 --albedo " + folder_ / "green.png");
    const float* center = image.at(48, 48);
    EXPECT_GT(center[1], 2 * center[0]);
    const Image black = draw("--no-shadows --roughness 1 --color 1,0,1 --albedo " + folder_ / "green.png");
    EXPECT_LT(black.at(48, 48)[1], 0.5f * center[1]);
}

TEST_F(Drawn, shadowsAndEnvironmentsShow) {
    Image sky{16, 8, 3, std::vector<float>(384, 0.0f)};
    for (int x = 0; x < 16; ++x) sky.at(x, 0)[2] = 30; // blue from above
    writeImage(folder_ / "sky.exr", sky, SampleType::real);
    expectAllDifferent({{"a", draw("--light 100,5")},
                        {"b", draw("--light 100,5 --no-shadows")},
                        {"c", draw("--environment " + folder_ / "sky.exr")}},
                       0.05);
}

/// The display transform of pictures: exposure 0.8, Narkowicz's fit of the ACES curve, sRGB.
float displayed(float linear) {
    const float y = 0.8f * linear;
    const float x = std::clamp(y * (2.51f * y + 0.03f) / (y * (2.43f * y + 0.59f) + 0.14f), 0.0f, 1.0f);
    return x <= 0.0031308f ? 12.92f * x : 1.055f * std::pow(x, 1 / 2.4f) - 0.055f;
}

TEST_F(Drawn, exrIsLinearWithPremultipliedAlphaAndPngShowsTheSame) {
    const Image exr = draw("", ".exr"), png = draw("--transparent");
    ASSERT_EQ(exr.channels, 4);
    ASSERT_EQ(png.channels, 4);
    int solid = 0, partial = 0, empty = 0;
    for (int y = 0; y < exr.height; ++y)
        for (int x = 0; x < exr.width; ++x) {
            const float *linear = exr.at(x, y), *shown = png.at(x, y);
            const float alpha = linear[3];
            (alpha == 0 ? empty : alpha == 1 ? solid : partial) += 1;
            ASSERT_NEAR(shown[3], alpha, 0.003) << x << ',' << y;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(shown[c], alpha > 0 ? displayed(linear[c] / alpha) : 0, 0.004) << x << ',' << y;
        }
    EXPECT_GT(solid, 4000);
    EXPECT_GT(partial, 100); // smooth outline
    EXPECT_GT(empty, 1000);
    EXPECT_EQ(exr.at(0, 0)[3], 0);
    const ImageInfo info = readImageInfo(folder_ / "0.exr");
    EXPECT_EQ(info.sample, "half");
    EXPECT_EQ(info.channelNames, (Words{"R", "G", "B", "A"}));
}

TEST_F(Drawn, theSameCommandGivesTheSameBytes) {
    drawAs(folder_ / "a.png", "--size 64,64"), drawAs(folder_ / "b.png", "--size 64,64");
    EXPECT_EQ(readFile(folder_ / "a.png"), readFile(folder_ / "b.png"));
}

} // namespace
} // namespace relief::test
