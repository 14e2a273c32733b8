// Rates, mips, bounds and the faces that a picture omits.
#include <algorithm>
#include <random>

#include "frame/device.h"
#include "frame/passes.h"
#include "maps.h"
#include "meshes.h"
#include "model/bounds.h"
#include "support.h"

namespace relief::test {
namespace {

class Rates : public OnDevice {};

EdgeRater& rater() {
    static EdgeRater instance(device());
    return instance;
}

Dicer& dicer() {
    static Dicer instance(device());
    return instance;
}

std::vector<SampleQuery> queriesOf(const Surface& surface, int side) {
    std::vector<SampleQuery> queries;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face)
        for (int j = 0; j <= side && surface.faces[face].root != kNoPatch; ++j)
            for (int i = 0; i <= side; ++i) queries.push_back({face, vec2(i, j) / float(side)});
    return queries;
}

/// A cage, its map and both on the device.
struct Subject {
    Cage cage;
    HeightMap map;
    Surface surface = buildSurface(cage, {.isolation = 3});
    SurfaceModel model{device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map}};
};

TEST_F(Rates, boundsHoldEveryDisplacedPoint) {
    for (NamedCage& named : allCages()) {
        const Subject s{named.cage, sineMap(40, 0.3, 3)}; // 40: blocks stick out of no map, 3 waves wrap round it
        const std::vector<SampleQuery> queries = queriesOf(s.surface, 7);
        const std::vector<SampleResult> results = sampler().sample(s.model, queries);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const Bounds& box = s.model.faceBounds[queries[i].face];
            const dvec3 q(results[i].q);
            EXPECT_TRUE(glm::all(glm::greaterThan(q, box.lower - 1e-5)) && glm::all(glm::lessThan(q, box.upper + 1e-5)))
                << named.name << " face " << queries[i].face;
        }
    }
}

// Mips of few bits may lie outside of the texels that they stand for.
TEST(Bounds, areWiderByTheRoundOffOfMips) {
    const HeightMap map = waves(64, 64);
    const vec2 lower(0.25f), upper(0.5f);
    const Range exact = HeightPyramid(map).range({lower, upper}),
                wide = HeightPyramid(map, 0.01f).range({lower, upper});
    EXPECT_NEAR(wide.highest - exact.highest, 0.01 * map.scale, 1e-6);
    EXPECT_NEAR(exact.lowest - wide.lowest, 0.01 * map.scale, 1e-6);
    EXPECT_NEAR(wide.slopeS - exact.slopeS, 0.01 * 64 * map.scale, 1e-4);
}

TEST_F(Rates, boundsFollowTheMapAndNotItsExtremes) {
    std::vector<float> texels(64 * 64, 0.0f);
    texels[5 * 64 + 5] = 1; // one spike in the upper left corner
    const Subject s{boundaryGrid(16, 16), makeHeightMap(64, 64, texels, 0, 10, Wrap::clamp)};
    const auto isHigh = [](const Bounds& box) { return box.upper.y > 1; };
    const auto count = std::ranges::count_if(s.model.faceBounds, isHigh);
    EXPECT_GE(count, 1);
    EXPECT_LE(count, 40); // of 256
}

// What the camera sees of a face that is omitted would be missing from the picture.
TEST_F(Rates, hiddenFacesHaveNoPointInView) {
    const Subject s{torusWithSeams(16, 12), sineMap(64, 0.2, 4)};
    const Camera camera = frameCamera({{dvec3(2, 0, 0), dvec3(2.5, 0.5, 0.5)}}, {}, 1);
    const mat4 worldToClip = perspectiveMatrix(camera, 1);
    const std::vector<char> isVisible = visibleFaces(s.model, worldToClip, viewOf(camera, 64));
    EXPECT_GT(std::ranges::count(isVisible, 0), 60);
    EXPECT_GT(std::ranges::count(isVisible, 1), 4);
    const std::vector<SampleQuery> queries = queriesOf(s.surface, 9);
    const std::vector<SampleResult> results = sampler().sample(s.model, queries);
    for (std::size_t i = 0; i < queries.size(); ++i) {
        if (isVisible[queries[i].face] != 0) continue;
        const vec4 c = worldToClip * vec4(results[i].q, 1);
        EXPECT_FALSE(c.w > 0 && std::abs(c.x) < c.w && std::abs(c.y) < c.w && c.z > 0 && c.z < c.w) << queries[i].face;
    }
}

// Seen from far away nothing is out of view: what is hidden faces away, in every point and with its displacement.
TEST_F(Rates, hiddenFacesFaceAwayEverywhere) {
    for (const double height : {0.0, 0.01, 0.3}) {
        const Subject s{torusWithSeams(24, 18), sineMap(128, height, 4)};
        const std::vector<dvec3> points(s.cage.positions.begin(), s.cage.positions.end());
        const Camera camera = frameCamera(points, {.distance = 40}, 1);
        const std::vector<char> isVisible = visibleFaces(s.model, perspectiveMatrix(camera, 1), viewOf(camera, 64));
        const auto hiddenCount = std::ranges::count(isVisible, 0);
        EXPECT_GE(hiddenCount, height < 0.005 ? 45 : height < 0.1 ? 25 : 0) << height; // of 432
        const std::vector<SampleQuery> queries = queriesOf(s.surface, 9);
        const std::vector<SampleResult> results = sampler().sample(s.model, queries);
        for (std::size_t i = 0; i < queries.size(); ++i)
            if (isVisible[queries[i].face] == 0) {
                EXPECT_GT(glm::dot(dvec3(results[i].m), dvec3(results[i].q) - camera.eye), 0) << queries[i].face;
            }
    }
}

