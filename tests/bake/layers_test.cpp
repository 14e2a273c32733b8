// Normals, positions, curvature and occlusion of sculpts of known shape.
#include <gtest/gtest.h>

#include "bake/sculpts.h"

namespace relief::test {
namespace {

constexpr int kLayerSide = 32;

std::vector<Image> bakeLayers(const Baking& baking, const TriangleMesh& mesh, std::vector<SculptLayer> layers,
                              Facing facing = Facing::front) {
    const MeasuredSurface sculpt = measured(mesh);
    const SculptDetail detail = computeSculptDetail(sculpt.triangles(), facing);
    const LayerOptions options{
        .layers = std::move(layers), .detail = &detail, .occlusionLines = 256, .occlusionReach = 9};
    return bakeHeights(baking.reference, sculpt, baking.texels,
                       {.lines = {.reach = {1, 1}, .facing = facing}, .layers = options})
        .layers;
}

TEST(Layers, ofASineAreItsDerivatives) {
    // s runs along x, t along -z; the texture is mirrored in the second cage.
    for (const bool isMirrored : {false, true}) {
        Cage cage = squareGrid();
        if (isMirrored)
            for (vec2& st : cage.texCoords) st.x = 1 - st.x;
        const Baking baking(cage, {.width = kLayerSide, .height = kLayerSide, .wrap = Wrap::clamp});
        const std::vector<Image> layers =
            bakeLayers(baking, hillsOverGrid(800, [](double x, double z) { return 0.3 * std::sin(2 * x) + 0.1 * z; }),
                       {SculptLayer::tangentNormal, SculptLayer::objectNormal, SculptLayer::position,
                        SculptLayer::vector, SculptLayer::curvature});
        for (int y = 2; y < kLayerSide - 2; ++y)
            for (int x = 2; x < kLayerSide - 2; ++x) {
                const double s = (x + 0.5) / kLayerSide, at = 4 * (isMirrored ? 1 - s : s),
                             z = -4 * (1 - (y + 0.5) / kLayerSide);
                const double height = 0.3 * std::sin(2 * at) - 0.1 * z, slope = 0.6 * std::cos(2 * at);
                const dvec3 normal = glm::normalize(dvec3(-slope, 1, 0.1));
                const auto expect = [&](std::size_t layer, const dvec3& value, double tolerance) {
                    for (int k = 0; k < 3; ++k) EXPECT_NEAR(layers[layer].at(x, y)[k], value[k], tolerance) << layer;
                };
                expect(0, {isMirrored ? -normal.x : normal.x, -normal.z, normal.y}, 1e-3);
                expect(1, normal, 1e-3);
                expect(2, {at, height, z}, 1e-4);
                expect(3, {0, height, 0}, 1e-4);
                // Of the two principal curvatures one is 0; edges lie in three directions: two of four bend, by halves.
                const double bend = 1.2 * std::sin(2 * at) / std::pow(1 + slope * slope, 1.5);
                EXPECT_NEAR(*layers[4].at(x, y), 0.5 * bend, 0.1 * std::abs(bend) + 0.03);
            }
    }
}

TEST(Layers, ofOcclusionAreHalfInTheCornerOfAWall) {
    // A floor, and a high wall along x = 0 that faces +x: half of the sky is gone at its foot.
    TriangleMesh room = hillsOverGrid(8, [](double, double) { return 0.01; });
    append(room, sheetThrough(8, [](double s, double t) { return dvec3(0, 40 * t, 20 - 44 * s); }));
    const Baking baking(squareGrid(), {.width = kLayerSide, .height = kLayerSide, .wrap = Wrap::clamp});
    const std::vector<Image> layers = bakeLayers(baking, room, {SculptLayer::occlusion});
    EXPECT_NEAR(*layers[0].at(0, kLayerSide / 2), 0.5, 0.05);
    EXPECT_NEAR(*layers[0].at(kLayerSide - 1, kLayerSide / 2), 0.5 + 0.5 * std::sin(std::atan(4 / 8.06)), 0.08);
    // Without the wall all of it is there.
    const TriangleMesh floor = hillsOverGrid(8, [](double, double) { return 0.01; });
    const std::vector<Image> open = bakeLayers(baking, floor, {SculptLayer::occlusion});
    for (const float share : open[0].texels) EXPECT_EQ(share, 1);
}

} // namespace
} // namespace relief::test
