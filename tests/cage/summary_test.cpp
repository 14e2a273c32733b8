#include <gtest/gtest.h>

#include "meshes.h"

namespace relief::test {
namespace {

/// The signed volume that the faces enclose: positive when they are seen counter-clockwise from outside.
double volume(const Cage& cage) {
    double sum = 0;
    std::size_t first = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        const auto corner = [&](std::uint32_t k) { return dvec3(cage.positions[cage.corners[first + k]]); };
        for (std::uint32_t k = 2; k < size; ++k) sum += glm::dot(corner(0), glm::cross(corner(k - 1), corner(k))) / 6;
        first += size;
    }
    return sum;
}

bool isClosed(const Cage& cage) {
    const CageSummary summary = summarize(cage);
    return summary.boundaryEdgeCount == 0 && summary.nonManifoldEdgeCount == 0;
}

TEST(Summary, countsTheCube) {
    const CageSummary summary = summarize(cube());
    EXPECT_EQ(summary.vertexCount, 8u);
    EXPECT_EQ(summary.faceCount, 6u);
    EXPECT_EQ(summary.edgeCount, 12u);
    EXPECT_EQ(summary.cornerCount, 24u);
    EXPECT_EQ(summary.quadCount, 6u);
    EXPECT_EQ(summary.triangleCount, 0u);
    EXPECT_EQ(summary.otherFaceCount, 0u);
    EXPECT_EQ(summary.boundaryEdgeCount, 0u);
    EXPECT_EQ(summary.nonManifoldEdgeCount, 0u);
    EXPECT_EQ(summary.irregularVertexCount, 8u);
    EXPECT_EQ(summary.maxValence, 3u);
    EXPECT_EQ(summary.unusedVertexCount, 0u);
    EXPECT_EQ(summary.texCoordCount, 0u);
    EXPECT_EQ(summary.seamEdgeCount, 0u);
    EXPECT_EQ(summary.bounds.lower, dvec3(-1));
    EXPECT_EQ(summary.bounds.upper, dvec3(1));
}

TEST(Summary, countsTags) {
    EXPECT_EQ(summarize(hardCube()).creasedEdgeCount, 12u);
    EXPECT_EQ(summarize(cubeWithSharpVertices()).sharpVertexCount, 2u);
    EXPECT_EQ(summarize(torusWithHoles()).holeCount, 3u);
}

TEST(Summary, findsSeamsByTopology) {
    EXPECT_EQ(summarize(cubeOfIslands()).seamEdgeCount, 12u);
    EXPECT_EQ(summarize(torusWithSeams(8, 6)).seamEdgeCount, 8u + 6u);
    EXPECT_EQ(summarize(boundaryGrid()).seamEdgeCount, 0u);
    EXPECT_EQ(summarize(torusWithSeams(8, 6)).texCoordCount, 9u * 7u);
}

TEST(Summary, findsBoundaries) {
    const CageSummary summary = summarize(boundaryGrid(4, 3));
    EXPECT_EQ(summary.boundaryEdgeCount, 14u);
    EXPECT_EQ(summary.edgeCount, 4u * 4u + 5u * 3u);
    EXPECT_EQ(summary.irregularVertexCount, 0u); // vertices on the boundary do not count
    EXPECT_EQ(summary.maxValence, 4u);
}

TEST(Summary, findsNonManifoldEdges) {
    EXPECT_EQ(summarize(nonManifoldEdge()).nonManifoldEdgeCount, 1u);
    EXPECT_EQ(summarize(nonManifoldVertex()).nonManifoldEdgeCount, 0u);
    EXPECT_EQ(summarize(nonManifoldVertex()).maxValence, 6u);
    EXPECT_EQ(summarize(moebiusStrip()).nonManifoldEdgeCount, 1u);
}

TEST(Summary, countsValences) {
    EXPECT_EQ(summarize(torusWithSeams()).irregularVertexCount, 0u);
    EXPECT_EQ(summarize(triangleTorus()).irregularVertexCount, 0u);
    EXPECT_EQ(summarize(icosahedron()).irregularVertexCount, 12u);
    for (const int valence : {3, 5, 17}) EXPECT_EQ(summarize(poles(valence)).maxValence, std::uint64_t(valence));
}

TEST(Summary, sortsFacesBySize) {
    const CageSummary summary = summarize(mixedFaces());
    EXPECT_EQ(summary.triangleCount, 5u);
    EXPECT_EQ(summary.quadCount, 5u);
    EXPECT_EQ(summary.otherFaceCount, 1u);
    EXPECT_TRUE(icosahedron().isAllTriangles());
    EXPECT_FALSE(mixedFaces().isAllTriangles());
}

TEST(Summary, ignoresUnusedVerticesInTheBounds) {
    Cage cage = cube();
    cage.positions.emplace_back(100, 0, 0);
    EXPECT_EQ(summarize(cage).unusedVertexCount, 1u);
    EXPECT_EQ(summarize(cage).bounds.upper.x, 1);
}

TEST(Summary, bytesAreThoseOfTheArrays) {
    EXPECT_EQ(cube().byteCount(), 8 * 12u + 6 * 4u + 24 * 4u);
    EXPECT_EQ(creasedCube().byteCount(), cube().byteCount() + 4 * (8u + 4u));
}

TEST(Meshes, allAreValid) {
    for (const NamedCage& family : allCages()) EXPECT_NO_THROW(validateCage(family.cage, family.name)) << family.name;
}

TEST(Meshes, closedOnesFaceOutwards) {
    int closedCount = 0;
    for (const NamedCage& family : allCages()) {
        if (!isClosed(family.cage)) continue;
        ++closedCount;
        EXPECT_GT(volume(family.cage), 0) << family.name;
    }
    EXPECT_GE(closedCount, 20);
}

TEST(Meshes, closedOnesHaveEulersNumber) {
    const auto euler = [](const Cage& cage) {
        const CageSummary s = summarize(cage);
        return std::int64_t(s.vertexCount) - std::int64_t(s.edgeCount) + std::int64_t(s.faceCount);
    };
    for (const Cage& sphere : {cube(), poles(3), poles(17), nGonPrism(7), mixedFaces(), icosahedron()})
        EXPECT_EQ(euler(sphere), 2);
    EXPECT_EQ(euler(torusWithSeams()), 0);
    EXPECT_EQ(euler(triangleTorus()), 0);
    EXPECT_EQ(euler(separateParts()), 4);
}

} // namespace
} // namespace relief::test
