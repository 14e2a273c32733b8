// The displaced surface against closed forms and against differences of its own points.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "displacement/displacement.h"
#include "shared/displacement.h"
#include "surface/families.h"

namespace relief::test {
namespace {

constexpr double kPi = std::numbers::pi;

double degreesBetween(const dvec3& a, const dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

HeightMap constantMap(double height) { return makeHeightMap(4, 4, std::vector<float>(16, 1), 0, height, Wrap::repeat); }

/// scale * sin(2 pi s) * cos(2 pi t), repeating.
HeightMap wavyMap(double scale) {
    const int size = 2048;
    std::vector<float> texels(std::size_t(size) * size);
    for (int j = 0; j < size; ++j) {
        const double row = std::cos(2 * kPi * (1 - (j + 0.5) / size));
        for (int i = 0; i < size; ++i)
            texels[std::size_t(j) * size + i] = float(std::sin(2 * kPi * (i + 0.5) / size) * row);
    }
    return makeHeightMap(size, size, std::move(texels), 0, scale, Wrap::repeat);
}

// --- normals of closed forms ---------------------------------------------------------------------------------------

/// A surface known by formula with a height on it, at one (u,v).
struct Known {
    LimitFrame f;
    dvec3 n{0};
    double h = 0;
    dvec2 dh{0};

    /// By the formulas of the shaders, and by the reference, which has its own.
    [[nodiscard]] std::vector<dvec3> firstOrder() const {
        return {formulas::firstOrderNormal(n, f.pu, f.pv, dh), computeDisplacedNormals(f, h, dh).firstOrder};
    }
    [[nodiscard]] std::vector<dvec3> full() const {
        const double area = glm::length(glm::cross(f.pu, f.pv));
        const dvec3 nu = formulas::normalDerivative(n, area, f.pu, f.pv, f.puu, f.puv);
        const dvec3 nv = formulas::normalDerivative(n, area, f.pu, f.pv, f.puv, f.pvv);
        return {glm::cross(formulas::displacedTangent(f.pu, n, nu, h, dh.x),
                           formulas::displacedTangent(f.pv, n, nv, h, dh.y)),
                computeDisplacedNormals(f, h, dh).full};
    }
};

void expectDirection(const std::vector<dvec3>& normals, const dvec3& direction) {
    for (const dvec3& normal : normals) EXPECT_LE(degreesBetween(normal, direction), 1e-6);
}

/// Cylinder of radius r round z; the height a sin(k u) depends on the angle u alone.
Known onCylinder(double r, double a, double k, double u) {
    Known known;
    known.f.p = {r * std::cos(u), r * std::sin(u), 0.3};
    known.f.pu = {-r * std::sin(u), r * std::cos(u), 0};
    known.f.pv = {0, 0, 1};
    known.f.puu = {-r * std::cos(u), -r * std::sin(u), 0};
    known.n = {std::cos(u), std::sin(u), 0};
    known.h = a * std::sin(k * u);
    known.dh = {a * k * std::cos(k * u), 0};
    return known;
}

// The displaced cylinder is the curve of radius r + h(u): its normal is (r + h) n - h' t.
TEST(DisplacedNormals, OfACylinderAreThoseOfThePolarCurve) {
    for (int i = 0; i < 16; ++i) {
        const double u = 0.37 * i;
        const Known known = onCylinder(2, 0.6, 3, u);
        const dvec3 tangent(-std::sin(u), std::cos(u), 0);
        expectDirection(known.full(), (2 + known.h) * known.n - known.dh.x * tangent);
        expectDirection(known.firstOrder(), 2.0 * known.n - known.dh.x * tangent);
    }
}

// Marschner, CS 569 notes, in the plane: m = n - d' p' - k d n for p by arc length; here the curvature k is -1/r.
TEST(DisplacedNormals, FollowMarschnersCurve) {
    const double r = 1.5;
    const Known known = onCylinder(r, 0.4, 2, 0.8);
    const dvec3 unitTangent = known.f.pu / r;
    const dvec3 m = known.n - known.dh.x / r * unitTangent + known.h / r * known.n;
    expectDirection(known.full(), m);
}

// A sphere raised by a constant is a sphere; raised by h(v) it is a surface of revolution.
TEST(DisplacedNormals, OfASphereAreThoseOfASurfaceOfRevolution) {
    const double r = 1.2, u = 0.7, v = 0.4;
    Known known;
    const double cu = std::cos(u), su = std::sin(u), cv = std::cos(v), sv = std::sin(v);
    known.n = {cu * cv, su * cv, sv};
    known.f = {r * known.n,
               r * dvec3(-su * cv, cu * cv, 0),
               r * dvec3(-cu * sv, -su * sv, cv),
               r * dvec3(-cu * cv, -su * cv, 0),
               r * dvec3(su * sv, -cu * sv, 0),
               -r * known.n};
    known.h = 0.5;
    expectDirection(known.full(), known.n);
    known.dh = {0, 0.8};
    const dvec3 north(-cu * sv, -su * sv, cv);
    expectDirection(known.full(), (r + known.h) * known.n - known.dh.y * north);
}

// --- displacedFrame ------------------------------------------------------------------------------------------------

TEST(DisplacedFrames, OfAPlaneNeedNoCurvature) {
    Cage cage = boundaryGrid(3, 3);
    cage.boundaryRule = BoundaryRule::edgeAndCorner;
    const ReferenceSurface plane(cage, {});
    const HeightMap map = wavyMap(0.3);
    for (const dvec2 uv : {dvec2(0.5, 0.25), dvec2(0.1, 0.9), dvec2(1, 1)}) {
        const DisplacedFrame frame = displacedFrame(plane, &map, 4, uv);
        EXPECT_LE(glm::length(frame.normal - dvec3(0, 1, 0)), 1e-12);
        EXPECT_LE(glm::length(frame.q - frame.limit.p - dvec3(0, frame.height.h, 0)), 1e-12);
        EXPECT_LE(degreesBetween(frame.full, frame.firstOrder), 1e-6);
        // The grid is 3 long in x and -z for one of s and t; y is up.
        EXPECT_LE(degreesBetween(frame.full, dvec3(-frame.height.hs / 3, 1, frame.height.ht / 3)), 1e-3);
        const double expected = 0.3 * std::sin(2 * kPi * frame.tex.st.x) * std::cos(2 * kPi * frame.tex.st.y);
        EXPECT_NEAR(frame.height.h, expected, 1e-5);
    }
}

TEST(DisplacedFrames, AreTheLimitSurfaceWithoutAMap) {
    const ReferenceSurface surface(bent(test::nGonPrism(5)), {});
    for (const int face : {0, 7, 12}) {
        const DisplacedFrame frame = displacedFrame(surface, nullptr, face, {0.3, 0.6});
        EXPECT_EQ(frame.q, frame.limit.p);
        EXPECT_LE(degreesBetween(frame.normal, frame.firstOrder), 1e-6);
        EXPECT_LE(degreesBetween(frame.normal, frame.full), 1e-6);
    }
}

/// Difference of each normal from the one that central differences of q give, over all faces.
struct NormalErrors {
    double firstOrderRms = 0, fullRms = 0; // degrees
};

NormalErrors compareWithDifferences(const ReferenceSurface& surface, const HeightMap& map) {
    const double step = 1e-4;
    double firstOrder = 0, full = 0;
    int count = 0;
    for (int face = 0; face < surface.faceCount(); ++face) {
        if (surface.isHole(face)) continue;
        for (const dvec2 uv : {dvec2(0.13, 0.21), dvec2(0.42, 0.33), dvec2(0.3, 0.6), dvec2(0.07, 0.86)}) {
            const auto q = [&](double u, double v) {
                return displacedFrame(surface, &map, face, uv + step * dvec2(u, v)).q;
            };
            const dvec3 m = glm::cross(q(1, 0) - q(-1, 0), q(0, 1) - q(0, -1));
            const DisplacedFrame frame = displacedFrame(surface, &map, face, uv);
            firstOrder += std::pow(degreesBetween(frame.firstOrder, m), 2);
            full += std::pow(degreesBetween(frame.full, m), 2);
            ++count;
        }
    }
    return {std::sqrt(firstOrder / count), std::sqrt(full / count)};
}

TEST(DisplacedFrames, HaveTheNormalOfTheirOwnPoints) {
    const Family families[] = {
        {"cube", withFlatTexCoords(prism(4))},
        {"prism without texture", prism(5)},
        {"n-gons", withFlatTexCoords(prism(7))},
        {"seams", bent(torusWithSeams())},
        {"mirrored texture", bent(torusWithMirroredTexture())},
        {"valence 9", withFlatTexCoords(poles(9))},
        {"loop icosahedron", withFlatTexCoords(icosahedron()), Scheme::loop},
        {"loop torus", bent(triangleTorus()), Scheme::loop},
    };
    const HeightMap map = wavyMap(0.12);
    for (const Family& family : families) {
        SCOPED_TRACE(family.name);
        const NormalErrors errors = compareWithDifferences(ReferenceSurface(family.cage, {family.scheme, 6}), map);
        EXPECT_LE(errors.fullRms, 0.05);
        EXPECT_GE(errors.firstOrderRms, 0.4) << "the cage is too flat: the normals hardly differ";
    }
}

TEST(DisplacedFrames, StayFiniteWhereTangentsOrTextureAreSingular) {
    const HeightMap map = wavyMap(0.2);
    const Cage cages[] = {boundaryGrid(2, 2), torusWithCollapsedTexture(), cubeWithCollapsedEdge(), lonePolygon(3),
                          moebiusStrip()};
    for (const Cage& cage : cages) {
        const ReferenceSurface surface(cage, {Scheme::catmark, 4});
        for (int face = 0; face < surface.faceCount(); ++face) {
            for (const dvec2 uv :
                 {dvec2(0, 0), dvec2(1, 0), dvec2(1, 1), dvec2(0, 1), dvec2(0.5, 0), dvec2(0.3, 0.3)}) {
                const DisplacedFrame frame = displacedFrame(surface, &map, face, uv);
                for (const dvec3& n : {frame.normal, frame.firstOrder, frame.full})
                    EXPECT_NEAR(glm::length(n), 1, 1e-9);
                EXPECT_TRUE(std::isfinite(glm::length(frame.q)));
            }
        }
    }
}

// Without tangents that span a plane there is nothing to differentiate: the height's slope is ignored.
TEST(DisplacedFrames, KeepTheLimitNormalWhereTangentsAreParallel) {
    const HeightMap map = wavyMap(0.2);
    const ReferenceSurface exact(boundaryGrid(2, 2), {.isolation = 4}),
        sheet(boundaryGrid(2, 2), {.isolation = 4, .endCaps = EndCapKind::gregory});
    EXPECT_LE(glm::length(displacedFrame(exact, &map, 0, {0, 0}).normal - dvec3(0, 1, 0)), 1e-9);
    const DisplacedFrame frame = displacedFrame(sheet, &map, 0, {0, 0});
    ASSERT_FALSE(frame.limit.hasTangentPlane());
    EXPECT_LE(glm::length(frame.normal - dvec3(0, 1, 0)), 1e-9);
    EXPECT_EQ(frame.firstOrder, frame.normal);
    EXPECT_EQ(frame.full, frame.normal);
}

TEST(DisplacedFrames, RaiseAlongTheNormalByTheMapsHeight) {
    const ReferenceSurface surface(withFlatTexCoords(prism(5)), {});
    const HeightMap map = constantMap(0.25);
    const DisplacedFrame frame = displacedFrame(surface, &map, 6, {0.4, 0.4});
    EXPECT_NEAR(frame.height.h, 0.25, 1e-12);
    EXPECT_LE(glm::length(frame.q - (frame.limit.p + 0.25 * frame.normal)), 1e-12);
    EXPECT_LE(degreesBetween(frame.full, frame.normal), 1e-6);
}

} // namespace
} // namespace relief::test
