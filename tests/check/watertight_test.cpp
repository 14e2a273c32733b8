// Triangles that are closed, and each way of not being so.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "check/check.h"
#include "support.h"

namespace relief::test {
namespace {

/// Columns x rows squares in the plane y = 0, two triangles each, vertices shared; its outline is flagged.
CapturedMesh openGrid(std::uint32_t columns, std::uint32_t rows) {
    CapturedMesh mesh;
    for (std::uint32_t j = 0; j <= rows; ++j)
        for (std::uint32_t i = 0; i <= columns; ++i) {
            mesh.positions.emplace_back(i + 1, 0, j + 1);
            mesh.isOnBoundary.push_back(i == 0 || j == 0 || i == columns || j == rows);
        }
    const auto at = [&](std::uint32_t i, std::uint32_t j) { return j * (columns + 1) + i; };
    for (std::uint32_t j = 0; j < rows; ++j)
        for (std::uint32_t i = 0; i < columns; ++i)
            mesh.indices.insert(mesh.indices.end(), {at(i, j), at(i, j + 1), at(i + 1, j), //
                                                     at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)});
    return mesh;
}

/// A box with corners at 0 and 1 whose six sides are grids of n x n squares; every triangle has vertices of its own.
CapturedMesh closedBox(std::uint32_t n) {
    CapturedMesh mesh;
    const auto put = [&](int axis, bool isUpper, std::uint32_t i, std::uint32_t j) {
        vec3 p(0);
        p[axis] = isUpper ? 1 : 0;
        p[(axis + 1) % 3] = float(i) / float(n);
        p[(axis + 2) % 3] = float(j) / float(n);
        mesh.indices.push_back(std::uint32_t(mesh.positions.size()));
        mesh.positions.push_back(p);
        mesh.isOnBoundary.push_back(0);
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const bool isUpper : {false, true})
            for (std::uint32_t j = 0; j < n; ++j)
                for (std::uint32_t i = 0; i < n; ++i) {
                    put(axis, isUpper, i, j), put(axis, isUpper, i + 1, j), put(axis, isUpper, i + 1, j + 1);
                    put(axis, isUpper, i, j), put(axis, isUpper, i + 1, j + 1), put(axis, isUpper, i, j + 1);
                }
    return mesh;
}

std::uint32_t addVertex(CapturedMesh& mesh, const vec3& p, bool isOnBoundary = false) {
    mesh.positions.push_back(p);
    mesh.isOnBoundary.push_back(char(isOnBoundary));
    return std::uint32_t(mesh.positions.size() - 1);
}

TEST(Watertight, isAClosedBox) {
    for (const std::uint32_t n : {1u, 2u, 7u}) {
        const Watertightness w = checkWatertight(closedBox(n), 0);
        EXPECT_TRUE(w.isWatertight());
        EXPECT_EQ(w.triangles, 12u * n * n);
        EXPECT_EQ(w.distinctPoints, 6u * n * n + 2);
        EXPECT_EQ(w.openEdges + w.boundarySegments + w.tJunctions + w.degenerateTriangles + w.notFinite, 0u);
        EXPECT_EQ(w.largestGapUlps, 0);
    }
}

TEST(Watertight, isNotAMeshWithOneCornerMovedByAnUlp) {
    CapturedMesh mesh = closedBox(4);
    const auto moved = std::ranges::find(mesh.positions, vec3(1, 0.5f, 0.5f));
    moved->x = std::nextafter(moved->x, 2.0f);
    const Watertightness w = checkWatertight(mesh, 0);
    EXPECT_FALSE(w.isWatertight());
    EXPECT_EQ(w.openEdges, 4u) << "two of the triangle, two of its neighbours";
    EXPECT_EQ(w.tJunctions, 0u);
    EXPECT_EQ(w.largestGapUlps, 1);
    EXPECT_NEAR(glm::length(w.worstLocation - vec3(1, 0.5f, 0.5f)), 0, 1e-6);
    EXPECT_EQ(w.distinctPoints, 6u * 16 + 3);
}

TEST(Watertight, measuresGapsInUlpsOfTheLargestCoordinate) {
    CapturedMesh mesh = closedBox(4);
    for (vec3& p : mesh.positions) p += vec3(1000, 0, 0);
    std::ranges::find(mesh.positions, vec3(1001, 0.5f, 0.5f))->y += 6.103515625e-05f; // the unit at 1001
    EXPECT_EQ(checkWatertight(mesh, 0).largestGapUlps, 1);
}

TEST(Watertight, isNotAMeshWithoutOneTriangle) {
    CapturedMesh mesh = closedBox(4);
    mesh.indices.resize(mesh.indices.size() - 3);
    const Watertightness w = checkWatertight(mesh, 0);
    EXPECT_FALSE(w.isWatertight());
    EXPECT_EQ(w.openEdges, 3u);
    EXPECT_GT(w.largestGapUlps, 1e6f);
}

TEST(Watertight, countsVerticesOnOthersEdges) {
    // Two squares side by side; the right one has one more vertex on their common side.
    CapturedMesh mesh;
    const std::uint32_t a = addVertex(mesh, {1, 0, 1}, true), b = addVertex(mesh, {2, 0, 1}, true),
                        c = addVertex(mesh, {2, 0, 2}, true), d = addVertex(mesh, {1, 0, 2}, true),
                        e = addVertex(mesh, {3, 0, 1}, true), f = addVertex(mesh, {3, 0, 2}, true),
                        m = addVertex(mesh, {2, 0, 1.37f});
    mesh.indices = {a, b, c, a, c, d, b, e, m, m, e, f, m, f, c};
    const Watertightness w = checkWatertight(mesh, 6);
    EXPECT_FALSE(w.isWatertight());
    EXPECT_EQ(w.tJunctions, 1u);
    EXPECT_EQ(w.openEdges, 2u);
    EXPECT_EQ(w.boundarySegments, 7u) << "both ends of the long side are on the boundary, but so many are not expected";
    EXPECT_FALSE(w.isBoundaryWhole());

    mesh.positions[m].x += 0.1f;
    EXPECT_EQ(checkWatertight(mesh, 6).tJunctions, 0u) << "beside the edge";
    mesh.positions[m] = vec3(2, 0, 2 + 0.25f);
    EXPECT_EQ(checkWatertight(mesh, 6).tJunctions, 1u) << "now the others' vertex lies on this edge";
}

/// Two sheets side by side along x = 2 as far as z = 1 + rows, the right one with `more` times the rows.
CapturedMesh sheetsOfTwoRates(std::uint32_t rows, std::uint32_t more) {
    CapturedMesh mesh = openGrid(1, rows);
    const CapturedMesh right = openGrid(1, more * rows);
    const auto offset = std::uint32_t(mesh.positions.size());
    for (const vec3& p : right.positions) addVertex(mesh, {p.x + 1, 0, 1 + (p.z - 1) / float(more)}, true);
    for (const std::uint32_t index : right.indices) mesh.indices.push_back(offset + index);
    for (std::size_t i = 0; i < mesh.positions.size(); ++i)
        if (mesh.positions[i].x == 2) mesh.isOnBoundary[i] = 0;
    return mesh;
}

TEST(Watertight, countsAllTJunctionsOfALongSeamInAnyDirection) {
    CapturedMesh mesh = sheetsOfTwoRates(50, 1);
    EXPECT_EQ(checkWatertight(mesh, 100).openEdges, 4u)
        << "the ends of the seam are unflagged, so their sides are open";
    mesh = sheetsOfTwoRates(50, 4);
    EXPECT_EQ(checkWatertight(mesh, 300).tJunctions, 150u);
    for (vec3& p : mesh.positions) p = {p.x + 2 * p.z, p.z - p.x, p.x}; // exact: these are quarters
    EXPECT_EQ(checkWatertight(mesh, 300).tJunctions, 150u);
}

TEST(Watertight, acceptsTheBoundaryOfTheCage) {
    const CapturedMesh mesh = openGrid(5, 3);
    const Watertightness w = checkWatertight(mesh, 16);
    EXPECT_TRUE(w.isWatertight());
    EXPECT_EQ(w.boundarySegments, 16u);
    EXPECT_EQ(w.openEdges, 0u);
    EXPECT_FALSE(checkWatertight(mesh, 15).isWatertight()) << "one too many";

    CapturedMesh unflagged = mesh;
    std::ranges::fill(unflagged.isOnBoundary, 0);
    EXPECT_EQ(checkWatertight(unflagged, 16).openEdges, 16u);

    // One flag at a position is enough: a vertex that comes later without does not take it away.
    CapturedMesh twice = mesh;
    const auto offset = std::uint32_t(mesh.positions.size());
    for (const vec3& p : mesh.positions) addVertex(twice, p, false);
    for (std::size_t i = 0; i < twice.indices.size(); i += 2) twice.indices[i] += offset;
    EXPECT_TRUE(checkWatertight(twice, 16).isWatertight());
}

// At a corner of one face a triangle has two sides on the boundary and the third between two of its vertices: with a
// hidden segment elsewhere, as where boundaries meet, no count of edges shows that it is missing.
TEST(Watertight, missesTrianglesThatAreNotThere) {
    CapturedMesh mesh = openGrid(3, 3);
    EXPECT_TRUE(checkWatertight(mesh, 12, 18).isWatertight());
    mesh.indices.erase(mesh.indices.begin(), mesh.indices.begin() + 3);
    mesh.positions[14] = mesh.positions[15]; // a segment of the boundary collapses
    const Watertightness w = checkWatertight(mesh, 12);
    EXPECT_TRUE(w.isWatertight()) << "by its edges alone: " << w.boundarySegments << " of 12";
    EXPECT_FALSE(checkWatertight(mesh, 12, 18).hasAllTriangles());
    EXPECT_FALSE(checkWatertight(mesh, 12, 18).isWatertight());
}

TEST(Watertight, countsTrianglesThatWereNeverWrittenAsMissing) {
    CapturedMesh mesh = closedBox(2);
    mesh.indices.insert(mesh.indices.end(), {0, 0, 0});
    EXPECT_EQ(checkWatertight(mesh, 0, 49).triangles, 48u);
    EXPECT_FALSE(checkWatertight(mesh, 0, 49).isWatertight());
    EXPECT_TRUE(checkWatertight(mesh, 0, 48).isWatertight());
}

TEST(Watertight, missesBoundarySegmentsThatAreNotThere) {
    const CapturedMesh nothing;
    EXPECT_FALSE(checkWatertight(nothing, 4).isWatertight());
    EXPECT_TRUE(checkWatertight(nothing, 0).isWatertight());
}

TEST(Watertight, letsBoundarySegmentsCollapse) {
    CapturedMesh mesh = openGrid(5, 3);
    for (const int vertex : {1, 2, 3}) mesh.positions[vertex] = mesh.positions[0];
    const Watertightness w = checkWatertight(mesh, 16);
    EXPECT_EQ(w.boundarySegments, 13u);
    EXPECT_EQ(w.degenerateTriangles, 3u);
    EXPECT_TRUE(w.isWatertight());
}

TEST(Watertight, allowsBoundariesThatCoincide) {
    CapturedMesh mesh = openGrid(4, 1);
    CapturedMesh other = openGrid(4, 1);
    for (vec3& p : other.positions) p.z = 4 - p.z; // a mirror image along z = 2
    const auto offset = std::uint32_t(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), other.positions.begin(), other.positions.end());
    mesh.isOnBoundary.insert(mesh.isOnBoundary.end(), other.isOnBoundary.begin(), other.isOnBoundary.end());
    for (const std::uint32_t index : other.indices) mesh.indices.push_back(offset + index);
    const Watertightness w = checkWatertight(mesh, 20);
    EXPECT_EQ(w.boundarySegments, 12u);
    EXPECT_TRUE(w.isWatertight());
}

