// The limit surface close to extraordinary vertices against refinement that shares no code with it.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <gtest/gtest.h>

#include "support.h"
#include "surface/caps.h"
#include "surface/deep_oracle.h"
#include "surface/families.h"
#include "surface/far.h"

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

/// At a vertex, and around it from 2^-4 of a face to 2^-20, in a pose of the cage: on every third level and the last.
Errors errorsAround(const ReferenceSurface& surface, const Family& posed, std::uint32_t vertex) {
    constexpr int kFirst = 4, kStep = 3, kDeepest = 20;
    DeepOracle oracle(posed.cage, posed.scheme, vertex);
    const double size = sizeOf(posed.cage);
    Errors errors;
    for (int level = 1; level <= kDeepest; ++level) {
        oracle.refine();
        if (level < kFirst || ((level - kFirst) % kStep != 0 && level != kDeepest)) continue;
        for (const auto& sample : oracle.samples()) add(errors, surface, sample, size);
    }
    const DeepOracle::Sample rest = oracle.vertex();
    if (rest.face < 0 || surface.isHole(rest.face)) return errors;
    errors.point = std::max(errors.point, glm::length(surface.limit(rest.face, rest.uv).p - rest.frame.p) / size);
    return errors;
}

SurfaceOptions optionsFor(const Family& family) {
    return {family.scheme, neededIsolation(family.cage, EndCapKind::exact)};
}

Errors errorsAround(const Family& family, std::uint32_t vertex) {
    return errorsAround(ReferenceSurface(family.cage, optionsFor(family)), family, vertex);
}

