// Bounds of heights hold whatever mip level a lookup reads.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "maps.h"
#include "meshes.h"
#include "model/bounds.h"
#include "triangles/triangles.h"

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

/// One spike of the given height in a flat map of 1024 x 1024 texels: column 450, row 514. In mip level 6 it lifts a
/// texel of 64 columns from 448 on, and lookups half a texel beside that.
HeightMap spike(double height) {
    std::vector<float> texels(1024 * 1024, 0.0f);
    texels[514 * 1024 + 450] = 1;
    return makeHeightMap(1024, 1024, std::move(texels), 0, height, Wrap::repeat);
}
constexpr int kSpikeLevel = 6;

// A spike beside the box that the finest level does not find there, and a coarse one does.
TEST(Bounds, growWithTheMipLevel) {
    const HeightMap map = spike(1);
    const HeightPyramid pyramid(map);
    const TexBox box{vec2(0.516f, 0.49f), vec2(0.532f, 0.5f)}; // columns 528 to 544
    EXPECT_EQ(pyramid.range(box).highest, 0);
    EXPECT_EQ(pyramid.range(box, kSpikeLevel).highest, 1);
    EXPECT_GT(sampleHeight(levelOf({map, {}}, toWords(map), kSpikeLevel), dvec2(0.525, 0.495)).h, 0);
}

// The view is a slab above a flat grid: what the spike lifts into it must be drawn, where a coarse level spreads it
// too.
TEST(Bounds, hideNoFaceThatACoarseLevelLiftsIntoView) {
    constexpr double kLifted = 1e-4;
    const Cage cage = boundaryGrid(64, 64);
    const Surface surface = buildSurface(cage, {.isolation = 1});
    const ReferenceSurface reference(cage, {.isolation = 1});
    const HeightMap map = spike(10), mip = levelOf({map, {}}, toWords(map), kSpikeLevel);
    Device device;
    const SurfaceModel model(device, {.surface = &surface, .cagePositions = cage.positions, .height = &map});
    mat4 worldToClip(0);
    worldToClip[1][1] = float(1 / kLifted);
    worldToClip[3] = vec4(0, -2, 0.5f, 1);
    const EdgeRates fine{uniformRates(model, 4), Spacing::equal, {}},
        coarse{uniformRates(model, 4), Spacing::equal, std::vector<float>(model.cornerFlags.size(), kSpikeLevel)};
    const std::vector<char> before = visibleFaces(model, worldToClip, {}, fine),
                            after = visibleFaces(model, worldToClip, {}, coarse);
    EXPECT_LT(std::ranges::count(before, 1), 200);
    EXPECT_LT(std::ranges::count(after, 1), 3000); // of 4096
    int missingCount = 0;
    for (int face = 0; face < reference.faceCount(); ++face) {
        const double h = sampleHeight(mip, reference.texture(face, dvec2(0.5)).st).h;
        if (h <= kLifted) continue;
        missingCount += before[std::size_t(face)] == 0 ? 1 : 0;
        EXPECT_TRUE(after[std::size_t(face)]) << "face " << face << " is lifted by " << h;
    }
    EXPECT_GT(missingCount, 3) << "bounds of level 0 would hide them";
}

} // namespace
} // namespace relief::test
