#include "maps/fields.h"

namespace relief::test {
namespace {

constexpr double kTight = 2e-7; // of components that are floats

void expectNormal(const NormalMap& map, int i, int j, const dvec3& direction) {
    const vec3 n = map.normals[std::size_t(j * map.width + i)];
    EXPECT_LT(glm::length(dvec3(n) - glm::normalize(direction)), kTight) << i << ' ' << j;
}

TEST(NormalsOfHeights, ofAPlaneAreExactInsideAndHalfAsSteepAtAClampedBorder) {
    // h = 3 s - 2 t over a square of 4 by 0.5.
    const HeightMap map = heightsOf(16, 8, Wrap::clamp, [](double s, double t) { return 3 * s - 2 * t; });
    const NormalMap normals = computeNormalMap(map, {4, 0.5});
    EXPECT_EQ(normals.width, 16);
    EXPECT_EQ(normals.height, 8);
    EXPECT_EQ(normals.wrap, Wrap::clamp);
    for (int j = 0; j < 8; ++j)
        for (int i = 0; i < 16; ++i) {
            const double x = i == 0 || i == 15 ? 0.5 : 1, y = j == 0 || j == 7 ? 0.5 : 1;
            expectNormal(normals, i, j, {-x * 3 / 4, y * 2 / 0.5, 1});
        }
}

TEST(NormalsOfHeights, haveTheSlopesThatTheSurfaceIsDisplacedBy) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
        HeightMap map = noiseHeights(7, 5, wrap);
        map.scale = -0.3;
        map.mid = 0.4;
        const MapSize size(2, 3);
        const NormalMap normals = computeNormalMap(map, size);
        for (int j = 0; j < 5; ++j)
            for (int i = 0; i < 7; ++i) {
                const HeightSample sample = sampleHeight(map, {(i + 0.5) / 7, 1 - (j + 0.5) / 5});
                expectNormal(normals, i, j, {-sample.hs / size.x, -sample.ht / size.y, 1});
            }
    }
}

/// The largest angle, in radians, between normals of waves and the analytic ones.
double errorOfWaves(int width) {
    const MapSize size(2, 1);
    const HeightMap map = heightsOf(width, width / 2, Wrap::repeat, [](double s, double t) {
        return 0.1 * std::sin(2 * kPi * s) * std::cos(4 * kPi * t);
    });
    const NormalMap normals = computeNormalMap(map, size);
    double largest = 0;
    for (int j = 0; j < map.height; ++j)
        for (int i = 0; i < map.width; ++i) {
            const double s = (i + 0.5) / map.width, t = 1 - (j + 0.5) / map.height;
            const double hs = 0.1 * 2 * kPi * std::cos(2 * kPi * s) * std::cos(4 * kPi * t);
            const double ht = -0.1 * 4 * kPi * std::sin(2 * kPi * s) * std::sin(4 * kPi * t);
            const dvec3 exact = glm::normalize(dvec3(-hs / size.x, -ht / size.y, 1));
            const dvec3 n(normals.normals[std::size_t(j * map.width + i)]);
            largest = std::max(largest, glm::length(n - exact));
        }
    return largest;
}

TEST(NormalsOfHeights, approachTheAnalyticOnesWithTheSquareOfTheTexel) {
    EXPECT_LT(errorOfWaves(256), 2e-3);
    EXPECT_NEAR(errorOfWaves(64) / errorOfWaves(128), 4, 0.2);
    EXPECT_NEAR(errorOfWaves(128) / errorOfWaves(256), 4, 0.2);
}

TEST(NormalsOfHeights, haveCodesWithEitherDirectionOfY) {
    const NormalMap map = normalsOf(1, 1, Wrap::repeat, [](int, int) { return dvec2(-0.5, -1); }); // n ~ (1, 2, 2)
    const Image up = toCodes(map, NormalY::up), down = toCodes(map, NormalY::down);
    ASSERT_EQ(up.channels, 3);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(up.texels[k], 0.5 + 0.5 * (k == 0 ? 1 : 2) / 3.0, kTight);
    EXPECT_NEAR(down.texels[1], 0.5 - 0.5 * 2 / 3.0, kTight);
    EXPECT_EQ(down.texels[0], up.texels[0]);
    EXPECT_EQ(down.texels[2], up.texels[2]);
}

TEST(NormalsOfHeights, sayHowSteepTheyAre) {
    const NormalMap map = normalsOf(3, 1, Wrap::repeat, [](int i, int) { return dvec2(0.6 * i, -0.4 * i * i); });
    EXPECT_NEAR(computeSteepestSlope(map), glm::degrees(std::atan(2.0)), 1e-4);
}

TEST(NormalsOfHeights, haveSquareTexelsByDefault) {
    EXPECT_EQ(computeMapSize(512, 128), dvec2(1, 0.25));
    EXPECT_EQ(computeMapSize(100, 300), dvec2(1, 3));
}

} // namespace
} // namespace relief::test
