// Corners whose two sides continue each other: p_u and p_v are parallel there, and the normal is a limit.
#include <bit>
#include <random>
#include <set>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "surface/families.h"
#include "surface/oracle.h"

namespace relief {
namespace {

/// An open grid of quads, or of their halves, that is rough, turned and stretched by `seed`.
Cage randomGrid(int columns, int rows, std::uint32_t seed) {
    Cage cage = withoutTexCoords(test::boundaryGrid(columns, rows));
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> rough(-0.12F, 0.12F), turn(-3, 3), stretch(0.3F, 3);
    glm::mat4 pose = glm::rotate(glm::mat4(1), turn(random), vec3(rough(random), 1, rough(random)));
    pose = glm::scale(glm::rotate(pose, turn(random), vec3(1, rough(random), 0.5F)),
                      vec3(stretch(random), stretch(random), stretch(random)));
    for (vec3& p : cage.positions) p = vec3(pose * glm::vec4(p + vec3(rough(random), rough(random), rough(random)), 1));
    return cage;
}

/// The direction of the area that four limit points at a corner of the face enclose, `step` grid points from it.
dvec3 areaAtCorner(const Oracle& oracle, int sideCount, int face, int corner, int step) {
    const dvec2 at = sidePoint(sideCount, corner, 0), next = sidePoint(sideCount, corner, 1) - at,
                previous = sidePoint(sideCount, (corner + sideCount - 1) % sideCount, 0) - at;
    const auto point = [&](const dvec2& offset) {
        const dvec2 grid = double(oracle.gridSize()) * at + double(step) * offset;
        return oracle.position(face, int(std::lround(grid.x)), int(std::lround(grid.y)));
    };
    const dvec3 diagonal = point(next + previous) - point(dvec2(0));
    return glm::cross(point(next) - point(previous), diagonal);
}

/// The largest angle between the reference's normals at corners of faces and the areas just inside.
double worstCornerNormal(const Oracle& oracle, const Family& family, EndCapKind kind) {
    const ReferenceSurface reference(family.cage, {family.scheme, 6, kind});
    double worst = 0;
    for (int face = 0; face < reference.faceCount(); ++face) {
        if (reference.isHole(face)) continue;
        for (int corner = 0; corner < reference.sideCount(); ++corner) {
            const dvec3 n = reference.normal(face, sidePoint(reference.sideCount(), corner, 0));
            worst = std::max(worst, degreesBetween(n, areaAtCorner(oracle, reference.sideCount(), face, corner, 1)));
        }
    }
    return worst;
}

constexpr int kGridSize = 64; ///< of the oracle

int straightCornerCount(const Surface& surface) {
    int count = 0;
    for (const Patch& patch : surface.patches) count += std::popcount(patch.straightCorners);
    return count;
}

constexpr EndCapKind kKinds[] = {EndCapKind::exact, EndCapKind::gregory};
const SurfaceOptions kGregory{.endCaps = EndCapKind::gregory};
constexpr BoundaryRule kRules[] = {BoundaryRule::edgeOnly, BoundaryRule::edgeAndCorner, BoundaryRule::none};

// A 64th of a face is where the patch begins that holds the corner; the normal turns by a few degrees on the way to it.
TEST(StraightCorners, ofOpenGridsHaveTheNormalOfTheSurfaceBesideThem) {
    for (std::uint32_t seed = 0; seed < 6; ++seed)
        for (const BoundaryRule rule : kRules) {
            const int least = rule == BoundaryRule::none ? 3 : 1; // which does not draw faces at the boundary
            const Cage quads = withBoundary(randomGrid(least + int(seed % 3), least + int(seed % 4), seed), rule);
            const Cage triangles = withBoundary(test::triangulated(quads), rule);
            const Family families[] = {{"catmark", quads},
                                       {"catmark of triangles", triangles},
                                       {"bilinear", quads, Scheme::bilinear},
                                       {"loop", triangles, Scheme::loop}};
            for (const Family& family : families) {
                SCOPED_TRACE(fmt::format("{} {} {}", family.name, seed, int(rule)));
                const Oracle oracle(family.cage, family.scheme, kGridSize);
                EXPECT_LT(worstCornerNormal(oracle, family, EndCapKind::gregory), 5);
                EXPECT_LT(worstCornerNormal(oracle, family, EndCapKind::exact), 7); // of the vertex itself
            }
        }
}

/// A prism whose two rims are infinitely sharp: each cap lies alone in the corners of its rim.
Cage creasedPrism(int sides) {
    std::vector<std::uint32_t> bottom, top;
    for (int i = 0; i < sides; ++i) bottom.push_back(std::uint32_t(i)), top.push_back(std::uint32_t(sides + i));
    return withCreases(withCreases(prism(sides), bottom, 10), top, 10);
}

TEST(StraightCorners, ofCreasedPrismsHaveTheNormalOfTheSurfaceBesideThem) {
    for (int sides = 3; sides <= 16; ++sides) {
        const Cage cage = creasedPrism(sides);
        EXPECT_EQ(straightCornerCount(buildSurface(cage, kGregory)), 2 * sides);
        const Family family{"creased prism", cage};
        const Oracle oracle(cage, family.scheme, kGridSize);
        for (const EndCapKind kind : kKinds) EXPECT_LT(worstCornerNormal(oracle, family, kind), 10) << sides;
    }
}

// Which corners are straight is the topology's business: none of a closed smooth surface, four of an open grid.
TEST(StraightCorners, areFoundWhateverThePositions) {
    EXPECT_EQ(straightCornerCount(buildSurface(prism(5), kGregory)), 0);
    for (const int isolation : {0, 2, 6, 10})
        for (std::uint32_t seed = 0; seed < 4; ++seed) {
            const Cage grid = randomGrid(3, 2, seed);
            EXPECT_EQ(straightCornerCount(buildSurface(grid, {.isolation = isolation, .endCaps = EndCapKind::gregory})),
                      4)
                << isolation;
            const Cage sharp = withBoundary(grid, BoundaryRule::edgeAndCorner);
            EXPECT_EQ(
                straightCornerCount(buildSurface(sharp, {.isolation = isolation, .endCaps = EndCapKind::gregory})), 0)
                << isolation;
        }
}

// Their faces take less than 6 degrees each; all of a vertex take the same two tangents.
TEST(NarrowCorners, areThoseOfMoreThanSixtyFaces) {
    EXPECT_EQ(straightCornerCount(buildSurface(prism(40), kGregory)), 0);
    EXPECT_EQ(straightCornerCount(buildSurface(prism(80), kGregory)), 2 * 80);
    const Surface surface = buildSurface(prism(80), kGregory);
    std::set<std::pair<std::uint32_t, std::uint32_t>> axes;
    for (const Patch& patch : surface.patches)
        if (patch.straightCorners != 0) {
            const std::uint32_t* points = &surface.patchPoints[patch.firstPoint + patchSize(patch.type)];
            axes.insert({points[0], points[1]});
        }
    EXPECT_EQ(axes.size(), 2u);
}

/// Two quads around a vertex in the middle of a sheet: it has two faces and two edges.
Cage pairAroundVertex() {
    return makeCage({{0, 0.1F, 0}, {-1, 0, 0}, {1, 0.2F, 0}, {0, 0, -1}, {0, 0.3F, 1}}, {{0, 1, 4, 2}, {0, 2, 3, 1}});
}

// Normals turn by 20 degrees over a 64th of a face beside a vertex of 17 faces, and less elsewhere.
TEST(AllCorners, haveTheNormalOfTheSurfaceBesideThem) {
    std::vector<Family> families = allFamilies();
    families.push_back({"pair around a vertex", pairAroundVertex()});
    for (const Family& family : families) {
        const Oracle oracle(family.cage, family.scheme, kGridSize);
        for (const EndCapKind kind : kKinds)
            EXPECT_LT(worstCornerNormal(oracle, family, kind), family.name == families.back().name ? 10 : 25)
                << family.name;
    }
    EXPECT_EQ(straightCornerCount(buildSurface(pairAroundVertex(), kGregory)), 2 + 2);
}

} // namespace
} // namespace relief
