// Cages whose faces share no vertices, joined again.
#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

/// Every face gets vertices and texture coordinates of its own, as exporters without shared vertices write them; tags
/// name the first copies.
Cage takenApart(const Cage& cage) {
    Cage apart = cage;
    apart.positions.clear(), apart.texCoords.clear();
    std::vector<std::uint32_t> firsts(cage.positions.size(), ~0u);
    for (std::uint32_t corner = 0; corner < cage.corners.size(); ++corner) {
        apart.positions.push_back(cage.positions[cage.corners[corner]]);
        apart.corners[corner] = corner;
        if (firsts[cage.corners[corner]] == ~0u) firsts[cage.corners[corner]] = corner;
        if (!cage.hasTexCoords()) continue;
        apart.texCoords.push_back(cage.texCoords[cage.texCorners[corner]]);
        apart.texCorners[corner] = corner;
    }
    for (std::uint32_t& vertex : apart.sharpVertices) vertex = firsts[vertex];
    apart.creaseEdges.clear(), apart.creaseSharpness.clear();
    std::uint32_t first = 0;
    for (const std::uint32_t size : cage.faceSizes) { // creases by the vertices of each face that has the edge
        for (std::uint32_t k = 0; k < size; ++k)
            for (std::size_t i = 0; i < cage.creaseSharpness.size(); ++i) {
                const std::uint32_t a = cage.creaseEdges[2 * i], b = cage.creaseEdges[2 * i + 1];
                const std::uint32_t from = first + k, to = first + (k + 1) % size;
                if (std::minmax(a, b) == std::minmax(cage.corners[from], cage.corners[to]))
                    addCrease(apart, from, to, cage.creaseSharpness[i]);
            }
        first += size;
    }
    validateCage(apart, "apart");
    return apart;
}

void expectSameShape(const Cage& a, const Cage& b) {
    const CageSummary s = summarize(a), t = summarize(b);
    EXPECT_EQ(s.vertexCount, t.vertexCount);
    EXPECT_EQ(s.faceCount, t.faceCount);
    EXPECT_EQ(s.edgeCount, t.edgeCount);
    EXPECT_EQ(s.boundaryEdgeCount, t.boundaryEdgeCount);
    EXPECT_EQ(s.nonManifoldEdgeCount, t.nonManifoldEdgeCount);
    EXPECT_EQ(s.creasedEdgeCount, t.creasedEdgeCount);
    EXPECT_EQ(s.sharpVertexCount, t.sharpVertexCount);
    EXPECT_EQ(s.holeCount, t.holeCount);
    EXPECT_LE(s.seamEdgeCount, t.seamEdgeCount); // fewer where both sides of a seam have the same values
}

TEST(Weld, makesAClosedCageOfItsFaces) {
    Cage tagged = torusWithHoles();
    addCrease(tagged, tagged.corners[0], tagged.corners[1], 2.5f);
    addSharpVertex(tagged, 9, 1.5f);
    for (const Cage& whole : {cube(), cubeOfIslands(), creasedCube(), torusWithSeams(), torusWithMirroredTexture(),
                              nGonPrism(7), mixedFaces(), icosahedron(), hillyGrid(), moebiusStrip(), tagged}) {
        const Cage apart = takenApart(whole);
        EXPECT_GT(countCoincidentVertices(apart), 0u);
        const WeldedCage welded = weld(apart, 0);
        validateCage(welded.cage, "welded");
        expectSameShape(welded.cage, whole);
        EXPECT_EQ(welded.cage.parts.size(), whole.parts.size());
        EXPECT_EQ(countCoincidentVertices(welded.cage), 0u);
        ASSERT_EQ(welded.sources.size(), welded.cage.positions.size());
        for (std::size_t i = 0; i < welded.sources.size(); ++i)
            EXPECT_EQ(welded.cage.positions[i], apart.positions[welded.sources[i]]);
        for (std::size_t i = 0; i < whole.texCorners.size(); ++i)
            EXPECT_EQ(welded.cage.texCoords[welded.cage.texCorners[i]], whole.texCoords[whole.texCorners[i]]);
    }
}

TEST(Weld, leavesSeamsOnlyWhereTextureCoordinatesDiffer) {
    EXPECT_EQ(summarize(weld(takenApart(torusWithSeams()), 0).cage).seamEdgeCount,
              summarize(torusWithSeams()).seamEdgeCount);
    EXPECT_EQ(summarize(weld(takenApart(hillyGrid()), 0).cage).seamEdgeCount, 0u);
}