TEST(Watertight, skipsDegenerateTriangles) {
    CapturedMesh mesh = closedBox(2);
    mesh.indices.insert(mesh.indices.end(), {0, 0, 1, 2, 2, 2});
    const Watertightness w = checkWatertight(mesh, 0);
    EXPECT_EQ(w.degenerateTriangles, 2u);
    EXPECT_TRUE(w.isWatertight());
}

TEST(Watertight, weldsBothZeros) {
    CapturedMesh mesh = closedBox(2);
    int count = 0;
    for (vec3& p : mesh.positions)
        for (int axis = 0; axis < 3; ++axis)
            if (p[axis] == 0 && ++count % 2 == 0) p[axis] = -0.0f;
    EXPECT_GT(count, 10);
    EXPECT_TRUE(checkWatertight(mesh, 0).isWatertight());
}

TEST(Watertight, refusesVerticesThatAreNotFinite) {
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
        CapturedMesh mesh = openGrid(3, 3);
        mesh.positions[5].y = bad;
        const Watertightness w = checkWatertight(mesh, 12);
        EXPECT_EQ(w.notFinite, 1u);
        EXPECT_FALSE(w.isWatertight());

        mesh = closedBox(2);
        addVertex(mesh, {0, bad, 0});
        EXPECT_EQ(checkWatertight(mesh, 0).openEdges, 0u);
        EXPECT_FALSE(checkWatertight(mesh, 0).isWatertight());
    }
}

