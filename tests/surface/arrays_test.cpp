// The flat arrays against the reference evaluator.
#include <random>

#include <gtest/gtest.h>

#include "surface/families.h"
#include "surface/flat_surface.h"

namespace relief {
namespace {

/// Calls `test(face, uv)` at random points of all faces that are drawn.
template <typename Test>
void atRandomPoints(const Surface& surface, int pointsPerFace, const Test& test) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> unit(0, 1);
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        if (surface.faces[face].root == kNoPatch) continue;
        for (int i = 0; i < pointsPerFace; ++i) {
            dvec2 uv(unit(random), unit(random));
            if (surface.sideCount == 3 && uv.x + uv.y > 1) uv = dvec2(1) - uv;
            test(face, uv);
        }
    }
}

TEST(FlatArrays, HoldTheReferencesPositionsAndTextureCoordinates) {
    for (const Family& family : allFamilies()) {
        SCOPED_TRACE(family.name);
        const double diagonal = boundsOf(family.cage).diagonal();
        for (const int isolation : {0, 1, 3, 7}) {
            SCOPED_TRACE(isolation);
            const SurfaceOptions options{family.scheme, isolation};
            const FlatSurface flat(family.cage, options);
            const ReferenceSurface reference(family.cage, options);
            ASSERT_EQ(int(flat.surface().faces.size()), reference.faceCount());
            ASSERT_EQ(flat.surface().hasTexCoords(), family.cage.hasTexCoords());
            double worst = 0, worstTex = 0;
            atRandomPoints(flat.surface(), 40, [&](std::uint32_t face, const dvec2& uv) {
                worst = std::max(worst, glm::length(flat.position(face, uv) - reference.limit(int(face), uv).p));
                if (family.cage.hasTexCoords())
                    worstTex =
                        std::max(worstTex, glm::length(flat.texCoord(face, uv) - reference.texture(int(face), uv).st));
            });
            EXPECT_LE(worst, 1e-6 * diagonal);
            EXPECT_LE(worstTex, 1e-6);
        }
    }
}

TEST(FlatArrays, TreesLeadToAPatchOfTheirFaceEverywhere) {
    for (const Family& family : allFamilies()) {
        SCOPED_TRACE(family.name);
        const Surface surface = buildSurface(family.cage, {family.scheme, 4});
        std::vector<int> visits(surface.patches.size());
        atRandomPoints(surface, 200, [&](std::uint32_t face, const dvec2& uv) {
            const Leaf leaf = findLeaf(surface, face, uv);
            ASSERT_LT(leaf.patch, surface.patches.size());
            const Patch& patch = surface.patches[leaf.patch];
            EXPECT_EQ(patch.param0 & 0xfffffff, face);
            EXPECT_EQ(int(patch.param1 & 0xf) - int((patch.param1 >> 4) & 1), leaf.depth);
            ++visits[leaf.patch];
        });
        for (const std::uint32_t entry : surface.tree) {
            EXPECT_NE(entry, kNoPatch);
            if (entry & kLeafBit) ++visits[entry & ~kLeafBit];
        }
        for (const Face& face : surface.faces)
            if (face.root != kNoPatch && (face.root & kLeafBit)) ++visits[face.root & ~kLeafBit];
        EXPECT_EQ(std::count(visits.begin(), visits.end(), 0), 0) << "patches that no tree holds";
    }
}

TEST(FlatArrays, KeepOnlyPointsThatSomePatchUses) {
    for (const Family& family : allFamilies()) {
        SCOPED_TRACE(family.name);
        const Surface surface = buildSurface(family.cage, {family.scheme, 3});
        std::vector<bool> isUsed(surface.controlPointCount + surface.stencils.rowCount());
        for (const std::uint32_t point : surface.patchPoints) isUsed.at(point) = true;
        EXPECT_EQ(std::count(isUsed.begin() + surface.controlPointCount, isUsed.end(), false), 0);
        std::vector<bool> isTexUsed(surface.texPoints.size());
        for (const std::uint32_t point : surface.texPatchPoints) isTexUsed.at(point) = true;
        EXPECT_EQ(std::count(isTexUsed.begin(), isTexUsed.end(), false), 0);
    }
}

TEST(FlatArrays, HaveRowsOfTheSamePointsSideBySide) {
    for (const Family& family : allFamilies()) {
        const Stencils stencils = buildSurface(family.cage, {family.scheme, 3}).stencils;
        std::uint32_t before = 0; // lowest point of the row before
        for (std::size_t row = stencils.sharedRowCount; row < stencils.rowCount(); ++row) {
            const auto first = stencils.indices.begin();
            const std::uint32_t lowest =
                *std::min_element(first + stencils.offsets[row], first + stencils.offsets[row + 1]);
            ASSERT_GE(lowest, before) << family.name << " row " << row;
            before = lowest;
        }
    }
}

TEST(FlatArrays, MapFacesBackToTheCage) {
    const Surface surface = buildSurface(prism(5), {});
    std::vector<int> counts(7);
    for (const Face& face : surface.faces) ++counts.at(face.cageFace);
    EXPECT_EQ(counts, (std::vector<int>{1, 1, 1, 1, 1, 5, 5}));
}

TEST(FlatArrays, HolesHaveNoPatches) {
    const Surface surface = buildSurface(withHoles(prism(5), {1, 6}), {});
    for (const Face& face : surface.faces) EXPECT_EQ(face.root == kNoPatch, face.cageFace == 1 || face.cageFace == 6);
    EXPECT_FALSE(surface.isClosed);
}

// Without a boundary rule OpenSubdiv draws only faces whose surroundings are complete.
TEST(FlatArrays, ABoundaryWithoutARuleIsNotDrawn) {
    const Surface surface = buildSurface(withBoundary(sheet(5, 4), BoundaryRule::none), {});
    const auto isDrawn = [](const Face& face) { return face.root != kNoPatch; };
    EXPECT_EQ(std::count_if(surface.faces.begin(), surface.faces.end(), isDrawn), 3 * 2);
}

TEST(RefinePoints, ACageShrunkToOnePointStaysThatPoint) {
    for (const Family& family : allFamilies()) {
        SCOPED_TRACE(family.name);
        const Surface surface = buildSurface(family.cage, {family.scheme, 5});
        const vec3 position(1234.567F, -0.1F, 1e-3F);
        const std::vector<vec3> cage(surface.controlPointCount, position);
        for (const dvec3& p : refinePoints(surface, cage)) ASSERT_EQ(p, dvec3(position));
    }
}

TEST(RefinePoints, FollowsThePose) {
    const Cage cage = prism(5);
    Cage posed = cage;
    for (vec3& p : posed.positions) p = vec3(p.y, 2 * p.x + 0.3F * p.z * p.z, p.z - p.x);
    const Surface surface = buildSurface(cage, {});
    const Surface posedSurface = buildSurface(posed, {});
    const auto points = refinePoints(surface, posed.positions), expected = refinePoints(posedSurface, posed.positions);
    EXPECT_EQ(points, expected);

    ReferenceSurface reference(cage, {});
    reference.pose(posed.positions);
    const ReferenceSurface posedReference(posed, {});
    EXPECT_EQ(reference.limit(3, {0.3, 0.4}).p, posedReference.limit(3, {0.3, 0.4}).p);
}

TEST(RefinePoints, RefusesAPoseOfAnotherCage) {
    const Surface surface = buildSurface(prism(4), {});
    EXPECT_THROW(refinePoints(surface, prism(5).positions), Error);
}

} // namespace
} // namespace relief
