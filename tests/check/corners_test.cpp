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
        EXPECT_LT(report.max, named.name == "poles17" ? 3 : 2) << named.name << " face " << report.worst.face;
    }
}

// Around many faces, darts and creases normals arrive at their limit slowly (a test of exact end caps compares how
// slowly with the eigenvalues), so that a surface which is right would seem wrong.
TEST(Corners, ofManyFacesDoNotCount) {
    struct Pole {
        int faces;
        std::vector<std::uint32_t> sharpSpokes;
        bool counts;
    };
    for (const Pole& pole : {Pole{24, {}, true},
                             {25, {}, false},
                             {12, {0}, true},
                             {13, {0}, false},
                             {24, {0, 12}, true},
                             {26, {0, 13}, false}}) {
        Cage cage = poles(pole.faces);
        for (const std::uint32_t spoke : pole.sharpSpokes) addCrease(cage, 2 * pole.faces, 2 * spoke, 10);
        const ReferenceSurface reference(cage, {.isolation = 2});
        const std::vector<SampleQuery> corners = cornersOf(buildSurface(cage, {.isolation = 2}));
        const CornerReport report = reportCorners(reference, corners, exactNormals(reference, corners));
        // The other pole is smooth.
        const std::size_t others = corners.size() - (pole.faces > 24 ? 2 : 1) * std::size_t(pole.faces);
        EXPECT_EQ(report.count, pole.counts ? corners.size() : others) << pole.faces;
        EXPECT_LT(report.max, 15) << pole.faces;
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
