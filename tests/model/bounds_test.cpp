// Bounds of heights hold whatever mip level a lookup reads.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "maps.h"
#include "model/bounds.h"

namespace relief::test {
namespace {

/// A flat map with spikes here and there, of the height `scale`.
HeightMap spikes(int width, int height, Wrap wrap, std::mt19937& random) {
    std::vector<float> texels(std::size_t(width) * std::size_t(height), 0.0f);
    for (int i = 0; i < 6; ++i) texels[random() % texels.size()] = random() % 2 == 0 ? 1.0f : -1.0f;
    return makeHeightMap(width, height, std::move(texels), 0, 3, wrap);
}

void expectHeld(const Range& range, const HeightSample& sample, const std::string& words) {
    constexpr double kRounding = 1e-5;
    EXPECT_LE(sample.h, double(range.highest) + kRounding) << words;
    EXPECT_GE(sample.h, double(range.lowest) - kRounding) << words;
    EXPECT_LE(std::abs(sample.hs), double(range.slopeS) * (1 + kRounding) + kRounding) << words;
    EXPECT_LE(std::abs(sample.ht), double(range.slopeT) * (1 + kRounding) + kRounding) << words;
}

// Sizes that halve evenly and those that leave a rest; boxes inside, across the border and outside.
TEST(Bounds, holdWhatLookupsFindInEveryMipLevel) {
    std::mt19937 random(7);
    const auto unit = [&] { return float(random() % 4096) / 4096; };
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp})
        for (const auto& [width, height] : {std::pair(64, 64), {128, 32}, {100, 60}, {37, 90}}) {
            const EncodedMap map{spikes(width, height, wrap, random), {}};
            const MapWords words = toWords(map.decoded);
            const HeightPyramid pyramid(map.decoded, words.roundOff);
            for (int level = 0; level < int(words.firsts.size()); ++level) {
                const HeightMap mip = levelOf(map, words, std::uint32_t(level));
                for (int i = 0; i < 60; ++i) {
                    const vec2 lower(2 * unit() - 0.5f, 2 * unit() - 0.5f);
                    const TexBox box{lower, lower + 0.2f * vec2(unit(), unit())};
                    const Range range = pyramid.range(box, level);
                    for (int k = 0; k < 8; ++k) {
                        const vec2 st = glm::mix(box.lower, box.upper, vec2(unit(), unit()));
                        expectHeld(range, sampleHeight(mip, dvec2(st)),
                                   fmt::format("{} x {}, level {} at ({}, {})", width, height, level, st.x, st.y));
                    }
                }
            }
        }
}

// A spike beside the box that the finest level does not see there, and a coarse one does.
TEST(Bounds, growWithTheMipLevel) {
    std::vector<float> texels(64 * 64, 0.0f);
    texels[32 * 64 + 40] = 1;
    const HeightMap map = makeHeightMap(64, 64, std::move(texels), 0, 1, Wrap::repeat);
    const HeightPyramid pyramid(map);
    const TexBox box{vec2(0.25f, 0.4f), vec2(0.375f, 0.6f)}; // columns 16 to 24
    EXPECT_EQ(pyramid.range(box).highest, 0);
    EXPECT_EQ(pyramid.range(box, 3).highest, 1);
    const EncodedMap encoded{map, {}};
    EXPECT_GT(sampleHeight(levelOf(encoded, toWords(map), 3), dvec2(0.37, 0.5)).h, 0);
}

} // namespace
} // namespace relief::test
