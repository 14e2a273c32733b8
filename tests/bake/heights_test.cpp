// Heights of sculpts whose heights are known.
#include <algorithm>

#include <gtest/gtest.h>

#include "bake/sculpts.h"

namespace relief::test {
namespace {

constexpr int kSide = 64;
const UvTexelOptions kFlat{.width = kSide, .height = kSide, .wrap = Wrap::clamp};

/// The point of the grid's plane under a texel's centre, x and -z.
dvec2 placeOf(int x, int y) { return 4.0 * dvec2((x + 0.5) / kSide, 1 - (y + 0.5) / kSide); }

double wave(double x, double z) { return 0.3 * std::sin(2 * x) * std::cos(1.5 * z); }

template <typename Check>
void forEachHeight(const BakedHeights& baked, const Check& check) {
    for (int y = 0; y < baked.height; ++y)
        for (int x = 0; x < baked.width; ++x)
            check(placeOf(x, y), baked.heights[std::size_t(y * baked.width + x)],
                  baked.states[std::size_t(y * baked.width + x)]);
}

TEST(BakedHeights, ofASineAreTheSine) {
    const Baking baking(squareGrid(), kFlat);
    const MeasuredSurface sculpt = measured(hillsOverGrid(800, wave));
    const BakedHeights baked = baking.bake(sculpt, {1, 1});
    EXPECT_EQ(baked.texelCount, std::uint64_t(kSide * kSide));
    EXPECT_EQ(baked.voidCount, 0u);
    EXPECT_EQ(baked.behindCount, 0u);
    // Triangles of side 1/200 are at most 1.2 / 8 / 200^2 * 2 off.
    forEachHeight(baked, [](dvec2 p, float h, TexelState) { EXPECT_NEAR(h, wave(p.x, p.y), 1e-5); });

    // Four lines per texel see the mean of the sine, which is smaller by (1/16)^2 (2^2 + 1.5^2) / 24.
    UvTexelOptions four = kFlat;
    four.samplesPerSide = 2;
    const BakedHeights means = Baking(squareGrid(), four).bake(sculpt, {1, 1});
    const double step = 4.0 / kSide, factor = std::cos(2 * step / 4) * std::cos(1.5 * step / 4);
    forEachHeight(means, [&](dvec2 p, float h, TexelState) { EXPECT_NEAR(h, factor * wave(p.x, p.y), 1e-5); });
}

TEST(BakedHeights, lieOnABumpySphere) {
    const auto radiusAt = [](const dvec3& d) { return 1.2 + 0.05 * std::sin(7 * d.x) * std::sin(6 * d.y + 1); };
    const TriangleMesh sphere = sheetThrough(700, [&](double s, double t) {
        const double a = 2 * std::numbers::pi * s, b = std::numbers::pi * (t - 0.5);
        const dvec3 d(std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b));
        return radiusAt(d) * d;
    });
    const Baking baking(cubeOfIslands(), {.width = 96, .height = 96});
    const BakedHeights baked = baking.bake(measured(sphere), {2, 2});
    EXPECT_EQ(baked.voidCount, 0u);
    std::vector<TexelSample> samples;
    baking.texels.listSamples(0, 96, samples);
    ASSERT_GT(samples.size(), 2500u);
    for (const TexelSample& sample : samples) {
        if (!sample.isInside) continue;
        const dvec2 uv(sample.uv);
        const dvec3 q = baking.reference.limit(sample.face, uv).p +
                        double(baked.heights[sample.texel]) * baking.reference.normal(sample.face, uv);
        EXPECT_NEAR(glm::length(q), radiusAt(glm::normalize(q)), 1e-4);
    }
}

TEST(BakedHeights, haveVoidsWhereTheSculptHasAHole) {
    // A tilted plane without x in (1,2) and -z in (1,3).
    const auto plane = [](double x, double z) { return 0.1 * x - 0.05 * z; };
    const TriangleMesh sheet = withHole(hillsOverGrid(80, plane), {1, 1}, {2, 3});
    const BakedHeights baked = Baking(squareGrid(), kFlat).bake(measured(sheet), {1, 1});
    EXPECT_EQ(baked.voidCount, std::uint64_t(kSide / 4 * kSide / 2));
    // A membrane in a plane is that plane.
    forEachHeight(baked, [&](dvec2 p, float h, TexelState state) {
        const bool isInHole = p.x > 1 && p.x < 2 && p.y > 1 && p.y < 3;
        EXPECT_EQ(state, isInHole ? TexelState::missed : TexelState::hit);
        EXPECT_NEAR(h, plane(p.x, p.y), 2e-5) << p.x << " " << p.y;
    });
}

TEST(BakedHeights, areOfTheNearestSheetThatFacesOutwards) {
    // Up from the surface: a sheet that faces down at 0.1 over x < 2 alone, sheets that face up at 0.2 and 0.3.
    const auto flat = [](double height) { return hillsOverGrid(8, [height](double, double) { return height; }); };
    TriangleMesh sheets = flat(0.2), under = hillsOverGrid(8, [](double, double) { return 0.1; });
    for (vec3& p : under.positions) p.x /= 2;
    turnOver(under);
    append(sheets, under);
    append(sheets, flat(0.3));
    const BakedHeights baked = Baking(squareGrid(), kFlat).bake(measured(sheets), {1, 1});
    forEachHeight(baked, [](dvec2, float h, TexelState) { EXPECT_NEAR(h, 0.2, 1e-6); });
    EXPECT_EQ(baked.behindCount, std::uint64_t(kSide * kSide / 2));
    const Baking strict(squareGrid(), kFlat);
    const BakedHeights dropped = bakeHeights(strict.reference, measured(sheets), strict.texels,
                                             {.lines = {.reach = {1, 1}}, .dropsBehind = true});
    EXPECT_EQ(dropped.voidCount, std::uint64_t(kSide * kSide / 2));
    // Nearer on the other side.
    append(sheets, flat(-0.15));
    const BakedHeights below = Baking(squareGrid(), kFlat).bake(measured(sheets), {1, 1});
    forEachHeight(below, [](dvec2, float h, TexelState) { EXPECT_NEAR(h, -0.15, 1e-6); });
    // Beyond reach on that side.
    const BakedHeights within = Baking(squareGrid(), kFlat).bake(measured(sheets), {1, 0.1});
    forEachHeight(within, [](dvec2, float h, TexelState) { EXPECT_NEAR(h, 0.2, 1e-6); });
}

TEST(BakedHeights, agreeAcrossSeams) {
    // A torus of islands, one per face, each with its own place in the map.
    const Cage cage = withIslands(torusWithSeams());
    const TriangleMesh bumpy = sheetThrough(500, [](double s, double t) {
        const double a = 2 * std::numbers::pi * s, b = 2 * std::numbers::pi * t;
        const double r = 0.8 + 0.04 * std::sin(9 * a) * std::cos(5 * b);
        return dvec3((2 + r * std::cos(b)) * std::cos(a), r * std::sin(b), -(2 + r * std::cos(b)) * std::sin(a));
    });
    const MeasuredSurface sculpt = measured(bumpy);
    const auto largestGap = [&](double margin) {
        const Baking baking(cage, {.width = 512, .height = 512, .margin = margin});
        const HeightMap map = baking.mapOf(baking.bake(sculpt, {1, 1}));
        const EdgeIncidences edges = edgeIncidences(baking.surface);
        double gap = 0;
        for (std::size_t edge = 0; edge < baking.surface.edges.size(); ++edge)
            for (int i = 0; i <= 16; ++i) {
                double heights[2] = {};
                for (std::size_t k = 0; k < 2; ++k) {
                    const Incidence& side = edges.of(edge)[k];
                    const dvec2 uv =
                        sidePoint(4, int(side.side), std::lerp(double(side.start), double(side.end), i / 16.0));
                    heights[k] = sampleHeight(map, baking.reference.texture(int(side.face), uv).st).h;
                }
                gap = std::max(gap, std::abs(heights[0] - heights[1]));
            }
        return gap;
    };
    EXPECT_LT(largestGap(2), 0.001);
    EXPECT_GT(largestGap(0), 0.003); // what it would be without texels beyond the borders
}

TEST(UvTexels, sayWhichIslandsLieOverEachOther) {
    Cage cage = boundaryGrid(2, 1);
    const Baking apart(cage, {.width = 32, .height = 32, .wrap = Wrap::clamp});
    std::vector<TexelSample> samples;
    apart.texels.listSamples(0, 32, samples);
    EXPECT_EQ(apart.texels.overlap().sampleCount, 0u);
    cage.texCorners = {0, 1, 4, 3, 0, 1, 4, 3};
    const Baking over(cage, {.width = 32, .height = 32, .wrap = Wrap::clamp});
    samples.clear();
    over.texels.listSamples(0, 32, samples);
    EXPECT_GT(over.texels.overlap().sampleCount, 400u);
    EXPECT_EQ(over.texels.overlap().faces[0], 0);
    EXPECT_EQ(over.texels.overlap().faces[1], 1);
}

TEST(UvTexels, giveIslandsBelowATexelOneTexelAtLeast) {
    Cage cage = boundaryGrid(1, 1);
    for (vec2& st : cage.texCoords) st = 0.51f + 0.001f * st;
    const Baking baking(cage, {.width = 16, .height = 16});
    std::vector<TexelSample> samples;
    baking.texels.listSamples(0, 16, samples);
    const bool isThere = std::ranges::any_of(samples, [](const TexelSample& s) { return s.texel == 7 * 16 + 8; });
    EXPECT_TRUE(isThere);
}

} // namespace
} // namespace relief::test
