// Maps on the command line: what is said about them, what is refused, and what info counts.
#include <limits>

#include "program.h"
#include "tiff.h"

namespace relief::test {
namespace {

/// A render of a small picture, with its exit code and what it says.
Outcome render(const TemporaryFolder& folder, const std::string& cage, Words words, const std::string& more = "") {
    Words all{"render", cage, "--size", "64,64", "--rate", "4", "-q", "-o", folder / "out.png"};
    std::erase(all, more == "loud" ? "-q" : "");
    all.insert(all.end(), words.begin(), words.end());
    return relief(all, more == "loud" ? "" : more);
}

std::string squareTo(double s, double t) {
    return fmt::format("v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt {0} 0\nvt {0} {1}\nvt 0 {1}\n"
                       "f 1/1 2/2 3/3 4/4\n",
                       s, t);
}

struct Maps : testing::Test {
    TemporaryFolder folder;

    void SetUp() override {
        writeImage(folder / "h.exr", sineImage(16, 1), SampleType::half);
        putFile(folder / "tiled.obj", squareTo(10, 1));
        putFile(folder / "unit.obj", squareTo(1.00001, 1));
    }
    [[nodiscard]] std::string warningsOf(const std::string& cage, const Words& words) {
        const Outcome outcome = render(folder, folder / cage, words, "loud");
        EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
        std::string lines;
        std::istringstream stream(outcome.err);
        for (std::string line; std::getline(stream, line);)
            if (line.starts_with("warning: ")) lines += line + "\n";
        return lines;
    }
};

TEST_F(Maps, thatRepeatUnaskedAreWarnedOfOnce) {
    const std::string lines = warningsOf("tiled.obj", {"--height", folder / "h.exr"});
    EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 1) << lines;
    EXPECT_TRUE(contains(lines, "from (0, 0) to (10, 1)")) << lines;
    EXPECT_TRUE(contains(lines, "UDIM")) << lines;
    for (const char* wrap : {"repeat", "clamp"})
        EXPECT_EQ(warningsOf("tiled.obj", {"--height", folder / "h.exr", "--wrap", wrap}), "") << wrap;
    EXPECT_EQ(warningsOf("unit.obj", {"--height", folder / "h.exr"}), "") << "rounding";
    EXPECT_EQ(warningsOf("tiled.obj", {}), "") << "no map";
}

TEST_F(Maps, ofColorThatRepeatUnaskedAreWarnedOfOnce) {
    writeImage(folder / "c.png", {2, 1, 3, std::vector<float>(6, 0.5f)}, SampleType::uint8);
    const Words both{"--albedo", folder / "c.png", "--height", folder / "h.exr"};
    const std::string lines = warningsOf("tiled.obj", {"--albedo", folder / "c.png"});
    EXPECT_TRUE(contains(lines, "c.png repeats")) << lines;
    const std::string ofBoth = warningsOf("tiled.obj", both);
    EXPECT_EQ(std::count(ofBoth.begin(), ofBoth.end(), '\n'), 1) << ofBoth;
}

TEST_F(Maps, ofTilesWithoutFilesAreRefused) {
    for (const char* option : {"--height", "--albedo", "--normal-map"})
        expectRefused(render(folder, cagePath("plane"), {option, "rock.<UDIM>.exr"}), Failure::file,
                      {"rock.<UDIM>.exr", "rock.1001.exr"});
    expectRefused(render(folder, cagePath("plane"), {"--environment", "rock.<UDIM>.exr"}), Failure::usage, {"UDIM"});
    expectRefused(relief({"info", "rock_<UVTILE>.tif"}), Failure::file, {"rock_u1_v1.tif"});
}

TEST_F(Maps, withVoidsShowTheirHeights) {
    std::vector<float> samples(256, 0);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] = i == 17 ? -9999.0f : float(i % 16);
    putFile(folder / "dem.tif",
            tiffOf<float>({.width = 16, .height = 16, .sampleFormat = 3, .noData = "-9999"}, samples));
    const Outcome outcome =
        render(folder, cagePath("plane"), {"--height", folder / "dem.tif", "--scale", "0.01"}, "loud");
    EXPECT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "1 of 256 texels are voids (-9999 by its GDAL_NODATA)")) << outcome.err;
    const nlohmann::json map = jsonOf(relief({"info", "--json", folder / "dem.tif"})).at(0);
    EXPECT_EQ(map.at("ranges"), (nlohmann::json{{0, 15}}));
    EXPECT_EQ(map.at("voids").at("Y").at("count"), 1);
    EXPECT_EQ(map.at("no_data"), "-9999");
    EXPECT_EQ(map.at("default_mid"), 0);
    const std::string text = relief({"info", folder / "dem.tif"}).out;
    EXPECT_TRUE(contains(text, "Y count 1, value -9999 by its GDAL_NODATA")) << text;
}