TEST(Watertight, refusesArraysThatDoNotFit) {
    CapturedMesh mesh = openGrid(1, 1);
    mesh.indices.back() = 4;
    expectFailure(Failure::internal, {"triangle 1", "vertex 4"}, [&] { (void)checkWatertight(mesh, 0); });
    mesh.indices.pop_back();
    expectFailure(Failure::internal, {"5 indices"}, [&] { (void)checkWatertight(mesh, 0); });
}

// When all is broken the answer still comes: nothing is quadratic, and edges are diagnosed up to a number.
TEST(Watertight, endsSoonOnASoupOfTriangles) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> unit(-1, 1);
    CapturedMesh mesh;
    mesh.positions.resize(3'000'000);
    for (vec3& p : mesh.positions) p = {unit(random), unit(random), unit(random)};
    mesh.isOnBoundary.resize(mesh.positions.size());
    mesh.indices.resize(mesh.positions.size());
    std::iota(mesh.indices.begin(), mesh.indices.end(), 0u);
    const Watertightness w = checkWatertight(mesh, 0);
    EXPECT_EQ(w.openEdges, 3'000'000u);
    EXPECT_GT(w.largestGapUlps, 1e3f);
}

TEST(Watertight, readsMillionsOfTriangles) {
    const Watertightness w = checkWatertight(openGrid(2500, 2000), 9000);
    EXPECT_EQ(w.triangles, 10'000'000u);
    EXPECT_TRUE(w.isWatertight());
}

} // namespace
} // namespace relief::test