/// Tangents and second derivatives are relative to themselves. `loss`: how much more the rounding of points counts in
/// them, which are differences, with the isolation of the surface: twice as much with each level past kSeparation.
void expectExact(const Errors& errors, const std::string& name, double loss = 1) {
    EXPECT_EQ(errors.approximate, 0) << name;
    EXPECT_LE(errors.point, 2e-15) << name;
    EXPECT_LE(errors.tangent, loss * 1e-12) << name;
    EXPECT_LE(errors.degrees, loss * 1e-8) << name;
    EXPECT_LE(errors.bend, loss * 1e-9) << name;
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

// Down to 2^-20 of a face.
TEST(ExactCaps, AreTheLimitSurfaceAsNearToTheVertexAsPointsGo) {
    for (const Family& family : allFamilies()) {
        if (isBeyondOracle(family)) continue;
        const ReferenceSurface surface(family.cage, optionsFor(family));
        for (const std::uint32_t vertex : verticesOf(family.cage)) {
            const Errors errors = errorsAround(surface, family, vertex);
            const bool isDrawn = family.cage.boundaryRule != BoundaryRule::none; // the vertices are at the boundary
            EXPECT_EQ(errors.count > 0, isDrawn);
            expectExact(errors, family.name);
        }
    }
}

/// Vertices that are not regular: at the end of one crease, and of other than four faces.
std::vector<std::uint32_t> irregularVertices(const Cage& cage) {
    std::vector<int> faces(cage.positions.size()), creases(cage.positions.size());
    for (const std::uint32_t vertex : cage.corners) ++faces[vertex];
    for (const std::uint32_t vertex : cage.creaseEdges) ++creases[vertex];
    std::vector<std::uint32_t> darts, others;
    for (std::uint32_t vertex = 0; vertex < faces.size(); ++vertex)
        if (creases[vertex] == 1)
            darts.push_back(vertex);
        else if (faces[vertex] != 0 && faces[vertex] != 4)
            others.push_back(vertex);
    // A few of each, from all over the cage.
    std::vector<std::uint32_t> chosen;
    for (const auto* vertices : {&darts, &others})
        for (std::size_t i = 0; i < std::min<std::size_t>(vertices->size(), 4); ++i)
            chosen.push_back((*vertices)[i * vertices->size() / 4]);
    return chosen;
}

TEST(ExactCaps, AreTheLimitSurfaceOfProductionCages) {
    std::vector<std::string> paths;
    const char* source = std::getenv("RELIEF_SOURCE");
    const std::string folder = source != nullptr ? source : ".";
    for (const char* name : {"octopus", "lantern", "strawberry"}) paths.push_back(folder + "/meshes/" + name + ".obj");
    if (const std::string data = test::productionFolder(); !data.empty())
        for (const char* name : {"/bigguy.obj", "/car.obj", "/monsterfrog.obj"}) paths.push_back(data + name);
    for (const std::string& path : paths) {
        const Family family{path, readCage(path)};
        const ReferenceSurface surface(family.cage, optionsFor(family));
        const double loss = std::exp2(optionsFor(family).isolation - kSeparation);
        for (const std::uint32_t vertex : irregularVertices(family.cage))
            expectExact(errorsAround(surface, family, vertex), path + " at " + std::to_string(vertex), loss);
    }
}

// Nothing but points changes with a pose.
TEST(ExactCaps, AreTheLimitSurfaceInAnyPose) {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> away(-0.2F, 0.2F);
    const Family families[] = {{"poles", poles(5)},
                               {"prism", withCreases(prism(5), {5, 6, 7, 8, 9}, 10)},
                               {"dart", withCreases(prism(4), {4, 5}, 10)},
                               {"semi-sharp", withCreases(prism(4), {4, 5, 6, 7}, 1.7F)},
                               {"loop", icosahedron(), Scheme::loop}};
    for (int pose = 0; pose < 10; ++pose) {
        Family posed = families[pose % 5];
        ReferenceSurface surface(posed.cage, optionsFor(posed));
        for (vec3& p : posed.cage.positions) p += vec3(away(random), away(random), away(random));
        surface.pose(posed.cage.positions);
        for (const std::uint32_t vertex : verticesOf(posed.cage))
            expectExact(errorsAround(surface, posed, vertex), posed.name);
    }
}

/// Two faces around a vertex, bent.
Cage twoFaces() {
    Cage cage =
        makeCage({{0, 0.1F, 0}, {-1, 0, 0}, {1, 0.2F, 0}, {0, 0, -1}, {0, 0.3F, 1}}, {{0, 1, 4, 2}, {0, 2, 3, 1}});
    return bent(cage);
}

/// A pole of n faces, vertex 2 n, with sharp edges at some of its spokes.
Cage polesWithSharpSpokes(std::uint32_t n, const std::vector<std::uint32_t>& spokes) {
    Cage cage = poles(int(n));
    for (const std::uint32_t spoke : spokes) test::addCrease(cage, 2 * n, 2 * spoke, 10);
    return cage;
}

/// n triangles around each of two poles, vertices 0 and 1, with sharp edges at some spokes of the first.
Cage bipyramidWithSharpSpokes(int n, const std::vector<std::uint32_t>& spokes) {
    Cage cage = bipyramid(n);
    for (const std::uint32_t spoke : spokes) test::addCrease(cage, 0, 2 + spoke, 10);
    return cage;
}

/// The pole of n faces, vertex 2 n, without the last of them and without the other pole: an open fan.
Cage fan(std::uint32_t n) {
    Cage cage = poles(int(n));
    Cage open;
    open.positions = cage.positions;
    open.boundaryRule = BoundaryRule::edgeAndCorner;
    for (std::size_t face = 0; face + 2 < cage.faceCount(); ++face) {
        const auto corners = std::span(cage.corners).subspan(4 * face, 4);
        if (std::ranges::find(corners, 2 * n) != corners.end())
            test::addFace(open, {corners[0], corners[1], corners[2], corners[3]});
    }
    return open;
}

// Sectors of many faces have windows as well: each face near a sharp edge has its own, all others share one.
TEST(ExactCaps, AreExactBetweenSharpEdgesOfVeryManyFaces) {
    struct Pole {
        Family family;
        std::uint32_t vertex;
    };
    std::vector<Pole> poles{{{"needle", withSharpVertex(polesWithSharpSpokes(96, {}), 192, 10)}, 192},
                            {{"fan", fan(70)}, 140},
                            {{"loop needle", withSharpVertex(bipyramid(96), 0, 10), Scheme::loop}, 0}};
    for (const std::vector<std::uint32_t>& spokes : {std::vector<std::uint32_t>{3}, {0, 70}, {0, 30, 31}}) {
        const std::string name = std::to_string(spokes.size()) + " sharp edges";
        poles.push_back({{name, polesWithSharpSpokes(100, spokes)}, 200});
        poles.push_back({{"loop, " + name, bipyramidWithSharpSpokes(100, spokes), Scheme::loop}, 0});
    }
    for (const Pole& pole : poles) {
        expectExact(errorsAround(pole.family, pole.vertex), pole.family.name);
    }
}

// What counts one by one in a face of a large vertex is enough on all levels.
TEST(ExactCaps, AreExactAroundVerticesOfVeryManyFaces) {
    for (const int valence : {31, 64, 95}) {
        const Family family{"poles of " + std::to_string(valence), poles(valence)};
        expectExact(errorsAround(family, std::uint32_t(2 * valence)), family.name);
    }
}

// Tangents vanish there twice as fast as distances do, and normals tilt to and fro.
TEST(ExactCaps, AreExactAroundVerticesOfTwoFaces) {
    const Family family{"two faces", twoFaces()};
    const Errors errors = errorsAround(family, 0);
    EXPECT_EQ(errors.approximate, 0);
    EXPECT_LE(errors.point, 1e-14);
    EXPECT_LE(errors.tangent, 1e-7);
}

/// The faces of the cage where the reference only approximates the surface, at the middles of 8 x 8 squares of each.
std::vector<std::uint32_t> approximateFaces(const Cage& cage, const SurfaceOptions& options, const Surface& surface) {
    constexpr int kSquares = 8;
    const ReferenceSurface reference(cage, options);
    std::set<std::uint32_t> faces;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face)
        for (int i = 0; i < kSquares * kSquares; ++i) {
            const dvec2 uv = (dvec2(i % kSquares, i / kSquares) + 0.5) / double(kSquares);
            if (surface.sideCount == 3 && uv.x + uv.y >= 1) continue;
            if (reference.isApproximate(int(face), uv)) faces.insert(surface.faces[face].cageFace);
        }
    return {faces.begin(), faces.end()};
}

