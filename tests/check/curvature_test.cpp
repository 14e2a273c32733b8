// Frames of spheres, cylinders and tori in closed form: curvatures, folds and angles that are known.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "check/check.h"
#include "meshes.h"

namespace relief::test {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr int kFaces = 4; ///< a side of the sheet that carries the shapes

/// The frame of a torus at (x,y) in [0,1]^2, by them; its outside is where p_x x p_y points.
LimitFrame torusFrame(double radius, double tube, double x, double y) {
    const double a = kTurn * x, b = kTurn * y;
    const dvec3 out(std::cos(a), 0, -std::sin(a)), along(-std::sin(a), 0, -std::cos(a)), up(0, 1, 0);
    const double ring = radius + tube * std::cos(b), k = kTurn;
    return {.p = ring * out + tube * std::sin(b) * up,
            .pu = k * ring * along,
            .pv = k * tube * (-std::sin(b) * out + std::cos(b) * up),
            .puu = -k * k * ring * out,
            .puv = -k * k * tube * std::sin(b) * along,
            .pvv = -k * k * tube * (std::cos(b) * out + std::sin(b) * up)};
}

/// Upright, of height 1.
LimitFrame cylinderFrame(double radius, double x, double y) {
    const double a = kTurn * x, k = kTurn;
    const dvec3 out(std::cos(a), 0, -std::sin(a)), along(-std::sin(a), 0, -std::cos(a));
    return {
        .p = radius * out + dvec3(0, y, 0), .pu = k * radius * along, .pv = {0, 1, 0}, .puu = -k * k * radius * out};
}

/// A band of a sphere between 0.6 of a quarter turn below and above the equator.
LimitFrame sphereFrame(double radius, double x, double y) {
    const double a = kTurn * x, k = kTurn, c = 0.6 * std::numbers::pi, b = c * (y - 0.5);
    const dvec3 out(std::cos(a), 0, -std::sin(a)), along(-std::sin(a), 0, -std::cos(a)), up(0, 1, 0);
    return {.p = radius * (std::cos(b) * out + std::sin(b) * up),
            .pu = radius * k * std::cos(b) * along,
            .pv = radius * c * (-std::sin(b) * out + std::cos(b) * up),
            .puu = -radius * k * k * std::cos(b) * out,
            .puv = -radius * k * c * std::sin(b) * along,
            .pvv = -radius * c * c * (std::cos(b) * out + std::sin(b) * up)};
}

/// The same surface by sheared and stretched parameters: curvatures do not care.
LimitFrame sheared(const LimitFrame& f) {
    // u = 2 a, v = a + b / 3.
    const dvec3 pa = 2.0 * f.pu + f.pv, pb = f.pv / 3.0;
    return {.p = f.p,
            .pu = pa,
            .pv = pb,
            .puu = 4.0 * f.puu + 4.0 * f.puv + f.pvv,
            .puv = (2.0 * f.puv + f.pvv) / 3.0,
            .pvv = f.pvv / 9.0};
}

void expectCurvatures(const LimitFrame& frame, double lowest, double highest) {
    for (const LimitFrame& f : {frame, sheared(frame)}) {
        const Curvatures k = principalCurvatures(f);
        EXPECT_NEAR(k.lowest, lowest, 1e-6);
        EXPECT_NEAR(k.highest, highest, 1e-6);
    }
}

TEST(Curvatures, areThoseOfTheShapes) {
    for (const double x : {0.0, 0.13, 0.5, 0.87})
        for (const double y : {0.0, 0.21, 0.5, 0.9}) {
            expectCurvatures(sphereFrame(2, x, y), 0.5, 0.5);
            expectCurvatures(cylinderFrame(0.25, x, y), 0, 4);
            const double c = std::cos(kTurn * y), around = c / (3 + 0.5 * c);
            expectCurvatures(torusFrame(3, 0.5, x, y), around, 2);
        }
}

TEST(Curvatures, changeSignWithTheNormal) {
    LimitFrame inside = sphereFrame(2, 0.3, 0.4);
    std::swap(inside.pu, inside.pv), std::swap(inside.puu, inside.pvv);
    expectCurvatures(inside, -0.5, -0.5);
}

/// Constant height on a shape over the sheet's 16 faces.
struct Sheet {
    SurfaceSamples samples = sampleEverywhere(buildSurface(boundaryGrid(kFaces, kFaces), {.isolation = 1}), 160'000);
    std::vector<SampleResult> results;

    /// `shape(x, y)` is the frame by the sheet's own coordinates in 0..1, which are the texture coordinates too.
    template <typename Shape>
    Sheet(double h, const Shape& shape) {
        std::ranges::fill(samples.hasCurvature, 1); // the shapes have one everywhere, the sheet's cage has not
        for (const auto& [face, uv] : samples.queries) {
            const dvec2 st = dvec2(face % kFaces + double(uv.x), face / kFaces + double(uv.y)) / double(kFaces);
            const LimitFrame f = shape(st.x, st.y);
            constexpr double k = 1.0 / kFaces;
            results.push_back({.p = vec3(f.p),
                               .pu = vec3(k * f.pu),
                               .pv = vec3(k * f.pv),
                               .puu = vec3(k * k * f.puu),
                               .puv = vec3(k * k * f.puv),
                               .pvv = vec3(k * k * f.pvv),
                               .st = vec2(st),
                               .stu = {k, 0},
                               .stv = {0, k},
                               .h = float(h)});
        }
    }

    [[nodiscard]] CurvatureReport report() const { return reportCurvature(samples, results); }
};

TEST(CurvatureReport, measuresTheShape) {
    const CurvatureReport r = Sheet(0.1, [](double x, double y) { return torusFrame(2, 0.5, x, y); }).report();
    EXPECT_EQ(r.count, 160'000u);
    EXPECT_EQ(r.countWithoutCurvature, 0u);
    EXPECT_NEAR(r.area, kTurn * 2 * kTurn * 0.5, 1e-4);
    EXPECT_NEAR(r.lowestFactor, 1 - 0.1 / (2 - 0.5), 1e-6) << "on the inside, where the ring's curvature is negative";
    EXPECT_EQ(r.lowestAt.face / kFaces, 1u) << "where the second row of faces ends, half way round the tube";
    EXPECT_EQ(r.lowestAt.uv.y, 1);
    EXPECT_EQ(r.foldedArea, 0);
    const auto torus = [](double x, double y) { return torusFrame(2, 0.5, x, y); };
    EXPECT_NEAR(Sheet(-0.1, torus).report().lowestFactor, 1 - 0.1 / 0.5, 1e-6) << "inwards the tube is the narrower";
}

TEST(CurvatureReport, measuresFolds) {
    // 1 + h kappa = (R + (r + h) cos b) / (R + r cos b) <= 0 where cos b <= -R / (r + h).
    const double R = 2, r = 0.5, h = 2, edge = std::acos(-R / (r + h));
    const CurvatureReport report = Sheet(h, [&](double x, double y) { return torusFrame(R, r, x, y); }).report();
    EXPECT_NEAR(report.lowestFactor, (R - r - h) / (R - r), 1e-5);
    const double expected = (R * (kTurn - 2 * edge) - 2 * r * std::sin(edge)) / (kTurn * R);
    EXPECT_NEAR(report.foldedFraction(), expected, 3e-3) << "one row of samples is 1/400";
    EXPECT_GT(expected, 0.1);
}

TEST(CurvatureReport, findsASphereThatIsTurnedInsideOut) {
    const auto sphere = [](double x, double y) { return sphereFrame(2, x, y); };
    EXPECT_NEAR(Sheet(-1.9, sphere).report().lowestFactor, 0.05, 1e-5);
    EXPECT_EQ(Sheet(-1.9, sphere).report().foldedArea, 0);
    EXPECT_NEAR(Sheet(-2.1, sphere).report().lowestFactor, -0.05, 1e-5);
    EXPECT_NEAR(Sheet(-2.1, sphere).report().foldedFraction(), 1, 1e-12);
    EXPECT_NEAR(Sheet(5, sphere).report().lowestFactor, 3.5, 1e-5) << "outward there is always room";
}

TEST(CurvatureReport, measuresWhatFirstOrderNormalsIgnore) {
    // Across a cylinder of radius 1: slope d by arc length, first order n - d t, in full n - d / (1 + h) t.
    const double h = 0.5, d = 0.5;
    Sheet sheet(h, [](double x, double y) { return cylinderFrame(1, x, y); });
    for (SampleResult& result : sheet.results) result.gradient = {float(d * kTurn), 0};
    const double expected = glm::degrees(std::atan(d) - std::atan(d / (1 + h)));
    EXPECT_NEAR(sheet.report().maxNormalAngle, expected, 1e-3);
    EXPECT_NEAR(sheet.report().meanNormalAngle, expected, 1e-3);

    // Half of it without a slope.
    for (std::size_t i = 0; i < sheet.results.size() / 2; ++i) sheet.results[i].gradient = {0, 0};
    EXPECT_NEAR(sheet.report().maxNormalAngle, expected, 1e-3);
    EXPECT_NEAR(sheet.report().meanNormalAngle, expected / 2, 1e-3);
    EXPECT_GE(sheet.report().maxNormalAngleAt.face, 8u);
}

TEST(CurvatureReport, skipsPointsWithoutATangentPlane) {
    Sheet sheet(0.1, [](double x, double y) { return sphereFrame(1, x, y); });
    sheet.results[7].pu = vec3(0);
    sheet.results[8].pu = sheet.results[8].pv;
    sheet.results[9].puv.x = std::numeric_limits<float>::quiet_NaN();
    sheet.results[10].h = -5;
    sheet.samples.hasCurvature[10] = 0;
    sheet.results[11].pu = sheet.results[11].pv * vec3(1, 1 + 1e-6f, 1);
    const CurvatureReport r = sheet.report();
    EXPECT_EQ(r.countWithoutCurvature, 5u);
    EXPECT_EQ(r.count, 160'000u - 5);
    EXPECT_NEAR(r.lowestFactor, 1.1, 1e-5);
    EXPECT_TRUE(std::isfinite(r.area));
}

} // namespace
} // namespace relief::test
