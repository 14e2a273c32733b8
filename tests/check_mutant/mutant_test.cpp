// The test of the certificate: with shaders whose q_u = p_u + h_u n has lost its h n_u, the comparison with the
// reference must call the displaced normals wrong. It could not if both sides shared the formula. The same shaders read
// sets of tiles with neighbouring tiles in each other's places, which heights must show.
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

/// A tile in each of four unit squares, whose heights go on across the borders.
HeightMap tilesOfWaves() {
    std::vector<HeightMap> maps;
    std::vector<ivec2> places;
    for (int tile = 0; tile < 4; ++tile) {
        std::vector<float> texels;
        for (int i = 0; i < 32 * 32; ++i) texels.push_back(float(std::sin(0.1 * (32 * tile + i % 32))));
        maps.push_back(makeHeightMap(32, 32, std::move(texels), 0, 0.1, Wrap::clamp));
        places.emplace_back(tile, 0);
    }
    return makeTileSet(maps, places);
}

TEST(TileMutant, isFoundByTheComparisonOfHeights) {
    Cage cage = torusWithSeams();
    for (vec2& st : cage.texCoords) st.x *= 4; // islands cross three borders
    const Surface surface = buildSurface(cage, {.isolation = 2});
    const ReferenceSurface reference(cage, {.isolation = 2});
    const HeightMap tiles = tilesOfWaves();
    Device device;
    SurfaceSampler sampler(device);
    const std::vector<SampleQuery> queries = sampleEverywhere(surface, 1000).queries;
    const SurfaceModel model(device, {.surface = &surface, .cagePositions = cage.positions, .height = &tiles});
    const std::vector<SampleResult> results = sampler.sample(model, queries);
    double largest = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const MapPlace place{.st = reference.texture(int(queries[i].face), dvec2(queries[i].uv)).st};
        largest = std::max(largest, std::abs(sampleHeight(tiles, place).h - double(results[i].h)));
    }
    EXPECT_GT(largest, 0.05);
}

} // namespace
} // namespace relief::test
