// Errors that are put into the reference's own frames must be found again, at their locations.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "check/check.h"
#include "meshes.h"

namespace relief::test {
namespace {

HeightMap waves() {
    std::vector<float> texels(64 * 64);
    for (std::size_t i = 0; i < texels.size(); ++i) texels[i] = float(0.05 * std::sin(double(i % 64) / 64 * 6.2831853));
    return makeHeightMap(64, 64, std::move(texels), 0, 1, Wrap::repeat);
}

/// A cage, its samples, and a device that makes no errors but rounding.
struct Perfect {
    Surface surface;
    ReferenceSurface reference;
    HeightMap map = waves();
    SurfaceSamples samples;
    std::vector<SampleResult> results;
    double diagonal;

    Perfect(const Cage& cage, const SurfaceOptions& options, std::size_t budget, NormalKind kind = NormalKind::full)
        : surface(buildSurface(cage, options)), reference(cage, options), samples(sampleEverywhere(surface, budget)),
          diagonal(summarize(cage).bounds.diagonal()) {
        for (const SampleQuery& query : samples.queries) {
            const DisplacedFrame f = displacedFrame(reference, &map, int(query.face), dvec2(query.uv));
            const dvec3& m = kind == NormalKind::limit ? f.normal : kind == NormalKind::full ? f.full : f.firstOrder;
            results.push_back({.p = vec3(f.limit.p),
                               .pu = vec3(f.limit.pu),
                               .pv = vec3(f.limit.pv),
                               .n = vec3(f.normal),
                               .m = vec3(m)});
        }
    }