TEST_F(Rates, facesThatFaceAwayAreSeenWhereTheNearPlaneCuts) {
    const Subject s{torusWithSeams(24, 18), sineMap(64, 0)};
    const std::vector<dvec3> points(s.cage.positions.begin(), s.cage.positions.end());
    Camera camera = frameCamera(points, {.distance = 12}, 1);
    const auto hiddenCount = [&] {
        return std::ranges::count(visibleFaces(s.model, perspectiveMatrix(camera, 1), viewOf(camera, 64)), 0);
    };
    EXPECT_GT(hiddenCount(), 40);
    camera.nearDistance = 10;
    EXPECT_EQ(hiddenCount(), 0);
}

TEST_F(Rates, picturesReportHowManyFacesAreHidden) {
    const Subject s{torusWithSeams(16, 12), sineMap(64, 0.1)};
    Renderer renderer(device(), {.width = 64, .height = 64, .shadowSide = 64});
    RenderOptions options;
    options.rate = 2;
    for (const vec3& p : s.cage.positions) options.bounds.add(dvec3(p));
    for (const Path path : {Path::tessellation, Path::grid}) {
        options.path = path;
        options.camera = frameCamera(std::vector<dvec3>(s.cage.positions.begin(), s.cage.positions.end()), {}, 1);
        EXPECT_LT(renderer.render(s.model, options).stats.hiddenFaceCount, 60u); // these face away
        options.camera = frameCamera({{dvec3(2, 0, 0), dvec3(2.5, 0.5, 0.5)}}, {}, 1);
        EXPECT_GT(renderer.render(s.model, options).stats.hiddenFaceCount, 60u);
    }
}

// Waves that are zero at the ends, the middle and the quarters of every edge.
TEST_F(Rates, seeHeightsBetweenTheirSamples) {
    const Cage cage = boundaryGrid(1, 1);
    const View view{.eye = vec3(0.5f, 3, -0.5f), .nearDistance = 0.1f, .pixelsAtUnitDistance = 300};
    const TriangleOptions options{.path = Path::grid, .edgePixels = 4};
    const Subject flat{cage, sineMap(128, 0, 8)}, waves{cage, sineMap(128, 1, 8)};
    const EdgeRates low = rater().rates(flat.model, options, view), high = rater().rates(waves.model, options, view);
    for (std::size_t edge = 0; edge < low.rates.size(); ++edge) EXPECT_GT(high.rates[edge], 1.3f * low.rates[edge]);
}

TEST_F(Rates, chooseTheMipWhoseTexelsAreAsLargeAsSegments) {
    const Subject s{boundaryGrid(4, 4), sineMap(256, 0.1, 61)}; // about four texels per wave, 64 texels per face
    const TriangleOptions coarse{.path = Path::dice, .rate = 4}, fine{.path = Path::dice, .rate = 64};
    EXPECT_FALSE(rater().rates(s.model, fine, {}).hasMips());
    const EdgeRates rates = rater().rates(s.model, coarse, {});
    ASSERT_EQ(rates.cornerLevels.size(), s.model.cornerFlags.size());
    for (const float level : rates.cornerLevels) EXPECT_NEAR(level, 4, 0.6);

    const auto largestHeight = [&](const EdgeRates& r) {
        float most = 0;
        for (const vec3& p : dicer().diceToHost(s.model, r).positions) most = std::max(most, std::abs(p.y));
        return most;
    };
    EXPECT_LT(largestHeight(rates), 1e-3f);
    EXPECT_GT(largestHeight({rates.rates, rates.spacing, {}}), 0.02f);
}

// The next pair of samples is born where its neighbours are.
TEST_F(Rates, fractionalSpacingIsContinuous) {
    const Subject s{cube(), sineMap(64, 0.1)};
    const auto points = [&](float rate) {
        return dicer()
            .diceToHost(s.model, {std::vector<float>(s.model.edges.size(), rate), Spacing::fractional, {}})
            .positions;
    };
    const std::vector<vec3> before = points(8), after = points(8.001f);
    EXPECT_GT(after.size(), before.size());
    for (const vec3& p : after) {
        float nearest = 1e30f;
        for (const vec3& q : before) nearest = std::min(nearest, glm::length(p - q));
        EXPECT_LT(nearest, 2e-3f);
    }
}

TEST_F(Rates, dicingRefusesMoreMemoryThanAllowed) {
    const Subject s{cube(), sineMap(16, 0.1)};
    const EdgeRates rates = rater().rates(s.model, {.path = Path::dice, .rate = 1024}, {});
    dicer().dice(s.model, rater().rates(s.model, {.path = Path::dice, .rate = 1}, {})); // makes what is kept per model
    const std::uint64_t before = device().allocatedBytes();
    expectFailure(Failure::device, {"12582912", "triangles", "--memory"},
                  [&] { dicer().dice(s.model, rates, {.memory = 1 << 20}); });
    EXPECT_EQ(device().allocatedBytes(), before);
}

TEST_F(Rates, dicedMeshesHaveEverySampleOnce) {
    for (const std::uint32_t rate : {1u, 2u, 5u, 80u}) {
        const Subject s{cube(), sineMap(16, 0.1)};
        const DicedMesh mesh =
            dicer().dice(s.model, rater().rates(s.model, {.path = Path::dice, .rate = int(rate)}, {}));
        EXPECT_EQ(mesh.vertexCount, 6 * rate * rate + 2);
        EXPECT_EQ(mesh.triangleCount, 12 * rate * rate);
    }
}

} // namespace
} // namespace relief::test