TEST_F(Maps, infoReportsWhereTexelsAreNotFinite) {
    Image image = sineImage(16, 1);
    *image.at(3, 2) = std::numeric_limits<float>::quiet_NaN();
    *image.at(5, 9) = std::numeric_limits<float>::infinity();
    writeImage(folder / "bad.exr", image, SampleType::real);
    const nlohmann::json map = jsonOf(relief({"info", "--json", folder / "bad.exr"})).at(0);
    EXPECT_EQ(map.at("not_finite").at("Y"), (nlohmann::json{{"count", 2}, {"first", {{"column", 3}, {"row", 2}}}}));
    EXPECT_NEAR(map.at("ranges").at(0).at(1), 1, 0.1);
    const std::string text = relief({"info", folder / "bad.exr"}).out;
    EXPECT_TRUE(contains(text, "Y count 2, first column 3, row 2")) << text;
    EXPECT_TRUE(jsonOf(relief({"info", "--json", folder / "h.exr"})).at(0).at("not_finite").empty());
}

TEST_F(Maps, infoNamesLayers) {
    Image image{1, 1, 2, {5, 6}};
    writeImage(folder / "l.exr", image, {{"color.R", SampleType::real}, {"height.Y", SampleType::real}});
    EXPECT_EQ(jsonOf(relief({"info", "--json", folder / "l.exr"})).at(0).at("layers"), (Words{"color", "height"}));
    EXPECT_EQ(render(folder, cagePath("plane"), {"--height", folder / "l.exr", "--channel", "height"}).exitCode, 0);
    expectRefused(render(folder, cagePath("plane"), {"--height", folder / "l.exr", "--channel", "depth"}),
                  Failure::input, {"l.exr", "depth", "height.Y"});
}

TEST_F(Maps, ofNonFiniteColorsNameTheTexel) {
    Image image{8, 8, 3, std::vector<float>(8 * 8 * 3, 0.5f)};
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        image.at(5, 6)[1] = bad;
        writeImage(folder / "c.exr", image, SampleType::real);
        expectRefused(render(folder, cagePath("plane"), {"--albedo", folder / "c.exr"}), Failure::input,
                      {"c.exr", "channel G", "column 5, row 6"});
    }
    image.at(5, 6)[1] = 1e30f;
    writeImage(folder / "c.exr", image, SampleType::real);
    const std::string lines = warningsOf("unit.obj", {"--albedo", folder / "c.exr"});
    EXPECT_TRUE(contains(lines, "1 of 192 values")) << lines;
}

TEST_F(Maps, ofLightStayFinite) {
    Image image{16, 8, 3, std::vector<float>(16 * 8 * 3, 0.5f)};
    image.at(3, 4)[0] = 3e38f;
    writeImage(folder / "sky.exr", image, SampleType::real);
    expectRefused(render(folder, cagePath("ball"), {"--environment", folder / "sky.exr"}), Failure::input,
                  {"sky.exr", "pixel 3,4", "0..1e+12"});
    for (int c = 0; c < 3; ++c) image.at(3, 4)[c] = 1e12f;
    writeImage(folder / "sky.exr", image, SampleType::real);
    EXPECT_EQ(render(folder, cagePath("ball"), {"--environment", folder / "sky.exr"}).exitCode, 0);
    const Image lit = readImage(folder / "out.png");
    EXPECT_GT(lit.at(32, 32)[0] + lit.at(20, 32)[0] + lit.at(44, 32)[0], 0.9f) << "bright, not black";
}

