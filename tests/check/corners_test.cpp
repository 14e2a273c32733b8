// A device whose normals flip in corners is found, and one that takes them from the reference is not.
#include <gtest/gtest.h>

#include "check/check.h"
#include "meshes.h"

namespace relief::test {
namespace {

/// Limit normals in the corners of the cage's faces, as exact as the reference.
std::vector<SampleResult> exactNormals(const ReferenceSurface& reference, std::span<const SampleQuery> corners) {
    std::vector<SampleResult> results;
    for (const SampleQuery& corner : corners)
        results.push_back({.n = vec3(reference.normal(int(corner.face), dvec2(corner.uv)))});
    return results;
}

TEST(Corners, ofExactNormalsTurnLittle) {
    for (const NamedCage& named : allCages()) {
        if (named.name == "cubeWithCollapsedEdge") continue; // it has corners without a tangent plane
        const ReferenceSurface reference(named.cage, {});
        const std::vector<SampleQuery> corners = cornersOf(buildSurface(named.cage, {}));
        const CornerReport report = reportCorners(reference, corners, exactNormals(reference, corners));
        // Corners of three faces on one edge are not counted: their tangents nearly coincide.
        EXPECT_EQ(report.count + (named.name == "nonManifoldEdge" ? 8 : 0), corners.size()) << named.name;
        // Around many faces normals arrive at their limit slowly (a test of exact end caps compares how slowly with the
        // eigenvalues): at 2^-10 of a face from the vertex of 17 faces, less than 11 degrees are left.
        EXPECT_LT(report.max, named.name == "poles17" ? 11 : 2) << named.name << " face " << report.worst.face;
    }
}

// Parallel is an angle: tangents of very different lengths span a plane all the same.
TEST(Corners, ofLongThinFacesHaveATangentPlane) {
    Cage cage = boundaryGrid(3, 3);
    for (vec3& p : cage.positions) p.x *= 30'000;
    const ReferenceSurface reference(cage, {});
    const std::vector<SampleQuery> corners = cornersOf(buildSurface(cage, {}));
    for (const SampleQuery& corner : corners)
        EXPECT_NEAR(reference.normal(int(corner.face), dvec2(corner.uv)).y, 1, 1e-9) << "face " << corner.face;
    EXPECT_TRUE(reference.limit(4, dvec2(0.5)).hasTangentPlane());
    EXPECT_LT(reportCorners(reference, corners, exactNormals(reference, corners)).max, 1e-3);
}

TEST(Corners, whoseNormalFlipsAreFound) {
    const Cage cage = hillyGrid();
    const ReferenceSurface reference(cage, {});
    const std::vector<SampleQuery> corners = cornersOf(buildSurface(cage, {}));
    std::vector<SampleResult> results = exactNormals(reference, corners);
    results[5].n = -results[5].n;
    const CornerReport report = reportCorners(reference, corners, results);
    EXPECT_GT(report.max, 160);
    EXPECT_EQ(report.worst.face, corners[5].face);
    EXPECT_EQ(report.worst.uv, corners[5].uv);
    results[7].n = vec3(std::nanf(""));
    EXPECT_FALSE(std::isfinite(reportCorners(reference, corners, results).max));
}

} // namespace
} // namespace relief::test
