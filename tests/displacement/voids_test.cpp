// Voids of elevation models: what counts as one, and what takes its place.
#include <cmath>
#include <limits>

#include "displacement/displacement.h"
#include "support.h"
#include "tiff.h"

namespace relief::test {
namespace {

constexpr float kLowestFloat = std::numeric_limits<float>::lowest();

struct Voids : testing::Test {
    TemporaryFolder folder;
    Warnings warnings;

    HeightMap load(const HeightOptions& options = {}) {
        warnings.lines.clear();
        return loadHeightMap(folder / "a.tif", options, warnings.warn()).decoded;
    }
    /// Of floats or integers, 16 x 16, everything 100 to 115 but for the texels from (4,4) to (5,5).
    template <typename T>
    HeightMap loadWith(T nothing, TiffDesc desc) {
        std::vector<T> samples;
        for (int y = 0; y < 16; ++y)
            for (int x = 0; x < 16; ++x) samples.push_back(x >= 4 && x < 6 && y >= 4 && y < 6 ? nothing : T(100 + x));
        desc.width = desc.height = 16;
        putFile(folder / "a.tif", tiffOf<T>(desc, samples));
        return load();
    }
    /// The smallest and largest texel, after a file with such samples in a row.
    std::pair<float, float> rangeOf(const std::vector<float>& samples, const std::string& noData = "") {
        putFile(
            folder / "a.tif",
            tiffOf<float>({.width = int(samples.size()), .height = 1, .sampleFormat = 3, .noData = noData}, samples));
        const HeightMap map = load();
        return {map.lowest, map.highest};
    }
};

TEST_F(Voids, thatTheFileNamesAreFilledFromAround) {
    for (const float nothing : {-9999.0f, kLowestFloat, 0.0f, 1e20f}) {
        const HeightMap map = loadWith<float>(nothing, {.sampleFormat = 3, .noData = fmt::format("{:.9g}", nothing)});
        EXPECT_EQ(map.lowest, 100);
        EXPECT_EQ(map.highest, 115);
        ASSERT_EQ(warnings.lines.size(), 1u);
        EXPECT_TRUE(warnings.has("4 of 256 texels are voids")) << warnings.lines[0];
        EXPECT_TRUE(warnings.has("GDAL_NODATA")) << warnings.lines[0];
        for (const int x : {4, 5}) EXPECT_NEAR(map.texels[std::size_t(16 * 4 + x)], 100 + x, 1.5) << "smooth: " << x;
    }
    const HeightMap map = loadWith<float>(NAN, {.sampleFormat = 3, .noData = "nan"});
    EXPECT_EQ(map.lowest, 100);
}

TEST_F(Voids, ofIntegersAreFilledToo) {
    EXPECT_EQ(loadWith<std::int16_t>(-32768, {.sampleFormat = 2, .noData = "-32768"}).lowest, 100);
    EXPECT_EQ(loadWith<std::int16_t>(-9999, {.sampleFormat = 2}).lowest, 100);
    const HeightMap map = loadWith<std::uint16_t>(65535, {.sampleFormat = 1, .noData = "65535"});
    EXPECT_NEAR(map.highest, 115.0 / 65535, 1e-8);
    EXPECT_TRUE(warnings.has("4 of 256 texels are voids (65535 by its GDAL_NODATA)"));
    for (const float texel : map.texels)
        EXPECT_NEAR(double(texel) * 65535, std::round(double(texel) * 65535), 2e-3) << "a number of the format";
}

/// A chunk of a PNG: length, type, data and checksum (section 5.3, annex D).
std::string pngChunk(const std::string& type, const std::string& data) {
    const auto bigEndian = [](std::uint32_t n) {
        return std::string{char(n >> 24), char(n >> 16), char(n >> 8), char(n)};
    };
    std::uint32_t crc = ~0u;
    for (const char letter : type + data) {
        crc ^= std::uint8_t(letter);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ ((crc & 1u) != 0 ? 0xedb88320u : 0u);
    }
    return bigEndian(std::uint32_t(data.size())) + type + data + bigEndian(~crc);
}

// A PNG says which grey is nothing by making it transparent, as GDAL writes it.
TEST_F(Voids, ofPngsAreTheGreyThatIsTransparent) {
    const auto loadPng = [&](std::uint16_t nothing, SampleType type, const std::string& transparent) {
        const float most = type == SampleType::uint16 ? 65535 : 255;
        Image image{16, 16, 1, {}};
        for (int i = 0; i < 256; ++i)
            image.texels.push_back(float(i / 32 == 2 && i % 16 < 4 ? nothing : 100 + i % 16) / most);
        writeImage(folder / "b.png", image, type);
        std::string bytes = readFile(folder / "b.png");
        constexpr std::size_t kAfterHeader = 8 + 12 + 13;
        if (!transparent.empty()) bytes.insert(kAfterHeader, pngChunk("tRNS", transparent));
        putFile(folder / "b.png", bytes);
        warnings.lines.clear();
        return loadHeightMap(folder / "b.png", {.scale = most}, warnings.warn()).decoded;
    };
    for (const std::uint16_t nothing : {0, 115, 65535}) {
        const HeightMap map = loadPng(nothing, SampleType::uint16, {char(nothing >> 8), char(nothing)});
        EXPECT_NEAR(map.lowest * 65535, 100, 0.01) << nothing;
        EXPECT_LT(map.highest * 65535, 115.01) << nothing;
        EXPECT_TRUE(warnings.has(fmt::format("texels are voids ({} by its tRNS)", nothing)));
    }
    EXPECT_NEAR(loadPng(255, SampleType::uint8, {0, char(255)}).highest * 255, 115, 0.01);
    // Without the chunk they are heights as all others.
    EXPECT_EQ(loadPng(0, SampleType::uint16, "").lowest, 0);
    EXPECT_FALSE(warnings.has("voids"));
}

TEST_F(Voids, withoutATagStandApart) {
    for (const float nothing : {-9999.0f, -32767.0f, -32768.0f, -99999.0f, kLowestFloat, -1e38f, 9.96921e36f}) {
        EXPECT_EQ(rangeOf({0, nothing, 300, 200}), std::pair(0.0f, 300.0f)) << nothing;
        EXPECT_TRUE(warnings.has("1 of 4 texels are voids")) << nothing;
        EXPECT_TRUE(warnings.has("stands apart")) << nothing;
    }
    EXPECT_EQ(rangeOf({-9999, 0, kLowestFloat, 300, -32768}), std::pair(0.0f, 300.0f)) << "several at once";
}

TEST_F(Voids, areNoneWhereTheNumberIsAHeightAmongOthers) {
    EXPECT_EQ(rangeOf({-9999, -9000, -4000, 0}), std::pair(-9999.0f, 0.0f)) << "less far from the rest than this spans";
    EXPECT_EQ(rangeOf({-10900, -9999, 8800}), std::pair(-10900.0f, 8800.0f)) << "the deep sea";
    EXPECT_EQ(rangeOf({-9999, -9999}), std::pair(-9999.0f, -9999.0f)) << "a plane";
    EXPECT_EQ(rangeOf({-9998, 0, 1}), std::pair(-9998.0f, 1.0f)) << "not a customary number";
    EXPECT_EQ(rangeOf({-32768, -1, 32767}), std::pair(-32768.0f, 32767.0f)) << "the full range of 16 bits";
    EXPECT_TRUE(warnings.lines.empty());
}

TEST_F(Voids, aloneAreNoMap) {
    expectFailure(Failure::input, {folder / "a.tif", "all 3 texels are voids", "-9999"}, [&] {
        rangeOf({-9999, -9999, -9999}, "-9999");
    });
}

TEST_F(Voids, doNotHideTexelsThatAreNoNumbers) {
    expectFailure(Failure::input, {"column 2, row 0", "nan"}, [&] { rangeOf({-9999, 1, NAN, 2}, "-9999"); });
}

// A ramp with a hole: the fill follows it, and never leaves the range of the heights.
TEST_F(Voids, inARampContinueIt) {
    std::vector<float> samples;
    for (int y = 0; y < 33; ++y)
        for (int x = 0; x < 33; ++x) samples.push_back(x > 12 && x < 20 && y > 12 && y < 20 ? -9999.0f : float(x + y));
    putFile(folder / "a.tif", tiffOf<float>({.width = 33, .height = 33, .sampleFormat = 3}, samples));
    const HeightMap map = load();
    for (int y = 13; y < 20; ++y)
        for (int x = 13; x < 20; ++x) {
            const float texel = map.texels[std::size_t(33 * y + x)];
            EXPECT_NEAR(texel, x + y, 6) << x << ' ' << y;
            EXPECT_GE(texel, 0);
            EXPECT_LE(texel, 64);
        }
}

TEST_F(Voids, largerThanThePyramidsFirstLevelsAreFilled) {
    std::vector<float> samples(200 * 100, -9999);
    samples[0] = 7, samples[19999] = 9;
    putFile(folder / "a.tif",
            tiffOf<float>({.width = 200, .height = 100, .sampleFormat = 3, .noData = "-9999"}, samples));
    const HeightMap map = load();
    EXPECT_EQ(map.lowest, 7);
    EXPECT_EQ(map.highest, 9);
}

TEST_F(Voids, signedIntegersAreCageUnits) {
    putFile(folder / "a.tif", tiffOf<std::int16_t>({.width = 2, .height = 1, .sampleFormat = 2}, {100, -50}));
    const HeightMap map = load({.scale = 0.5});
    EXPECT_EQ(map.mid, 0);
    EXPECT_DOUBLE_EQ(sampleHeight(map, {0.25, 0.5}).h, 50);
    EXPECT_DOUBLE_EQ(sampleHeight(map, {0.75, 0.5}).h, -25);
    load();
    EXPECT_TRUE(warnings.lines.empty()) << "they have a unit: " << warnings.lines[0];
    EXPECT_EQ(load({.mid = 30}).mid, 30);
}

TEST_F(Voids, channelsAreChosenByNameAndTheFirstOfSeveralLayersIsNamed) {
    writeImage(folder / "a.tif", {2, 1, 1, {1, 2}}, SampleType::real);
    Image image{1, 1, 2, {5, 6}};
    writeImage(folder / "a.tif.exr", image, {{"color.R", SampleType::real}, {"height.Y", SampleType::real}});
    const auto read = [&](const std::string& channel) {
        return loadHeightMap(folder / "a.tif.exr", {.channel = channel}, warnings.warn()).decoded.texels.at(0);
    };
    EXPECT_EQ(read("height.Y"), 6);
    EXPECT_EQ(read("height"), 6);
    EXPECT_EQ(read("1"), 6);
    EXPECT_TRUE(warnings.lines.empty());
    EXPECT_EQ(read(""), 5);
    EXPECT_TRUE(warnings.has("2 layers (color, height)"));
    EXPECT_TRUE(warnings.has("color.R is taken"));
    expectFailure(Failure::input, {"no channel depth", "height.Y"}, [&] { read("depth"); });
}

} // namespace
} // namespace relief::test
