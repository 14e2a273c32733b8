// The test of the certificate: with shaders whose q_u = p_u + h_u n has lost its h n_u, the comparison with the
// reference must call the displaced normals wrong. It could not if both sides shared the formula.
#include <cmath>

#include <gtest/gtest.h>

#include "check/check.h"
#include "meshes.h"

namespace relief::test {
namespace {

HeightMap waves() {
    std::vector<float> texels;
    for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) texels.push_back(float(std::sin(0.39 * x) * std::cos(0.2 * y)));
    return makeHeightMap(64, 64, std::move(texels), 0, 0.1, Wrap::repeat);
}

RegionErrors errorsOf(NormalKind normal) {
    const Cage cage = torusWithSeams();
    const SurfaceOptions options{.isolation = 3};
    const Surface surface = buildSurface(cage, options);
    const HeightMap map = waves();
    Device device;
    const SurfaceModel model(device, {.surface = &surface, .cagePositions = cage.positions, .height = &map});
    SurfaceSampler sampler(device);
    const std::vector<SampleQuery> queries = sampleEverywhere(surface, 5000).queries;
    const std::vector<SampleResult> results = sampler.sample(model, queries, {.normal = normal});
    const ReferenceSurface reference(cage, options);
    const FrameComparison with{&reference, &map, normal, computeBounds(cage.positions).diagonal()};
    return compareFrames(with, queries, results).regular;
}

TEST(FormulaMutant, isFoundByTheComparisonOfFullNormals) {
    const RegionErrors errors = errorsOf(NormalKind::full);
    EXPECT_GT(errors.count, 3000u);
    EXPECT_GT(errors.countMisturned, errors.count / 20);
}

TEST(FormulaMutant, leavesWhatDoesNotUseTheFormula) {
    const RegionErrors errors = errorsOf(NormalKind::firstOrder);
    EXPECT_EQ(errors.countMisturned, 0u);
    EXPECT_EQ(errors.countMisplaced, 0u);
    EXPECT_LT(errors.point.max, 1e-6);
}

} // namespace
} // namespace relief::test