// Which patches are Gregory patches in spite of exact end caps is known of the cage and said of its faces, and so is
// where semi-sharp rules outlast the levels.
TEST(ExactCaps, CoverAllFacesButSemiSharpOnes) {
    const auto countApproximate = [](const Cage& cage, const SurfaceOptions& options) {
        std::set<std::uint32_t> faces;
        const Surface surface = buildSurface(cage, options);
        for (const Patch& patch : surface.patches)
            if (patch.type == kPatchGregory || patch.type == kPatchGregoryTriangle)
                faces.insert(surface.faces[patch.param0 & 0xfffffff].cageFace);
        const auto listed = listApproximateFaces(cage, options);
        EXPECT_TRUE(std::ranges::includes(listed, faces));
        EXPECT_EQ(listed.empty(), faces.empty());
        EXPECT_EQ(listed, approximateFaces(cage, options, surface));
        return faces.size();
    };
    const std::vector<std::uint32_t> top{4, 5, 6, 7};
    EXPECT_EQ(countApproximate(poles(64), {.isolation = 2}), 0u);
    EXPECT_EQ(countApproximate(poles(65), {.isolation = 2}), 0u);
    EXPECT_EQ(countApproximate(poles(65), {.isolation = 1}), 0u);
    EXPECT_EQ(countApproximate(polesWithSharpSpokes(9, {0}), {.isolation = 2}), 0u);
    EXPECT_EQ(countApproximate(polesWithSharpSpokes(65, {0}), {.isolation = 2}), 0u);
    EXPECT_EQ(countApproximate(prism(4), {.isolation = 0}), 6u);
    EXPECT_EQ(countApproximate(withCreases(prism(4), top, 2), {.isolation = 2}), 0u);
    EXPECT_GT(countApproximate(withCreases(prism(4), top, 2.5F), {.isolation = 2}), 0u);
    EXPECT_GT(countApproximate(withSharpVertex(prism(4), 4, 2.5F), {.isolation = 2}), 0u);
    EXPECT_EQ(countApproximate(withCreases(icosahedron(), {0, 11, 5}, 10), {Scheme::loop, 2}), 0u);
    EXPECT_EQ(listApproximateFaces(prism(4), {.isolation = 0, .endCaps = EndCapKind::gregory}).size(), 0u);
}

// Levels that semi-sharp rules need are not made around vertices without these: tables would grow for nothing.
TEST(ExactCaps, NeedNoMoreLevelsThanSeparateVertices) {
    const auto patchCount = [](const Cage& cage, int isolation) {
        return buildSurface(cage, {.isolation = isolation}).patches.size();
    };
    for (const Cage& cage : {poles(5), withCreases(prism(4), {4, 5, 6, 7}, 10)})
        EXPECT_EQ(patchCount(cage, 6), patchCount(cage, kSeparation));
}

