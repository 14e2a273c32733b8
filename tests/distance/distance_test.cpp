// Distances between surfaces whose distance is known.
#include <cmath>
#include <limits>

#include "distance/distance.h"
#include "support.h"

namespace relief::test {
namespace {

struct Mesh {
    std::vector<vec3> positions;
    std::vector<std::uint32_t> indices;

    [[nodiscard]] MeasuredSurface measured(std::size_t samples = 20'000) const {
        return MeasuredSurface({positions, indices}, samples);
    }
};

/// n * n quads over (0..1)^2 at the heights that `height` gives; every other diagonal turned.
template <typename Height>
Mesh sheet(std::uint32_t n, const Height& height) {
    Mesh mesh;
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) {
            const dvec2 st(double(x) / n, double(y) / n);
            mesh.positions.emplace_back(st.x, height(st), st.y);
        }
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 2, d = a + n + 1;
            if ((x + y) % 2 == 0)
                mesh.indices.insert(mesh.indices.end(), {a, b, c, a, c, d});
            else
                mesh.indices.insert(mesh.indices.end(), {a, b, d, b, c, d});
        }
    return mesh;
}
Mesh flatSheet(std::uint32_t n, double y) {
    return sheet(n, [y](const dvec2&) { return y; });
}

/// A cube's faces, n * n quads each, blown up to a sphere.
Mesh sphere(std::uint32_t n, double radius) {
    Mesh mesh;
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const Mesh face = flatSheet(n, 0);
            const auto first = std::uint32_t(mesh.positions.size());
            for (const vec3& p : face.positions) {
                dvec3 q;
                q[axis] = side, q[(axis + 1) % 3] = std::tan((p.x - 0.5) * 1.5707963),
                q[(axis + 2) % 3] = std::tan((p.z - 0.5) * 1.5707963);
                mesh.positions.emplace_back(radius * glm::normalize(q));
            }
            for (const std::uint32_t i : face.indices) mesh.indices.push_back(first + i);
        }
    return mesh;
}

/// Twelve triangles.
Mesh cube(const dvec3& lower, double side) {
    Mesh mesh;
    for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(lower + side * dvec3(i & 1, i >> 1 & 1, i >> 2 & 1));
    mesh.indices = {0, 1, 3, 0, 3, 2, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                    2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 3, 7, 1, 7, 5};
    return mesh;
}

TEST(Distance, ofParallelPlanesIsTheirGapWhateverTheirTriangles) {
    for (const std::uint32_t n : {1u, 3u, 40u, 200u}) {
        const SurfaceDistance d = measureDistance(flatSheet(n, 0).measured(), flatSheet(7, 0.25).measured());
        EXPECT_NEAR(d.rms(), 0.25, 1e-7) << n;
        EXPECT_NEAR(d.hausdorff(), 0.25, 1e-7) << n;
        EXPECT_NEAR(d.forth.mean, 0.25, 1e-7) << n;
        EXPECT_LT(d.rmsError(), 1e-7) << n;
    }
}

TEST(Distance, toItselfIsNothing) {
    const MeasuredSurface a = sphere(20, 3).measured(), b = sphere(20, 3).measured();
    const SurfaceDistance d = measureDistance(a, b);
    EXPECT_LT(d.hausdorff(), 3e-7);
}

TEST(Distance, ofConcentricSpheresIsTheDifferenceOfTheirRadii) {
    const SurfaceDistance d = measureDistance(sphere(64, 1).measured(), sphere(64, 1.25).measured());
    EXPECT_NEAR(d.rms(), 0.25, 3e-4); // facets of 1.4 degrees lie up to 1.5e-4 of a radius below the sphere
    EXPECT_NEAR(d.hausdorff(), 0.25, 3e-4);
}

