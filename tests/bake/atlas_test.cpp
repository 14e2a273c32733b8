// Which point of the limit surface each texel of a map covers.
#include <gtest/gtest.h>

#include "bake/bake.h"
#include "meshes.h"

namespace relief::test {
namespace {

constexpr int kSide = 96;

struct Painted {
    std::vector<int> counts = std::vector<int>(kSide * kSide);
    std::vector<SurfacePoint> points = std::vector<SurfacePoint>(kSide * kSide);

    explicit Painted(Atlas& atlas) {
        atlas.forEachTexel([&](int x, int y, const SurfacePoint& point) {
            ++counts[std::size_t(y * kSide + x)];
            points[std::size_t(y * kSide + x)] = point;
        });
    }
};

dvec2 texelCentre(int index) { return {(index % kSide + 0.5) / kSide, 1 - (index / kSide + 0.5) / kSide}; }

TEST(Atlas, texelsLearnTheSurfaceAtTheirOwnTextureCoordinates) {
    Atlas atlas(cubeOfIslands(), kSide, kSide);
    const Painted painted(atlas);
    int paintedCount = 0;
    for (int i = 0; i < kSide * kSide; ++i) {
        if (painted.counts[std::size_t(i)] == 0) continue;
        ++paintedCount;
        EXPECT_EQ(painted.counts[std::size_t(i)], 1) << i;
        const SurfacePoint& point = painted.points[std::size_t(i)];
        EXPECT_LT(glm::length(point.st - texelCentre(i)), 1e-9) << i;
        const bool isInside =
            glm::all(glm::greaterThanEqual(point.uv, dvec2(0))) && glm::all(glm::lessThanEqual(point.uv, dvec2(1)));
        if (!isInside) continue;
        const dvec3 p = atlas.surface().limit(point.face, point.uv).p;
        EXPECT_LT(glm::length(p - point.p), 0.02) << i; // between samples, linear
        EXPECT_LT(glm::length(atlas.surface().texture(point.face, point.uv).st - point.st), 0.5 / kSide) << i;
    }
    EXPECT_GT(paintedCount, kSide * kSide / 4);
    EXPECT_LT(paintedCount, kSide * kSide) << "islands leave texels between them";
}

TEST(Atlas, allFacesArePainted) {
    const Cage cage = cubeOfIslands();
    Atlas atlas(cage, kSide, kSide);
    const Painted painted(atlas);
    std::vector<int> texels(cage.faceCount());
    for (std::size_t i = 0; i < painted.counts.size(); ++i)
        if (painted.counts[i] > 0) ++texels[std::size_t(painted.points[i].face)];
    for (std::size_t face = 0; face < texels.size(); ++face) EXPECT_GT(texels[face], 100) << face;
}

TEST(Atlas, spreadCoversWhatIsNotPainted) {
    Atlas atlas(cubeOfIslands(), kSide, kSide);
    Image image{.width = kSide, .height = kSide, .channels = 1, .texels = std::vector<float>(kSide * kSide, -1)};
    atlas.forEachTexel([&](int x, int y, const SurfacePoint& point) { *image.at(x, y) = float(point.face); });
    const std::vector<float> before = image.texels;
    atlas.spread(image);
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (before[i] >= 0) {
            EXPECT_EQ(image.texels[i], before[i]) << i;
        }
        EXPECT_GE(image.texels[i], 0) << i;
        EXPECT_EQ(image.texels[i], std::floor(image.texels[i])) << "a value of one face, none between two";
    }
}

} // namespace
} // namespace relief::test
