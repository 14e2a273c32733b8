// The displaced curve of Marschner's notes (CS 569), in two dimensions: q = p + d n with p of unit speed and n' = k p'
// has the normal m = n - d' p' / (1 + k d), of which (1 + k d) n - d' p' is a multiple. Without the term of the
// curvature k it is n - d' p'.
#include <cmath>

#include <gtest/gtest.h>

#include "displacement/displacement.h"
#include "meshes.h"

namespace relief::test {
namespace {

/// A point of a plane curve, extruded along z: p' is p_u, and z is p_v turned so that n points to the left of p'.
struct CurvePoint {
    dvec2 p{0}, first{0}, second{0}; ///< with derivatives by the parameter, whatever its speed
};

LimitFrame extruded(const CurvePoint& c) {
    return {.p = {c.p, 0}, .pu = {c.first, 0}, .pv = {0, 0, -1}, .puu = {c.second, 0}};
}

/// The notes' normal in two dimensions, by arc length: `dd` is the derivative of d by the parameter.
dvec2 notesNormal(const CurvePoint& c, double d, double dd, bool hasCurvature) {
    const double speed = glm::length(c.first);
    const dvec2 along = c.first / speed, n(-along.y, along.x);
    const double k = -(c.first.x * c.second.y - c.first.y * c.second.x) / (speed * speed * speed); // n' = k p'
    return glm::normalize((hasCurvature ? 1 + k * d : 1.0) * n - dd / speed * along);
}

void expectNotes(const CurvePoint& c, double d, double dd) {
    const DisplacedNormals normals = computeDisplacedNormals(extruded(c), d, {dd, 0});
    const dvec3 full(notesNormal(c, d, dd, true), 0), firstOrder(notesNormal(c, d, dd, false), 0);
    EXPECT_LT(degreesBetween(normals.full, full), 1e-9);
    EXPECT_LT(degreesBetween(normals.firstOrder, firstOrder), 1e-9);
    EXPECT_GT(degreesBetween(full, firstOrder), 0.5) << "the term of the curvature is seen";
}

TEST(Curves, ofACircleHaveTheNormalsOfTheNotes) {
    for (const double angle : {0.3, 1.9, 4.0}) {
        const double r = 2, x = r * std::cos(angle), y = r * std::sin(angle);
        // Clockwise, so that n points outwards.
        expectNotes({{x, -y}, {-y, -x}, {-x, y}}, 0.5 + 0.1 * std::sin(3 * angle), 0.8);
    }
}

TEST(Curves, ofAParabolaHaveTheNormalsOfTheNotes) {
    for (const double x : {-0.8, -0.1, 0.6}) expectNotes({{x, x * x}, {1, 2 * x}, {0, 2}}, 0.2, 0.6);
}

// The notes' normal is that of the displaced points themselves.
TEST(Curves, ofDisplacedPointsHaveTheseNormals) {
    const auto displaced = [](double x) {
        const double length = std::sqrt(1 + 4 * x * x), d = 0.2 + 0.6 * x;
        return dvec2(x, x * x) + d * dvec2(-2 * x, 1) / length;
    };
    const double x = 0.3, step = 1e-5;
    const dvec2 along = glm::normalize(displaced(x + step) - displaced(x - step));
    const dvec2 notes = notesNormal({{x, x * x}, {1, 2 * x}, {0, 2}}, 0.2 + 0.6 * x, 0.6, true);
    EXPECT_NEAR(glm::dot(along, notes), 0, 1e-8);
}

} // namespace
} // namespace relief::test
