// Maps whose islands hold known heights, on cages whose seams are known.
#include <gtest/gtest.h>

#include "check/check.h"
#include "meshes.h"

namespace relief::test {
namespace {

constexpr int kCells = 3, kCellTexels = 16;

/// An atlas of 3 x 3 cells as withIslands lays them out for up to 9 faces: cell i holds height heights[i].
HeightMap mapOfIslands(const std::vector<float>& heights, double scale = 1) {
    const int side = kCells * kCellTexels;
    std::vector<float> texels(std::size_t(side) * side);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const std::size_t cell = std::size_t((side - 1 - y) / kCellTexels * kCells + x / kCellTexels);
            texels[std::size_t(y) * side + x] = cell < heights.size() ? heights[cell] : 0;
        }
    return makeHeightMap(side, side, std::move(texels), 0, scale, Wrap::repeat);
}

SeamReport seamsOf(const Cage& cage, const HeightMap& map, Scheme scheme = Scheme::catmark) {
    const SurfaceOptions options{.scheme = scheme, .isolation = 3};
    return reportSeams(buildSurface(cage, options), ReferenceSurface(cage, options), map);
}

TEST(Seams, disagreeByTheHeightsOfTheirIslands) {
    // The faces of the cube: 0 -x, 1 +x, 2 -y, 3 +y, 4 -z, 5 +z. Only opposite faces do not meet.
    const SeamReport same = seamsOf(cubeOfIslands(), mapOfIslands({5, 5, 5, 5, 5, 5}));
    EXPECT_EQ(same.seamEdgeCount, 12u);
    EXPECT_EQ(same.max, 0);
    EXPECT_EQ(same.mean, 0);

    const SeamReport one = seamsOf(cubeOfIslands(), mapOfIslands({0, 0, 0, 3, 0, 0}, 0.5));
    EXPECT_NEAR(one.max, 1.5, 1e-12);
    EXPECT_NEAR(one.mean, 1.5 * 4 / 12, 1e-9) << "4 of 12 edges of one length";
    EXPECT_EQ(one.worst.face, 0u) << "the owner of the first edge of face 3";

    const SeamReport all = seamsOf(cubeOfIslands(), mapOfIslands({0, 0, 1, 1, 3, 3}));
    EXPECT_NEAR(all.max, 3, 1e-12);
    EXPECT_NEAR(all.mean, (1.0 + 3 + 2) / 3, 1e-9);
}

TEST(Seams, areWeighedByTheirLength) {
    // A hard box of 2 x 2 x 20: the limit edges are the box's own.
    Cage cage = withIslands(hardCube());
    for (vec3& p : cage.positions) p.z *= 10;
    const SeamReport report = seamsOf(cage, mapOfIslands({0, 0, 1, 1, 0, 0}));
    // The four long edges lie between the x and y faces; of the 8 short ones 4 belong to the y faces.
    EXPECT_NEAR(report.length, 4 * 20 + 8 * 2, 1e-9);
    EXPECT_NEAR(report.mean, (4.0 * 20 + 4 * 2) / (4 * 20 + 8 * 2), 1e-9);
}

TEST(Seams, areFoundWhereOneTexelIsWrong) {
    // The side is some 90 texels long, and the texel lies between eighths of it.
    const Cage cage = withIslands(hardCube());
    const dvec2 st = ReferenceSurface(cage, {}).texture(0, {0.5625, 0}).st;
    constexpr int kSide = 480;
    std::vector<float> texels(std::size_t(kSide) * kSide);
    texels[std::size_t((1 - st.y) * kSide) * kSide + std::size_t(st.x * kSide)] = 1;
    const SeamReport report = seamsOf(cage, makeHeightMap(kSide, kSide, std::move(texels), 0, 1, Wrap::repeat));
    EXPECT_GT(report.max, 0.3);
    EXPECT_LE(report.max, 1);
    EXPECT_EQ(report.worst.face, 0u);
    EXPECT_EQ(report.worst.uv.y, 0);
    EXPECT_NEAR(report.worst.uv.x, 0.5625, 0.02);
    EXPECT_LT(report.mean, 0.01 * report.max);
}

TEST(Seams, areThoseOfTheTextureOnly) {
    const HeightMap slope = makeHeightMap(2, 1, {0, 1}, 0, 1, Wrap::clamp);
    EXPECT_EQ(seamsOf(boundaryGrid(), slope).seamEdgeCount, 0u);
    EXPECT_EQ(seamsOf(boundaryGrid(), slope).max, 0);
    const CageSummary torus = summarize(torusWithSeams());
    const SeamReport report = seamsOf(torusWithSeams(), slope);
    EXPECT_EQ(report.seamEdgeCount, torus.seamEdgeCount);
    EXPECT_NEAR(report.max, 1, 1e-12) << "s = 0 beside s = 1 with a clamped slope";
    // Repeated, both sides of the seam are one place of the map.
    const HeightMap repeated = makeHeightMap(2, 1, {0, 1}, 0, 1, Wrap::repeat);
    EXPECT_NEAR(seamsOf(torusWithSeams(), repeated).max, 0, 1e-9);
}

TEST(Seams, areEverywhereWithoutTextureCoordinates) {
    const HeightMap slope = makeHeightMap(2, 1, {0, 1}, 0, 2, Wrap::clamp);
    const SeamReport report = seamsOf(cube(), slope);
    EXPECT_EQ(report.seamEdgeCount, 12u);
    EXPECT_NEAR(report.max, 2, 1e-12);
    const HeightMap flat = makeHeightMap(1, 1, {1}, 0, 2, Wrap::clamp);
    EXPECT_EQ(seamsOf(cube(), flat).max, 0);
}

TEST(Seams, existOnAllKindsOfCages) {
    const HeightMap map = mapOfIslands({1, 2, 3, 4, 5, 6, 7, 8, 9});
    // Four faces along one edge; the range over all of them counts.
    Cage cage = withIslands(nonManifoldEdge());
    for (vec2& st : cage.texCoords) st = vec2(0.5f / kCells);
    for (const std::uint32_t k : {0u, 1u, 2u, 3u}) cage.texCoords[cage.texCorners[4 + k]] = vec2(2.5f / kCells);
    EXPECT_NEAR(seamsOf(cage, map).max, 8, 1e-12);
    for (const std::uint32_t k : {0u, 1u, 2u, 3u}) cage.texCoords[cage.texCorners[4 + k]] = vec2(0.5f / kCells);
    for (const std::uint32_t k : {0u, 1u, 2u, 3u}) cage.texCoords[cage.texCorners[12 + k]] = vec2(2.5f / kCells);
    EXPECT_EQ(seamsOf(cage, map).seamEdgeCount, 4u) << "of face 3, which is neither first nor last at the common edge";
    EXPECT_GT(seamsOf(moebiusStrip(), map).seamEdgeCount, 0u);
    for (const NamedCage& named : allCages()) {
        const SeamReport report = seamsOf(named.cage, map);
        EXPECT_TRUE(std::isfinite(report.mean)) << named.name;
        EXPECT_LE(report.mean, report.max) << named.name;
        EXPECT_LE(report.max, 9) << named.name;
    }
    EXPECT_GT(seamsOf(withIslands(icosahedron()), map, Scheme::loop).max, 0);
}

} // namespace
} // namespace relief::test