TEST(Distance, isMeasuredBothWays) {
    // Half of the sheet: from the half to the whole there is nothing, back there is a quarter of it on average.
    Mesh half = flatSheet(1, 0);
    for (vec3& p : half.positions) p.x *= 0.5f;
    const SurfaceDistance d = measureDistance(half.measured(), flatSheet(1, 0).measured(200'000));
    EXPECT_LT(d.forth.max, 1e-7);
    EXPECT_NEAR(d.back.mean, 0.125, 1e-4);              // x - 1/2 over the other half
    EXPECT_NEAR(d.back.rms, std::sqrt(1.0 / 24), 1e-4); // its square
    EXPECT_NEAR(d.rms(), std::sqrt(0.5 / 24), 1e-4);
    EXPECT_LE(d.back.max, 0.5);
    EXPECT_GE(d.back.max + d.back.coverage, 0.5); // what the maximum promises
}

TEST(Distance, ofOffsetCubesIsAtTheirFarCorners) {
    const SurfaceDistance d =
        measureDistance(cube(dvec3(0), 1).measured(100'000), cube(dvec3(0, 0, 0.5), 1).measured(100'000));
    // The bottom of the lower cube is half a unit from the other's bottom; its side walls slide along.
    EXPECT_LE(d.hausdorff(), 0.5 + 1e-6);
    EXPECT_GE(d.hausdorff() + d.forth.coverage, 0.5);
    // Bottom: 1/2 everywhere. Top, in the middle of the other cube: the nearest wall or cap, by symmetry of 8 wedges
    // x <= y, x <= 1/2: 8 * integral of x^2 (1/2 - x) over 0..1/2 = 1/24. Walls: z below 1/2 is 1/2 - z away, 1/24
    // of each of four; above they meet.
    EXPECT_NEAR(d.forth.rms, std::sqrt((0.25 + 1.0 / 24 + 4.0 / 24) / 6), 1e-3);
    EXPECT_NEAR(d.back.rms, d.forth.rms, 1e-3);
}

TEST(Distance, ofAWaveToThePlaneIsItsRms) {
    const auto wave = [](const dvec2& st) { return 0.01 * std::sin(20 * 3.14159265 * st.x); };
    const SampledDistance d = measureOneWay(sheet(400, wave).measured(50'000), flatSheet(1, 0).measured());
    // sqrt(1/2), but weighted by the wave's own area: steep parts, near zero, count for more (slope 0.628 at most).
    EXPECT_NEAR(d.rms, 0.01 * std::sqrt(0.5), 0.01 * 0.02);
    EXPECT_LT(d.rmsError, 0.002 * d.rms + 1e-6);
    EXPECT_NEAR(d.max, 0.01, 1e-5);
}

TEST(Distance, samplesAreTheSameInEveryRun) {
    const auto wave = [](const dvec2& st) { return 0.1 * st.x * st.y; };
    for (const std::size_t samples : {1000u, 100'000u}) {
        const SurfaceDistance a =
            measureDistance(sheet(60, wave).measured(samples), flatSheet(9, 0.03).measured(samples));
        const SurfaceDistance b =
            measureDistance(sheet(60, wave).measured(samples), flatSheet(9, 0.03).measured(samples));
        EXPECT_EQ(a.rms(), b.rms());
        EXPECT_EQ(a.hausdorff(), b.hausdorff());
    }
}

TEST(Distance, samplesCoverTheSurfaceEvenly) {
    const auto ramp = [](const dvec2& st) { return 0.1 * st.x; };
    const MeasuredSurface floor = flatSheet(1, 0).measured();
    for (const std::uint32_t n : {1u, 5u, 300u}) { // parts of few triangles, runs of many
        const MeasuredSurface surface = sheet(n, ramp).measured(10'000);
        EXPECT_NEAR(double(surface.sampleCount()), 10'000, 2'000) << n;
        const SampledDistance d = measureOneWay(surface, floor);
        EXPECT_NEAR(d.mean, 0.05, 5e-5) << n;
        EXPECT_NEAR(d.rms, 0.1 / std::sqrt(3), 5e-5) << n;
        EXPECT_NEAR(d.max, 0.1, 1e-3) << n;
    }
    EXPECT_LT(flatSheet(1, 0).measured(10'000).coverage(), 0.03); // parts of a hundredth
}

TEST(Distance, toASinglePointIsExact) {
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}};
    const MeasuredSurface triangle = mesh.measured(10);
    EXPECT_DOUBLE_EQ(triangle.distance({0.25, 0.25, 2}), 2);       // inside
    EXPECT_DOUBLE_EQ(triangle.distance({-3, -4, 0}), 5);           // a corner,
    EXPECT_DOUBLE_EQ(triangle.distance({3, -1, 0}), std::sqrt(5)); // another,
    EXPECT_DOUBLE_EQ(triangle.distance({-1, 2, 0}), std::sqrt(2)); // the third
    EXPECT_DOUBLE_EQ(triangle.distance({0.5, -1, 0}), 1);          // sides
    EXPECT_DOUBLE_EQ(triangle.distance({-1, 0.5, 0}), 1);
    EXPECT_NEAR(triangle.distance({1, 1, 0}), std::sqrt(0.5), 1e-15);
}

TEST(Distance, takesTrianglesWithoutAreaAsTheirSides) {
    const Mesh mesh{{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 0, 5}, {1, 0, 5}, {0, 1, 5}}, {0, 1, 2, 0, 0, 0, 3, 4, 5}};
    const MeasuredSurface surface = mesh.measured(10);
    EXPECT_DOUBLE_EQ(surface.distance({1.5, 1, 0}), 1);
    EXPECT_DOUBLE_EQ(surface.distance({-1, 0, 0}), 1);
}

TEST(Distance, refusesWhatHasNoSurface) {
    const Mesh good = flatSheet(1, 0);
    Mesh bad = good;
    bad.indices[4] = 4;
    expectFailure(Failure::input, {"triangle 1", "vertex 4", "0 to 3"}, [&] { (void)bad.measured(); });
    bad = good;
    bad.positions[2].y = std::numeric_limits<float>::quiet_NaN();
    expectFailure(Failure::input, {"vertex 2", "not finite"}, [&] { (void)bad.measured(); });
    expectFailure(Failure::input, {"no area"}, [&] { (void)Mesh{{{0, 0, 0}, {1, 0, 0}}, {0, 1, 0}}.measured(); });
    expectFailure(Failure::input, {"triangle"}, [&] { (void)Mesh{}.measured(); });
}

} // namespace
} // namespace relief::test
