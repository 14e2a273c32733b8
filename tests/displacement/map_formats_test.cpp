// Formats of height maps: what they keep, and the words that the device reads.
#include "maps.h"
#include "support.h"

namespace relief::test {
namespace {

double worstOf(const HeightMap& a, const HeightMap& b) {
    double worst = 0;
    for (std::size_t i = 0; i < a.texels.size(); ++i)
        worst = std::max(worst, std::abs(double(a.texels[i]) - b.texels[i]));
    return worst;
}

TEST(Formats, areOffByNoMoreThanTheirSteps) {
    const HeightMap map = waves(37, 22);
    const double range = double(map.highest) - map.lowest;
    const auto off = [&](MapFormat format) { return worstOf(map, encode(map, format).decoded); };
    EXPECT_EQ(off(MapFormat::real), 0);
    EXPECT_LE(off(MapFormat::half), 0.5 * 0x1p-11);
    EXPECT_LE(off(MapFormat::unorm16), 0.51 * range / 65535);
    EXPECT_LE(off(MapFormat::unorm8), 0.51 * range / 255);
    EXPECT_GT(off(MapFormat::unorm8), 0.4 * range / 255);
    EXPECT_LE(off(MapFormat::bc4), 0.05 * range); // a fourteenth of what a block spans
    EXPECT_GT(off(MapFormat::bc4), 0);
    const HeightMap decoded = encode(map, MapFormat::unorm16).decoded;
    EXPECT_EQ(decoded.mid, 0.1);
    EXPECT_EQ(decoded.scale, 2);
    EXPECT_EQ(decoded.wrap, Wrap::clamp);
}

TEST(Formats, keepAFlatMap) {
    const HeightMap flat = makeHeightMap(5, 5, std::vector<float>(25, 0.75f), 0, 1, Wrap::repeat);
    for (const MapFormat format : {MapFormat::half, MapFormat::unorm16, MapFormat::unorm8, MapFormat::bc4})
        EXPECT_EQ(worstOf(flat, encode(flat, format).decoded), 0) << int(format);
}

TEST(Bc4, hasTheBitsOfTheSpecification) {
    // Two end points, then three bits per texel, the first texel lowest; red0 > red1: six values between.
    const std::array<std::uint8_t, 8> block{255, 0, 0b10'001'000, 0, 0, 0, 0, 0};
    const std::array<float, 16> values = decodeBc4(block);
    EXPECT_FLOAT_EQ(values[0], 1);        // 0: red0
    EXPECT_FLOAT_EQ(values[1], 0);        // 1: red1
    EXPECT_FLOAT_EQ(values[2], 6.0f / 7); // 2: the first between
    const std::array<std::uint8_t, 8> other{0, 255, 0b10'111'110, 0, 0, 0, 0, 0};
    const std::array<float, 16> fewer = decodeBc4(other);
    EXPECT_FLOAT_EQ(fewer[0], 0);        // 6: zero
    EXPECT_FLOAT_EQ(fewer[1], 1);        // 7: one
    EXPECT_FLOAT_EQ(fewer[2], 1.0f / 5); // 2: of four between
}

TEST(Bc4, isExactForItsOwnValuesAndNearForRamps) {
    std::array<float, 16> own;
    for (std::size_t i = 0; i < 16; ++i) own[i] = (float(i % 8) * 224 + 28 * 0) / 7 / 255; // 0, 32/255, ... 224/255
    const std::array<float, 16> back = decodeBc4(encodeBc4(own));
    for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(back[i], own[i], 1e-6) << i;
    std::array<float, 16> ramp;
    for (std::size_t i = 0; i < 16; ++i) ramp[i] = 0.2f + 0.02f * float(i);
    const std::array<float, 16> near = decodeBc4(encodeBc4(ramp));
    for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(near[i], ramp[i], 0.3 / 14 + 2.0 / 255) << i;
}

// --- words

TEST(MapWords, takeTheBytesOfEveryMip) {
    // 8 x 4 texels, then 4 x 2, 2 x 1, 1 x 1: 32 + 8 + 2 + 1, each level in whole words.
    EXPECT_EQ(mapBytes(MapFormat::real, 8, 4), 4u * 43);
    EXPECT_EQ(mapBytes(MapFormat::half, 8, 4), 64u + 16 + 4 + 4);
    EXPECT_EQ(mapBytes(MapFormat::unorm16, 8, 4), 64u + 16 + 4 + 4);
    EXPECT_EQ(mapBytes(MapFormat::unorm8, 8, 4), 32u + 8 + 4 + 4);
    EXPECT_EQ(mapBytes(MapFormat::bc4, 8, 4), 8u * (2 + 1 + 1 + 1)); // blocks of 4 x 4, begun ones whole
    EXPECT_EQ(mapBytes(MapFormat::unorm8, 5, 3), 16u + 4 + 4);
    EXPECT_EQ(mapBytes(MapFormat::unorm8, 1, 1), 4u);
    for (const auto& [word, format, help] : kMapFormats)
        for (const auto& [width, height] : {std::pair(37, 22), {1, 1}, {64, 64}, {3, 100}}) {
            const EncodedMap map = encode(waves(width, height), format);
            EXPECT_EQ(toWords(map.decoded, map.encoding).words.size() * 4, mapBytes(format, width, height))
                << word << " " << width << " x " << height;
        }
}

TEST(MapWords, holdTheMapAndMipsWithinTheirRoundOff) {
    for (const auto& [word, format, help] : kMapFormats) {
        const EncodedMap encoded = encode(waves(37, 22), format);
        const HeightMap& map = encoded.decoded;
        const MapWords words = toWords(encoded.decoded, encoded.encoding);
        ASSERT_EQ(words.firsts.size(), 6u); // 37, 18, 9, 4, 2, 1
        EXPECT_LT(worstOf(levelOf(encoded, words, 0), map), 1e-7) << word;
        // Means of the map's own texels, where whole squares of them make a mip's texel.
        double worst = 0;
        for (std::uint32_t level = 1; level < 4; ++level) {
            const HeightMap mip = levelOf(encoded, words, level);
            const int side = 1 << level;
            for (int y = 0; y < 22 / side; ++y)
                for (int x = 0; x < 37 / side; ++x) {
                    double sum = 0;
                    for (int k = 0; k < side * side; ++k)
                        sum += map.texels[std::size_t((y * side + k / side) * 37 + x * side + k % side)];
                    const float stored = mip.texels[std::size_t(y * mip.width + x)];
                    worst = std::max(worst, std::abs(sum / (side * side) - double(stored)));
                }
        }
        EXPECT_LT(worst, double(words.roundOff) + 1e-6) << word;
        const double range = double(map.highest) - double(map.lowest);
        EXPECT_LT(words.roundOff, format == MapFormat::bc4 ? 0.08 * range : 0.003 * range) << word;
    }
}

TEST(MapWords, holdNumbersThatTheirScaleTurnsIntoHeights) {
    for (const MapFormat format : {MapFormat::unorm16, MapFormat::unorm8}) {
        const EncodedMap encoded = encode(waves(16, 16), format);
        const HeightMap& map = encoded.decoded;
        const MapWords words = toWords(encoded.decoded, encoded.encoding);
        const double number = words.words[0] & (format == MapFormat::unorm16 ? 0xffff : 0xff);
        EXPECT_NEAR(words.scale * (number - words.mid), map.scale * (double(map.texels[0]) - map.mid), 1e-6);
    }
}

TEST(Formats, ofHalvesRefuseWhatIsTooLarge) {
    const HeightMap far = makeHeightMap(2, 1, {0, 1e6f}, 0, 1, Wrap::repeat);
    expectFailure(Failure::input, {"1000000", "65504"}, [&] { encode(far, MapFormat::half); });
}

TEST(Formats, ofFilesAreTheSmallestThatKeepThem) {
    const TemporaryFolder folder;
    Warnings warnings;
    const Image image{
        .width = 4, .height = 2, .channels = 1, .texels = {0, 0.125f, 0.25f, 0.5f, 0.625f, 0.75f, 0.9f, 1}};
    const auto load = [&](const char* name, SampleType type, std::optional<MapFormat> format = {}) {
        writeImage(folder / name, image, type);
        return loadHeightMap(folder / name, {.scale = 1, .format = format}, warnings.warn());
    };
    for (const auto& [name, type, format] : {std::tuple("a.exr", SampleType::real, MapFormat::real),
                                             {"b.exr", SampleType::half, MapFormat::half},
                                             {"c.png", SampleType::uint16, MapFormat::unorm16},
                                             {"d.png", SampleType::uint8, MapFormat::unorm8}}) {
        const EncodedMap map = load(name, type);
        EXPECT_EQ(map.encoding.format, format) << name;
        EXPECT_LT(worstOf(levelOf(map, toWords(map.decoded, map.encoding), 0), map.decoded), 1e-7) << name;
    }
    EXPECT_EQ(fileFormat({.sample = "int16"}), MapFormat::real); // signed: half of its values are below 0
    EXPECT_EQ(load("e.png", SampleType::uint16, MapFormat::real).encoding.format, MapFormat::real);
    EXPECT_EQ(load("f.exr", SampleType::real, MapFormat::bc4).encoding.blocks.size(), 8u);
}

} // namespace
} // namespace relief::test
