// Texture coordinates beside extraordinary vertices, as near to them as points go.
#include <cmath>

#include <gtest/gtest.h>

#include "surface/families.h"

namespace relief {
namespace {

/// Calls `test(face, uv)` for points at 2^-2 to 2^-20 of a face from its corners.
template <typename Test>
void atCorners(const ReferenceSurface& surface, const Test& test) {
    for (int face = 0; face < surface.faceCount(); ++face) {
        if (surface.isHole(face)) continue;
        for (int corner = 0; corner < surface.sideCount(); ++corner) {
            const dvec2 at = sidePoint(surface.sideCount(), corner, 0);
            const dvec2 next = sidePoint(surface.sideCount(), corner, 1) - at;
            const dvec2 previous =
                sidePoint(surface.sideCount(), (corner + surface.sideCount() - 1) % surface.sideCount(), 0) - at;
            for (int k = 2; k <= 20; k += 3) test(face, at + std::ldexp(1.0, -k) * (0.55 * next + 0.93 * previous));
        }
    }
}

struct TexErrors {
    double st = 0, jacobian = 0; ///< the latter relative to itself
    int count = 0;

    void add(const TexFrame& found, const dvec2& st0, const dvec2& su, const dvec2& sv) {
        ++count;
        st = std::max(st, glm::length(found.st - st0));
        const double most = glm::length(su) + glm::length(sv) + 1e-12;
        jacobian = std::max(
            {jacobian, glm::length(found.jacobian[0] - su) / most, glm::length(found.jacobian[1] - sv) / most});
    }
};

/// x and z.
dvec2 shadowOf(const dvec3& p) { return {p.x, p.z}; }

// A texture that is the shadow of the cage on a plane has the rules of the surface in all patterns, semi-sharp ones
// among them: its coordinates are the shadow of the limit surface, whose own test has an independent oracle.
TEST(TextureCaps, AreTheShadowOfTheSurface) {
    for (Family& family : allFamilies()) {
        const CageSummary summary = summarize(family.cage);
        // Values at boundaries and non-manifold edges have rules of their own.
        if (summary.boundaryEdgeCount + summary.nonManifoldEdgeCount > 0 || family.name == "nonManifoldVertex")
            continue;
        if (family.cage.texBoundaryRule == TexBoundaryRule::all) continue; // linear everywhere
        family.cage.texCoords.clear();
        for (const vec3& p : family.cage.positions) family.cage.texCoords.emplace_back(p.x, p.z);
        family.cage.texCorners = family.cage.corners;
        const ReferenceSurface surface(family.cage, {family.scheme, neededIsolation(family.cage, EndCapKind::exact)});
        TexErrors errors;
        atCorners(surface, [&](int face, const dvec2& uv) {
            const LimitFrame f = surface.limit(face, uv);
            errors.add(surface.texture(face, uv), shadowOf(f.p), shadowOf(f.pu), shadowOf(f.pv));
        });
        EXPECT_GT(errors.count, 0) << family.name;
        EXPECT_LE(errors.st, 1e-14 * sizeOf(family.cage)) << family.name;
        EXPECT_LE(errors.jacobian, 1e-9) << family.name;
    }
}

/// The texture as a cage of its own in a plane, which ends at seams.
Cage textureOf(const Cage& cage) {
    Cage texture;
    for (const vec2& st : cage.texCoords) texture.positions.emplace_back(st, 0);
    texture.faceSizes = cage.faceSizes, texture.corners = cage.texCorners;
    texture.boundaryRule =
        cage.texBoundaryRule == TexBoundaryRule::none ? BoundaryRule::edgeOnly : BoundaryRule::edgeAndCorner;
    return texture;
}

// At seams texture coordinates end as a surface does at its boundary.
TEST(TextureCaps, EndAtSeamsAsSurfacesEndAtBoundaries) {
    const Family families[] = {{"torus", test::torusWithSeams()},
                               {"poles of 3", test::poles(3)},
                               {"poles of 9", test::poles(9)},
                               {"prism", test::nGonPrism(5)},
                               {"islands", test::cubeOfIslands()},
                               {"large poles", test::poles(70)},
                               {"loop torus", test::triangleTorus(), Scheme::loop}};
    for (const Family& family : families)
        for (const TexBoundaryRule rule : {TexBoundaryRule::none, TexBoundaryRule::cornersOnly}) {
            const Cage cage = withTexBoundary(family.cage, rule);
            const ReferenceSurface surface(cage, {family.scheme, 2}), texture(textureOf(cage), {family.scheme, 2});
            TexErrors errors;
            atCorners(surface, [&](int face, const dvec2& uv) {
                const LimitFrame f = texture.limit(face, uv);
                errors.add(surface.texture(face, uv), dvec2(f.p), dvec2(f.pu), dvec2(f.pv));
            });
            EXPECT_LE(errors.st, 1e-14) << family.name;
            EXPECT_LE(errors.jacobian, 1e-9) << family.name;
        }
}

} // namespace
} // namespace relief