    [[nodiscard]] FrameErrors errors(NormalKind kind = NormalKind::full) const {
        return compareFrames({&reference, &map, kind, diagonal}, samples.queries, results);
    }
    [[nodiscard]] std::size_t indexOf(std::uint32_t face, const vec2& uv) const {
        const auto found = std::ranges::find_if(
            samples.queries, [&](const SampleQuery& query) { return query.face == face && query.uv == uv; });
        return std::size_t(found - samples.queries.begin());
    }
};

void expectRounding(const RegionErrors& e) {
    EXPECT_LT(e.point.max, 1e-7);
    EXPECT_LT(e.tangent.max, 2e-7);
    EXPECT_LT(e.limitNormal.max, 1e-4);
    EXPECT_LT(e.normal.max, 1e-4);
}

TEST(Frames, withoutErrorsHaveNone) {
    const Perfect p(torusWithSeams(), {.isolation = 2}, 48 * 25);
    const FrameErrors errors = p.errors();
    EXPECT_EQ(errors.regular.count, 48u * 25);
    EXPECT_EQ(errors.endCaps.count, 0u);
    expectRounding(errors.regular);
    EXPECT_GT(errors.regular.point.max, 0) << "results are rounded to single precision";
    EXPECT_LE(errors.regular.point.rms, errors.regular.point.max);
}

TEST(Frames, haveTheirErrorsSummedUp) {
    Perfect p(torusWithSeams(), {.isolation = 2}, 48 * 25);
    const std::size_t i = p.indexOf(7, {0.25f, 0.75f});
    ASSERT_LT(i, p.results.size());
    p.results[i].p += vec3(0, 0, 3e-3 * p.diagonal);
    p.results[i].pv += vec3(2e-3 * p.diagonal, 0, 0);
    const vec3 side = glm::normalize(glm::cross(p.results[i].n, vec3(0.1f, 0.9f, 0.3f)));
    p.results[i].n = float(std::cos(0.1)) * p.results[i].n + float(std::sin(0.1)) * side;
    const RegionErrors e = p.errors().regular;
    EXPECT_NEAR(e.point.max, 3e-3, 1e-6);
    EXPECT_NEAR(e.point.rms, 3e-3 / std::sqrt(48.0 * 25), 1e-6);
    EXPECT_NEAR(e.tangent.max, 2e-3, 1e-6);
    EXPECT_NEAR(e.limitNormal.max, glm::degrees(0.1), 1e-3);
    EXPECT_LT(e.normal.max, 1e-4);
    for (const SurfaceLocation& location : {e.point.worst, e.tangent.worst, e.limitNormal.worst}) {
        EXPECT_EQ(location.face, 7u);
        EXPECT_EQ(location.uv, vec2(0.25f, 0.75f));
    }
}

TEST(Frames, areComparedWithTheNormalThatWasAsked) {
    for (const NormalKind kind : {NormalKind::limit, NormalKind::firstOrder, NormalKind::full}) {
        const Perfect p(torusWithSeams(), {.isolation = 2}, 48 * 16, kind);
        EXPECT_LT(p.errors(kind).regular.normal.max, 1e-4);
        for (const NormalKind other : {NormalKind::limit, NormalKind::firstOrder, NormalKind::full})
            if (other != kind) {
                EXPECT_GT(p.errors(other).regular.normal.max, 0.02);
            }
    }
}

TEST(Frames, inEndCapsAreCountedApart) {
    Perfect p(cube(), {.isolation = 3, .endCaps = EndCapKind::gregory},
              6 * 49); // a sixth is more than the end caps' eighth
    const FrameErrors before = p.errors();
    EXPECT_EQ(before.endCaps.count, 24u) << "the corners of the faces";
    EXPECT_EQ(before.regular.count, 6u * 49 - 24);
    expectRounding(before.endCaps);
    expectRounding(before.regular);
    p.results[p.indexOf(2, {1, 1})].p.x += float(0.01 * p.diagonal);
    const FrameErrors after = p.errors();
    EXPECT_NEAR(after.endCaps.point.max, 0.01, 1e-6);
    EXPECT_EQ(after.endCaps.point.worst.face, 2u);
    expectRounding(after.regular);
}

TEST(Frames, withoutATangentPlaneHaveNoNormals) {
    Perfect p(boundaryGrid(), {.isolation = 2, .endCaps = EndCapKind::gregory},
              16 * 9); // smooth corners: both tangents run along the boundary
    for (const std::uint32_t face : {0u, 3u, 12u, 15u})
        for (std::size_t i = 9 * face; i < 9 * (face + 1); ++i)
            if (!p.reference.limit(int(face), dvec2(p.samples.queries[i].uv)).hasTangentPlane())
                p.results[i].n = p.results[i].m = p.results[i].pu = vec3(1, 0, 0);
    const FrameErrors e = p.errors();
    EXPECT_EQ(e.endCaps.count, 4u);
    EXPECT_EQ(e.endCaps.countWithoutNormal, 4u);
    EXPECT_EQ(e.regular.countWithoutNormal, 0u);
    expectRounding(e.endCaps);
    expectRounding(e.regular);
}

TEST(Frames, thatAreNoNumbersAreInfinitelyWrong) {
    Perfect p(torusWithSeams(), {.isolation = 2}, 48 * 9);
    p.results[5].p.y = std::numeric_limits<float>::quiet_NaN();
    p.results[6].pu.y = std::numeric_limits<float>::quiet_NaN();
    p.results[7].n.y = std::numeric_limits<float>::quiet_NaN();
    const RegionErrors e = p.errors().regular;
    EXPECT_TRUE(std::isinf(e.point.max));
    EXPECT_TRUE(std::isinf(e.point.rms));
    EXPECT_TRUE(std::isinf(e.tangent.max));
    EXPECT_TRUE(std::isinf(e.limitNormal.max));
    EXPECT_LT(e.normal.max, 1e-4);
}

// --- samples

TEST(Samples, coverTheFacesThatAreDrawn) {
    for (const NamedCage& named : allCages()) {
        for (const bool isLoop : {false, true}) {
            if (isLoop && !named.cage.isAllTriangles()) continue;
            const Surface surface =
                buildSurface(named.cage, {.scheme = isLoop ? Scheme::loop : Scheme::catmark, .isolation = 1});
            const SurfaceSamples samples = sampleEverywhere(surface, 5000);
            ASSERT_EQ(samples.queries.size(), samples.weights.size());
            EXPECT_LE(samples.queries.size(), 5000u) << named.name;
            EXPECT_GT(samples.queries.size(), 2000u) << named.name;
            std::vector<double> areas(surface.faces.size());
            std::vector<int> corners(surface.faces.size());
            for (std::size_t i = 0; i < samples.queries.size(); ++i) {
                const auto& [face, uv] = samples.queries[i];
                areas[face] += samples.weights[i];
                corners[face] += int((uv.x == 0 || uv.x == 1) && (uv.y == 0 || uv.y == 1));
                EXPECT_TRUE(uv.x >= 0 && uv.y >= 0 && (isLoop ? uv.x + uv.y <= 1 : uv.x <= 1 && uv.y <= 1));
            }
            for (std::size_t face = 0; face < areas.size(); ++face) {
                const bool isDrawn = surface.faces[face].root != kNoPatch;
                EXPECT_NEAR(areas[face], isDrawn ? isLoop ? 0.5 : 1.0 : 0.0, 1e-12) << named.name;
                EXPECT_EQ(corners[face], isDrawn ? surface.sideCount : 0) << named.name;
            }
        }
    }
}

// Quads: the eight corners of the cube are corners of end caps, a face has 4 of them. Triangles likewise.
TEST(Samples, markWhereThereIsNoCurvature) {
    const auto withoutCurvature = [](const Cage& cage, const SurfaceOptions& options, std::size_t budget = 0) {
        const SurfaceSamples samples = sampleEverywhere(buildSurface(cage, options), budget);
        std::vector<SampleQuery> found;
        for (std::size_t i = 0; i < samples.queries.size(); ++i)
            if (!samples.hasCurvature[i]) found.push_back(samples.queries[i]);
        return found;
    };
    const std::vector<SampleQuery> ofCube = withoutCurvature(cube(), {.isolation = 3});
    EXPECT_EQ(ofCube.size(), 24u);
    for (const SampleQuery& query : ofCube)
        EXPECT_TRUE((query.uv.x == 0 || query.uv.x == 1) && (query.uv.y == 0 || query.uv.y == 1));
    EXPECT_EQ(withoutCurvature(cube(), {.isolation = 1}, 6 * 25).size(), 6u * 4) << "the vertices";
    EXPECT_EQ(withoutCurvature(cube(), {.isolation = 1, .endCaps = EndCapKind::gregory}, 6 * 25).size(), 6u * 9)
        << "a face is four end caps";
    EXPECT_EQ(withoutCurvature(icosahedron(), {.scheme = Scheme::loop, .isolation = 3}).size(), 60u);
    EXPECT_EQ(withoutCurvature(torusWithSeams(), {.isolation = 3}).size(), 0u);
    EXPECT_EQ(withoutCurvature(hardCube(), {.isolation = 3}).size(), 0u) << "corner patches have a curvature";
}

TEST(Samples, areAlwaysInsideOfFacesToo) {
    EXPECT_EQ(sampleEverywhere(buildSurface(cube(), {.isolation = 1}), 0).queries.size(), 6u * 9);
    EXPECT_EQ(sampleEverywhere(buildSurface(icosahedron(), {.scheme = Scheme::loop, .isolation = 1}), 0).queries.size(),
              20u * 10);
    EXPECT_EQ(sampleEverywhere(buildSurface(cube(), {.isolation = 1}), 600).queries.size(), 600u);
}

} // namespace
} // namespace relief::test
