// The limit surface close to extraordinary vertices against refinement that shares no code with it.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>

#include "surface/caps.h"
#include "surface/deep_oracle.h"
#include "surface/families.h"

namespace relief {
namespace {

struct Errors {
    double point = 0, tangent = 0, bend = 0, degrees = 0;
    int count = 0, approximate = 0;
};

void add(Errors& errors, const ReferenceSurface& surface, const DeepOracle::Sample& sample, double size) {
    if (surface.isHole(sample.face)) return;
    ++errors.count;
    errors.approximate += surface.isApproximate(sample.face, sample.uv) ? 1 : 0;
    const LimitFrame f = surface.limit(sample.face, sample.uv), &e = sample.frame;
    const auto relative = [](const dvec3& a, const dvec3& b) { return glm::length(a - b) / (glm::length(b) + 1e-12); };
    errors.point = std::max(errors.point, glm::length(f.p - e.p) / size);
    errors.tangent = std::max({errors.tangent, relative(f.pu, e.pu), relative(f.pv, e.pv)});
    errors.degrees = std::max(errors.degrees, degreesBetween(glm::cross(f.pu, f.pv), glm::cross(e.pu, e.pv)));
    if (surface.sideCount() == 3) return;
    const double most = std::max({glm::length(e.puu), glm::length(e.puv), glm::length(e.pvv), size});
    errors.bend = std::max({errors.bend, glm::length(f.puu - e.puu) / most, glm::length(f.puv - e.puv) / most,
                            glm::length(f.pvv - e.pvv) / most});
}

Errors errorsAround(const Family& family, std::uint32_t vertex, int deepest) {
    Errors errors;
    const ReferenceSurface surface(family.cage, {family.scheme, 2});
    DeepOracle oracle(family.cage, family.scheme, vertex);
    for (int level = 1; level <= deepest; ++level) {
        oracle.refine();
        if (level < 4) continue;
        for (const auto& sample : oracle.samples()) add(errors, surface, sample, sizeOf(family.cage));
    }
    return errors;
}

/// The vertices that are not regular, and some that are.
std::vector<std::uint32_t> verticesOf(const Cage& cage) {
    const auto count = std::uint32_t(std::min<std::size_t>(cage.positions.size(), 8));
    std::vector<std::uint32_t> vertices{std::uint32_t(cage.positions.size() - 1)};
    for (std::uint32_t v = 0; v < count; v += 2) vertices.push_back(v);
    return vertices;
}

/// Rules of theirs that the oracle has not: edges of three faces or of faces that go the same way, and Chaikin's.
bool isBeyondOracle(const Family& family) {
    for (const char* name : {"fins", "twisted pair", "nonManifoldEdge", "nonManifoldVertex", "moebiusStrip"})
        if (family.name == name) return true;
    return family.cage.creaseMethod == CreaseMethod::chaikin || family.scheme == Scheme::bilinear;
}

// Down to 2^-20 of a face. What is left of tangents and normals is the oracle's rounding: differences of points that
// lie 2^-20 apart.
TEST(ExactCaps, AreTheLimitSurfaceAsNearToTheVertexAsPointsGo) {
    for (const Family& family : allFamilies()) {
        if (isBeyondOracle(family)) continue;
        SCOPED_TRACE(family.name);
        for (const std::uint32_t vertex : verticesOf(family.cage)) {
            const Errors errors = errorsAround(family, vertex, 20);
            const bool isDrawn = family.cage.boundaryRule != BoundaryRule::none; // the vertices are at the boundary
            EXPECT_EQ(errors.count > 0, isDrawn);
            if (errors.approximate > 0) continue;
            EXPECT_LE(errors.point, 1e-14);
            EXPECT_LE(errors.tangent, 1e-4);
            EXPECT_LE(errors.degrees, 2e-3);
            EXPECT_LE(errors.bend, 1e-2);
        }
    }
}

// On the same level as the surface's own depth nothing of the oracle cancels: tangents and second derivatives are
// exact.
TEST(ExactCaps, HaveExactDerivatives) {
    for (const int valence : {3, 5, 12, 31, 64, 150}) {
        const Family family{"poles", poles(valence)};
        const Errors errors = errorsAround(family, std::uint32_t(2 * valence), 8);
        EXPECT_EQ(errors.approximate, 0) << valence;
        EXPECT_LE(errors.point, 1e-14) << valence;
        EXPECT_LE(errors.tangent, 1e-11) << valence;
        EXPECT_LE(errors.bend, 1e-9) << valence;
    }
}

/// Two faces around a vertex, bent.
Cage twoFaces() {
    Cage cage =
        makeCage({{0, 0.1F, 0}, {-1, 0, 0}, {1, 0.2F, 0}, {0, 0, -1}, {0, 0.3F, 1}}, {{0, 1, 4, 2}, {0, 2, 3, 1}});
    return bent(cage);
}

/// Poles of n faces with an edge at one of them that is sharp: a dart.
Cage dartPoles(std::uint32_t n) {
    Cage cage = poles(int(n));
    const auto at = std::ranges::find(cage.corners, 2 * n) - cage.corners.begin();
    const std::ptrdiff_t face = at / 4 * 4;
    test::addCrease(cage, 2 * n, cage.corners[face + (at - face + 1) % 4], 10);
    return cage;
}

// What counts one by one in a face of a large vertex is enough on all levels.
TEST(ExactCaps, AreExactAroundVerticesOfVeryManyFaces) {
    const Errors errors = errorsAround({"poles", poles(95)}, 2 * 95, 18);
    EXPECT_EQ(errors.approximate, 0);
    EXPECT_LE(errors.point, 1e-14);
    EXPECT_LE(errors.tangent, 1e-5);
    EXPECT_LE(errors.degrees, 2e-3);
}

// Tangents vanish there twice as fast as distances do, and normals tilt to and fro.
TEST(ExactCaps, AreExactAroundVerticesOfTwoFaces) {
    const Family family{"two faces", twoFaces()};
    const Errors errors = errorsAround(family, 0, 12);
    EXPECT_EQ(errors.approximate, 0);
    EXPECT_LE(errors.point, 1e-14);
    EXPECT_LE(errors.tangent, 1e-7);
}

// Which patches are Gregory patches in spite of exact end caps is known of the cage and said of its faces.
TEST(ExactCaps, CoverAllFacesButSemiSharpOnesAndThoseBetweenVeryManyFaces) {
    const auto countApproximate = [](const Cage& cage, const SurfaceOptions& options) {
        std::set<std::uint32_t> faces;
        const Surface surface = buildSurface(cage, options);
        for (const Patch& patch : surface.patches)
            if (patch.type == kPatchGregory || patch.type == kPatchGregoryTriangle)
                faces.insert(surface.faces[patch.param0 & 0xfffffff].cageFace);
        const auto listed = listApproximateFaces(cage, options);
        EXPECT_TRUE(std::ranges::includes(listed, faces));
        EXPECT_EQ(listed.empty(), faces.empty());
        return faces.size();
    };
    const std::vector<std::uint32_t> top{4, 5, 6, 7};
    EXPECT_EQ(countApproximate(poles(64), {.isolation = 2}), 0u);
    EXPECT_EQ(countApproximate(poles(65), {.isolation = 2}), 0u);
    EXPECT_EQ(countApproximate(poles(65), {.isolation = 1}), 0u);
    EXPECT_EQ(countApproximate(dartPoles(9), {.isolation = 2}), 0u);
    EXPECT_EQ(countApproximate(dartPoles(65), {.isolation = 2}), 65u);
    EXPECT_EQ(countApproximate(prism(4), {.isolation = 0}), 6u);
    EXPECT_EQ(countApproximate(withCreases(prism(4), top, 2), {.isolation = 2}), 0u);
    EXPECT_GT(countApproximate(withCreases(prism(4), top, 2.5F), {.isolation = 2}), 0u);
    EXPECT_GT(countApproximate(withSharpVertex(prism(4), 4, 2.5F), {.isolation = 2}), 0u);
    EXPECT_EQ(countApproximate(withCreases(icosahedron(), {0, 11, 5}, 10), {Scheme::loop, 2}), 0u);
    EXPECT_EQ(listApproximateFaces(prism(4), {.isolation = 0, .endCaps = EndCapKind::gregory}).size(), 0u);
}

TEST(ExactCaps, NeedLevelsWhereRulesAreSemiSharp) {
    const auto needed = [](const Cage& cage) { return neededIsolation(cage, EndCapKind::exact); };
    const std::vector<std::uint32_t> top{4, 5, 6, 7};
    EXPECT_EQ(needed(poles(1000)), 2);
    EXPECT_EQ(needed(dartPoles(64)), 2);
    EXPECT_EQ(needed(dartPoles(65)), 6);
    EXPECT_EQ(needed(withCreases(prism(4), top, 3.2F)), 4);
    EXPECT_EQ(needed(withCreases(prism(4), top, 9.5F)), 10);
    // Each level would double tables of 100 MB.
    Cage many = sheet(20, 20);
    for (std::uint32_t i = 0; i < 20; ++i)
        for (std::uint32_t j = 0; j < 20; ++j) test::addCrease(many, 21 * j + i, 21 * j + i + 1, 9.5F);
    EXPECT_EQ(needed(many), 6);
    for (const Family& family : allFamilies())
        EXPECT_TRUE(listApproximateFaces(family.cage, {family.scheme, needed(family.cage)}).empty()) << family.name;
}

// Catmull and Clark's subdominant eigenvalue in closed form: how fast faces around a vertex shrink.
TEST(ExactCaps, ShrinkByTheKnownEigenvalues) {
    for (int n = 3; n <= 50; ++n) {
        CapPattern pattern;
        pattern.faceCount = n;
        const double c = std::cos(2 * std::numbers::pi / n);
        const double expected = (5 + c + std::cos(std::numbers::pi / n) * std::sqrt(18 + 2 * c)) / 16;
        // Tangents are eigenvectors from the left.
        const Eigen::MatrixXd tangents = CapMatrices(pattern, 1).tangentWeights();
        const Eigen::MatrixXd refined = tangents * refinementAround(pattern);
        EXPECT_LE((refined - expected * tangents).norm(), 1e-10 * tangents.norm()) << n;
        EXPECT_GE(tangents.norm(), 0.01) << n;
    }
}

} // namespace
} // namespace relief