TEST_F(Maps, thatAreDamagedAreOneLine) {
    Image image{64, 64, 3, std::vector<float>(64 * 64 * 3, 0.25f)};
    for (std::size_t i = 0; i < image.texels.size(); ++i) image.texels[i] = float(i * 7919 % 255) / 255;
    writeImage(folder / "a.png", image, SampleType::uint8);
    std::string bytes = readFile(folder / "a.png");
    bytes[bytes.size() / 2] = char(~bytes[bytes.size() / 2]);
    putFile(folder / "a.png", bytes);
    expectRefused(relief({"info", folder / "a.png"}), Failure::input, {"a.png", "damaged"});
    expectRefused(render(folder, cagePath("plane"), {"--height", folder / "a.png", "--scale", "1"}), Failure::input,
                  {"a.png", "damaged"});
}

// 8-bit texels that would take 268 MB as floats, counted with 240 MB of address space beyond a small picture's.
TEST_F(Maps, ofAnySizeAreCountedInLittleMemory) {
#ifdef __SANITIZE_ADDRESS__
    GTEST_SKIP() << "the sanitizer has its own memory";
#endif
    const auto countWithin = [&](int side, int kilobytes) {
        const std::vector<std::uint8_t> samples(std::size_t(side) * std::size_t(side), 64);
        putFile(folder / "large.tif", tiffOf<std::uint8_t>({.width = side, .height = side}, samples));
        const std::string program = fmt::format("{} info {}", RELIEF_PROGRAM, folder / "large.tif");
        return std::system(fmt::format("ulimit -v {}; exec {} > /dev/null 2>&1", kilobytes, program).c_str()) == 0;
    };
    int least = 100'000;
    while (least < 2'000'000 && !countWithin(16, least)) least += 50'000;
    EXPECT_TRUE(countWithin(8192, least + 190'000)) << least;
}

TEST_F(Maps, ofHugeHeightsAreLit) {
    const Image waves = sineImage(32, 2);
    for (const char* format : {"float", "unorm16", "unorm8", "bc4"})
        for (const double size : {1e6, 1e12}) {
            Image image = waves;
            for (float& texel : image.texels) texel *= float(size);
            writeImage(folder / "h.exr", image, SampleType::real);
            EXPECT_EQ(render(folder, cagePath("ball"), {"--height", folder / "h.exr", "--map-format", format}).exitCode,
                      0);
            const Image picture = readImage(folder / "out.png");
            const auto dark = std::ranges::count_if(picture.texels, [](float value) { return value < 0.03f; });
            EXPECT_LT(dark, std::ssize(picture.texels) / 50) << format << ' ' << size;
        }
}

TEST(Numbers, thatAreNotFiniteAreRefusedByEveryVerb) {
    const std::string cube = cagePath("cube");
    const std::pair<Words, const char*> cases[] = {
        {{"bench", "--compare", "a.json", "b.json", "--tolerance", "nan"}, "--tolerance"},
        {{"bench", "--compare", "a.json", "b.json", "--tolerance", "inf"}, "--tolerance"},
        {{"check", cube, "--scale", "nan"}, "--scale"},
        {{"animate", cube, "--fps", "nan", "-o", "a.mp4"}, "--fps"},
        {{"export", cube, "--mid", "inf", "-o", "a.obj"}, "--mid"},
        {{"info", cube, "--scale", "-inf"}, "--scale"},
        {{"render", cube, "--background", "0,nan,0", "-o", "a.png"}, "--background"},
    };
    for (const auto& [words, option] : cases) expectRefused(relief(words), Failure::usage, {option});
}

} // namespace
} // namespace relief::test
