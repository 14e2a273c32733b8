// Painting maps: texels and the points that they cover.
#include <cmath>

#include <gtest/gtest.h>

#include "bake/bake.h"
#include "meshes.h"

namespace relief::test {
namespace {

dvec2 texelCentre(int x, int y, int side) { return {(x + 0.5) / side, 1 - (y + 0.5) / side}; }

TEST(Atlas, paintsEveryTexelWithThePointThatItCovers) {
    constexpr int kSide = 32;
    const Cage cage = torusWithSeams();
    Atlas atlas(cage, kSide, kSide);
    std::vector<int> counts(kSide * kSide, 0);
    atlas.forEachTexel([&](int x, int y, const SurfacePoint& point) {
        ++counts[std::size_t(y * kSide + x)];
        EXPECT_LT(glm::length(point.st - texelCentre(x, y, kSide)), 1e-9);
        if (glm::any(glm::lessThan(point.uv, dvec2(0))) || glm::any(glm::greaterThan(point.uv, dvec2(1)))) return;
        // Between the samples of a face positions are linear.
        const dvec3 p = atlas.surface().limit(point.face, point.uv).p;
        EXPECT_LT(glm::length(point.p - p), 0.02) << point.face;
    });
    for (const int count : counts) EXPECT_LE(count, 1);
    EXPECT_GT(std::count(counts.begin(), counts.end(), 1), kSide * kSide / 2);
}

TEST(Atlas, spreadsTheNearestPaintedValueOverTheRest) {
    constexpr int kSide = 32;
    Cage cage = boundaryGrid(1, 1);
    for (vec2& st : cage.texCoords) st = 0.25f + 0.25f * st; // an island in the middle, with empty texels around
    Atlas atlas(cage, kSide, kSide);
    Image image{kSide, kSide, 1, std::vector<float>(kSide * kSide, -1)};
    atlas.forEachTexel([&](int x, int y, const SurfacePoint&) { *image.at(x, y) = 1; });
    EXPECT_GT(std::count(image.texels.begin(), image.texels.end(), -1.0f), 500);
    atlas.spread(image);
    EXPECT_EQ(std::count(image.texels.begin(), image.texels.end(), 1.0f), kSide * kSide);
}

} // namespace
} // namespace relief::test