TEST(Weld, doesNotChangeCagesThatAreWhole) {
    for (const NamedCage& named : allCages()) {
        if (named.name.find("ollapsed") != std::string::npos) continue; // points that coincide by intent
        const WeldedCage welded = weld(named.cage, 0);
        EXPECT_EQ(welded.cage.positions, named.cage.positions) << named.name;
        EXPECT_EQ(welded.cage.corners, named.cage.corners) << named.name;
        EXPECT_EQ(welded.cage.texCorners, named.cage.texCorners) << named.name;
    }
}

TEST(Weld, joinsWithinItsDistanceAndNotBeyond) {
    Cage apart = takenApart(cube());
    for (std::size_t i = 0; i < apart.positions.size(); ++i) apart.positions[i].x += i % 3 == 0 ? 0.01f : 0;
    EXPECT_GT(weld(apart, 0.009).cage.positions.size(), 8u);
    EXPECT_EQ(weld(apart, 0.011).cage.positions.size(), 8u);
    expectSameShape(weld(apart, 0.011).cage, cube());
}

TEST(Weld, doesNotRunAlongChainsOfPoints) {
    const Cage grid = boundaryGrid(20, 1); // steps of equal length
    const float step = glm::length(grid.positions[1] - grid.positions[0]);
    const WeldedCage welded = weld(grid, 1.01 * step);
    EXPECT_GT(summarize(welded.cage).faceCount, 0u);
}

TEST(Weld, takesBothZerosAsOne) {
    Cage apart = takenApart(boundaryGrid(2, 2));
    for (vec3& p : apart.positions)
        if (&p - apart.positions.data() > 7) p.y = -p.y; // the grid lies at y = 0
    expectSameShape(weld(apart, 0).cage, boundaryGrid(2, 2));
}

TEST(Weld, keepsSolidsApartThatOnlyMeet) {
    const WeldedCage welded = weld(twoCubes({2, 2, 0}), 0); // they share an edge already
    EXPECT_EQ(welded.cage.positions.size(), twoCubes({2, 2, 0}).positions.size());
    Cage pair = cube();
    const Cage other = cube();
    for (const std::uint32_t corner : other.corners) pair.corners.push_back(corner + 8);
    for (const vec3& p : other.positions) pair.positions.push_back(p + vec3(2, 0, 0));
    pair.faceSizes.resize(12, 4);
    EXPECT_EQ(weld(pair, 0).cage.positions.size(), 16u);
}

TEST(Weld, removesWhatDegeneratesAndRenumbersTags) {
    Cage cage = boundaryGrid(3, 1); // faces 0, 1, 2; the left one shrinks to a line
    const float step = glm::length(cage.positions[1] - cage.positions[0]);
    cage.positions[0] = cage.positions[1];
    const std::uint32_t up = cage.corners[3] == 0 ? cage.corners[0] : cage.corners[3];
    cage.holes = {2};
    ASSERT_GT(step, 0);
    const WeldedCage welded = weld(cage, 0);
    EXPECT_LT(welded.cage.corners.size(), cage.corners.size());
    EXPECT_EQ(welded.cage.holes.size(), 1u);
    EXPECT_EQ(welded.cage.holes[0], welded.cage.faceCount() - 1);
    EXPECT_LT(up, cage.positions.size());
    validateCage(welded.cage, "welded");
}

TEST(Weld, theSharpestOfTagsThatMeetHolds) {
    Cage apart = takenApart(creasedCube(2));
    ASSERT_EQ(apart.creaseSharpness.size(), 8u);
    apart.creaseSharpness[0] = 4;
    const WeldedCage welded = weld(apart, 0);
    EXPECT_EQ(welded.cage.creaseSharpness.size(), 4u);
    EXPECT_EQ(std::ranges::count(welded.cage.creaseSharpness, 4.0f), 1);
    EXPECT_EQ(std::ranges::count(welded.cage.creaseSharpness, 2.0f), 3);
}

TEST(Weld, refusesDistancesBelowZeroAndNan) {
    for (const double distance : {-1.0, double(NAN)})
        expectFailure(Failure::usage, {"0 or more"}, [&] { weld(cube(), distance); });
}

} // namespace
} // namespace relief::test
