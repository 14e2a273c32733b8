// Faces of very many corners, vertices of very many faces, and cages of which nothing is drawn.
#include "meshes.h"
#include "support.h"
#include "surface/surface.h"

namespace relief::test {
namespace {

double distance(const dvec3& a, const dvec3& b) { return glm::length(a - b); }

/// Where every patch's corner is, from the flat arrays: a bicubic patch's point at (0,0) by its own sixteen.
dvec3 cornerOf(const Surface& surface, const Patch& patch, const std::vector<dvec3>& points) {
    constexpr double kWeights[] = {1.0 / 6, 4.0 / 6, 1.0 / 6};
    dvec3 p(0);
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            p += kWeights[row] * kWeights[column] *
                 points[surface.patchPoints[patch.firstPoint + std::uint32_t(4 * row + column)]];
    return p;
}

/// Patches without boundaries, by the flat arrays against the reference; returns the worst distance.
double worstCorner(const Cage& cage, const SurfaceOptions& options) {
    const Surface surface = buildSurface(cage, options);
    const ReferenceSurface reference(cage, options);
    const std::vector<dvec3> points = refinePoints(surface, cage.positions);
    double worst = 0;
    for (std::uint32_t face = 0; face < surface.faces.size(); face += 7)
        for (const TreeLeaf& leaf : leavesOf(surface.tree, surface.faces[face].root)) {
            const Patch& patch = surface.patches[leaf.patchIndex];
            const bool isInner = patch.type == 6 && (patch.param1 >> 7 & 31) == 0;
            if (!isInner) continue;
            const dvec2 uv = dvec2(leaf.u, leaf.v) / double(1u << leaf.depth);
            worst = std::max(worst, distance(cornerOf(surface, patch, points), reference.limit(int(face), uv).p));
        }
    return worst;
}

TEST(ManyNeighbours, haveTheSameSurfaceAsTheReference) {
    for (const int count : {40, 90, 200})
        for (const Cage& cage : {nGonPrism(count), poles(count)}) {
            const Surface surface = buildSurface(cage, {.isolation = 5});
            EXPECT_GT(surface.stencils.sharedRowCount, 0u) << count;
            EXPECT_LT(worstCorner(cage, {.isolation = 5}), 2e-6) << count;
        }
}

TEST(ManyNeighbours, needSharedRowsThatNameTheCageAlone) {
    const Surface surface = buildSurface(nGonPrism(100), {});
    const Stencils& stencils = surface.stencils;
    for (std::uint32_t row = 0; row < stencils.rowCount(); ++row) {
        const std::uint32_t limit =
            surface.controlPointCount + (row < stencils.sharedRowCount ? 0 : stencils.sharedRowCount);
        double sum = 0;
        for (std::uint32_t k = stencils.offsets[row]; k < stencils.offsets[row + 1]; ++k) {
            ASSERT_LT(stencils.indices[k], limit);
            sum += stencils.weight(row, k);
        }
        ASSERT_NEAR(sum, 1, 1e-4);
    }
}

TEST(ManyNeighbours, areNotSharedInOrdinaryCages) {
    for (const NamedCage& named : allCages())
        EXPECT_EQ(buildSurface(named.cage, {.isolation = 4}).stencils.sharedRowCount, 0u) << named.name;
}

// Without shared rows there were 340 times the square of the count.
TEST(ManyNeighbours, needFewTimesTheSquareOfTheirCountOfWeights) {
    for (const Cage& cage : {nGonPrism(300), poles(300)})
        EXPECT_LT(buildSurface(cage, {}).stencils.weights.size(), 40u * 300u * 300u);
}

TEST(ManyNeighbours, areRefusedWithAnEstimateWhereTogetherTheyTakeTooMuch) {
    Cage cage;
    for (int copy = 0; copy < 12; ++copy) {
        const auto first = std::uint32_t(cage.positions.size());
        cage.faceSizes.push_back(1000);
        for (std::uint32_t k = 0; k < 1000; ++k) {
            cage.positions.push_back(onCircle(k / 1000.0, 1, copy));
            cage.corners.push_back(first + k);
        }
    }
    expectFailure(Failure::input, {"face 0 has 1000 corners", "GB"}, [&] { buildSurface(cage, {}); });
}

TEST(NothingDrawn, isBadInput) {
    Cage holes = cube();
    holes.holes = {0, 1, 2, 3, 4, 5};
    expectFailure(Failure::input, {"all 6 faces are holes"}, [&] { buildSurface(holes, {}); });
    for (Cage open : {lonePolygon(4), lonePolygon(5), boundaryGrid(1, 5)}) {
        open.boundaryRule = BoundaryRule::none;
        expectFailure(Failure::input, {"interpolateboundary"}, [&] { buildSurface(open, {}); });
        expectFailure(Failure::input, {"interpolateboundary"}, [&] { ReferenceSurface(open, {}); });
    }
    Cage triangle = lonePolygon(3);
    triangle.boundaryRule = BoundaryRule::none;
    expectFailure(Failure::input, {"interpolateboundary"}, [&] { buildSurface(triangle, {.scheme = Scheme::loop}); });
}

} // namespace
} // namespace relief::test