/// p_u and p_v at the vertices of all exact end caps, from tables of so many levels.
std::vector<dvec3> vertexTangents(const Family& family, int levelCount) {
    const FarTables tables = makeFarTables(family.cage, optionsFor(family), levelCount);
    const std::vector<Point> points = refineAll(tables, family.cage.positions);
    std::vector<dvec3> tangents;
    for (const std::optional<EndCap>& cap : tables.caps.surface) {
        if (!cap) continue;
        const dvec3 limit = points[pointCount(tables) + cap->limit].value;
        const Eigen::MatrixXd& weights = tables.caps.patterns[cap->pattern]->tangentWeights();
        for (Eigen::Index row = 0; row < 2; ++row) {
            dvec3& sum = tangents.emplace_back(0);
            for (std::size_t i = 0; i < cap->points.size(); ++i)
                sum += weights(row, Eigen::Index(i)) * (points[std::size_t(cap->points[i])].value - limit);
        }
    }
    return tangents;
}

// The device's tables have fewer levels than the reference's, and so windows around vertices whose faces all count one
// by one in the reference. Both have the same directions at the vertex, which any two that span the tangent plane could
// be, and certificates compare them.
TEST(ExactCaps, HaveTheSameDirectionsAtTheVertexWithAndWithoutAWindow) {
    const Family families[] = {{"smooth", poles(70)},
                               {"dart", polesWithSharpSpokes(70, {3})},
                               {"needle", withSharpVertex(poles(70), 140, 10)},
                               {"loop", bipyramid(70), Scheme::loop},
                               {"loop dart", bipyramidWithSharpSpokes(70, {3}), Scheme::loop}};
    for (const Family& family : families) {
        const std::vector<dvec3> few = vertexTangents(family, int(kCapLevels)), many = vertexTangents(family, 44);
        ASSERT_EQ(few.size(), many.size());
        ASSERT_GE(few.size(), 70u);
        for (std::size_t i = 0; i < few.size(); ++i)
            ASSERT_LE(glm::length(few[i] - many[i]), 1e-9 * glm::length(many[i])) << family.name << " " << i;
    }
}

TEST(ExactCaps, NeedLevelsWhereRulesAreSemiSharp) {
    const auto needed = [](const Cage& cage) { return neededIsolation(cage, EndCapKind::exact); };
    const std::vector<std::uint32_t> top{4, 5, 6, 7};
    EXPECT_EQ(needed(poles(1000)), 2);
    EXPECT_EQ(needed(polesWithSharpSpokes(65, {0, 1})), 2);
    EXPECT_EQ(needed(withCreases(prism(4), top, 3.2F)), 4);
    EXPECT_EQ(needed(withCreases(prism(4), top, 9.5F)), 10);
    EXPECT_EQ(needed(withSharpVertex(prism(4), 4, 3.2F)), 4);
    // Each level would double tables of 100 MB.
    Cage many = sheet(20, 20);
    for (std::uint32_t i = 0; i < 20; ++i)
        for (std::uint32_t j = 0; j < 20; ++j) test::addCrease(many, 21 * j + i, 21 * j + i + 1, 9.5F);
    EXPECT_EQ(needed(many), 6);
    for (const Family& family : allFamilies()) {
        // Sharp corners of texture coordinates one behind another: on no level is one of them alone.
        const bool hasLinearBoundaries = family.cage.texBoundaryRule == TexBoundaryRule::boundaries;
        EXPECT_EQ(listApproximateFaces(family.cage, {family.scheme, needed(family.cage)}).empty(), !hasLinearBoundaries)
            << family.name;
    }
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

// Normals arrive at their limit as fast as waves of more turns around the vertex shrink beside that of one turn: those
// of two turns at last, those of three before. Around many faces that is slow.
TEST(ExactCaps, HaveNormalsThatArriveAsFastAsTheEigenvaluesSay) {
    const auto eigenvalue = [](double angle) {
        const double c = std::cos(angle);
        return (5 + c + std::cos(angle / 2) * std::sqrt(18 + 2 * c)) / 16;
    };
    for (const int n : {12, 17, 30}) {
        const Family family{"poles", poles(n)};
        const ReferenceSurface surface(family.cage, optionsFor(family));
        const dvec3 normal = surface.normal(0, dvec2(0)); // corner 0 is the pole
        const auto turn = [&](int level) {
            return degreesBetween(normal, surface.normal(0, dvec2(std::ldexp(1.0, -level))));
        };
        const double angle = 2 * std::numbers::pi / n;
        const double perLevel = std::pow(turn(38) / turn(28), 0.1);
        EXPECT_LE(perLevel, eigenvalue(2 * angle) / eigenvalue(angle)) << n;
        EXPECT_GE(perLevel, eigenvalue(3 * angle) / eigenvalue(angle)) << n;
    }
}

} // namespace
} // namespace relief
