// Sums of maps: what they are at any point, and what has no sum.
#include "displacement/layers.h"

#include <random>

#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

HeightMap noise(int width, int height, unsigned seed, double mid = 0.25, double scale = 0.5) {
    std::mt19937 random(seed);
    std::vector<float> texels;
    for (int i = 0; i < width * height; ++i) texels.push_back(float(random() % 1000) / 1000);
    return makeHeightMap(width, height, std::move(texels), mid, scale, Wrap::repeat);
}

MapLayer layerOf(HeightMap map, const MapPlacement& placement = {}) {
    return {.name = "map", .map = std::move(map), .placement = placement, .maskName = "mask", .mask = {}};
}

/// Largest difference of the sum from what is expected of it, at points all over 0..1.
double errorOf(std::span<const MapLayer> layers, const std::function<double(const dvec2&)>& expected) {
    const EncodedMap sum = addLayers(layers, Wrap::repeat, MapFormat::real);
    double error = 0;
    for (int j = 0; j < 53; ++j)
        for (int i = 0; i < 53; ++i) {
            const dvec2 st = dvec2(i + 0.37, j + 0.11) / 53.0;
            error = std::max(error, std::abs(sampleHeight(sum.decoded, st).h - expected(st)));
        }
    return error;
}

TEST(MapLayers, ofOneSizeAreTheSumEverywhere) {
    const std::vector<MapLayer> layers{layerOf(noise(16, 8, 1)), layerOf(noise(16, 8, 2, 0, -2)),
                                       layerOf(noise(16, 8, 3))};
    EXPECT_LT(errorOf(layers,
                      [&](const dvec2& st) {
                          double sum = 0;
                          for (const MapLayer& layer : layers) sum += sampleHeight(layer.map, st).h;
                          return sum;
                      }),
              1e-6);
}

TEST(MapLayers, repeatAndMoveByTheirPlacement) {
    const MapPlacement placement{.repeat = {3, 1}, .offset = {2.0 / 8, 0}};
    // 24 texels of both: those of the repeated layer are those of the other one.
    const std::vector<MapLayer> layers{layerOf(noise(24, 8, 1)), layerOf(noise(8, 8, 2), placement)};
    const auto expected = [&](const dvec2& st) {
        return sampleHeight(layers[0].map, st).h + sampleHeight(layers[1].map, dvec2(3 * st.x + 0.25, st.y)).h;
    };
    EXPECT_LT(errorOf(layers, expected), 1e-6);
    EXPECT_TRUE(repeatsWhole(layers));
    EXPECT_FALSE(repeatsWhole(std::vector{layerOf(noise(2, 2, 1), {.repeat = {1.5, 1}})}));
}

TEST(MapLayers, ofOtherSizesAreExactByOddFactorsAndNearByOthers) {
    const auto both = [](int side) {
        return std::vector<MapLayer>{layerOf(noise(side, side, 1)), layerOf(noise(8, 8, 2))};
    };
    for (const int side : {24, 16}) {
        const std::vector<MapLayer> layers = both(side);
        const double error = errorOf(layers, [&](const dvec2& st) {
            return sampleHeight(layers[0].map, st).h + sampleHeight(layers[1].map, st).h;
        });
        EXPECT_LT(error, side == 24 ? 1e-6 : 2 * 0.5 * 2 / 8.0); // a second difference is at most twice the range
        EXPECT_TRUE(side == 24 || error > 1e-3) << error;
    }
}

TEST(MapLayers, areMultipliedWithTheirMask) {
    std::vector<MapLayer> layers{layerOf(noise(8, 8, 1)), layerOf(noise(8, 8, 2), {.repeat = {2, 2}})};
    layers[1].mask = makeHeightMap(2, 1, {0, 1}, 0, 1, Wrap::clamp);
    const HeightMap sum = addLayers(layers, Wrap::repeat, MapFormat::real).decoded;
    EXPECT_EQ(ivec2(sum.width, sum.height), ivec2(16, 16));
    for (const double t : {0.5 / 16, 7.5 / 16}) {
        const double first = sampleHeight(layers[0].map, dvec2(0.5 / 16, t)).h;
        EXPECT_NEAR(sampleHeight(sum, dvec2(0.5 / 16, t)).h, first, 1e-6) << "where the mask is 0";
        const dvec2 right(15.5 / 16, t);
        EXPECT_NEAR(sampleHeight(sum, right).h,
                    sampleHeight(layers[0].map, right).h + sampleHeight(layers[1].map, 2.0 * right).h, 1e-6);
    }
}

TEST(MapLayers, ofHeightsAreVectorsAlongTheNormal) {
    Image components{.width = 8, .height = 8, .channels = 3, .texels = {}};
    std::mt19937 random(1);
    for (int i = 0; i < 192; ++i) components.texels.push_back(float(random() % 100) / 100);
    const HeightMap vectors = makeVectorMap(components, {.limits = {}}), heights = noise(8, 8, 2);
    const EncodedMap sum = addLayers(std::vector{layerOf(heights), layerOf(vectors)}, Wrap::repeat, MapFormat::real);
    ASSERT_TRUE(sum.decoded.vectors);
    for (const dvec2& st : {dvec2(0.3, 0.81), dvec2(0.99, 0.02)}) {
        const VectorSample all = sampleVectors(*sum.decoded.vectors, st), own = sampleVectors(*vectors.vectors, st);
        const HeightSample height = sampleHeight(heights, st);
        EXPECT_LT(glm::length(all.c - own.c - dvec3(0, 0, height.h)), 1e-6);
        EXPECT_LT(glm::length(all.cs - own.cs - dvec3(0, 0, height.hs)), 1e-5);
        EXPECT_LT(glm::length(all.ct - own.ct - dvec3(0, 0, height.ht)), 1e-5);
    }
    const HeightMap inObject = makeVectorMap(components, {.space = VectorSpace::object, .limits = {}});
    expectFailure(Failure::usage, {"object space"}, [&] {
        addLayers(std::vector{layerOf(heights), layerOf(inObject)}, Wrap::repeat, MapFormat::real);
    });
    expectFailure(Failure::usage, {"tangent space"}, [&] {
        addLayers(std::vector{layerOf(vectors), layerOf(inObject)}, Wrap::repeat, MapFormat::real);
    });
}

TEST(MapLayers, ofTilesAreOverTheTilesOfAll) {
    const std::vector<HeightMap> maps{noise(8, 8, 1), noise(4, 8, 2)};
    const HeightMap first = makeTileSet(std::span(maps).first(1), std::vector{ivec2(0, 0)});
    const HeightMap second = makeTileSet(maps, std::vector{ivec2(1, 0), ivec2(0, 0)});
    const HeightMap plain = noise(8, 8, 3);
    const std::vector<MapLayer> layers{layerOf(first), layerOf(second), layerOf(plain)};
    const HeightMap sum = addLayers(layers, Wrap::repeat, MapFormat::real).decoded;
    ASSERT_EQ(sum.tiles.size(), 2u);
    for (const dvec2& st : {dvec2(2.5, 3.5) / 8.0, dvec2(8 + 3.5, 1.5) / 8.0}) // centres of texels
        EXPECT_NEAR(sampleHeight(sum, st).h,
                    sampleHeight(first, st).h + sampleHeight(second, st).h + sampleHeight(plain, st).h, 1e-6);
    expectFailure(Failure::usage, {"set of tiles", "no repeat"}, [&] {
        addLayers(std::vector{layerOf(first, {.repeat = {2, 2}})}, Wrap::repeat, MapFormat::real);
    });
}

TEST(MapLayers, ofTilesAndVectorsAreVectorsInTiles) {
    Image components{.width = 8, .height = 8, .channels = 3, .texels = {}};
    std::mt19937 random(1);
    for (int i = 0; i < 192; ++i) components.texels.push_back(float(random() % 100) / 100);
    const HeightMap vectors = makeVectorMap(components, {.limits = {}});
    const HeightMap tiles =
        makeTileSet(std::vector{noise(8, 8, 1), noise(8, 8, 2)}, std::vector{ivec2(0, 0), ivec2(2, 0)});
    const HeightMap sum =
        addLayers(std::vector{layerOf(tiles), layerOf(vectors)}, Wrap::repeat, MapFormat::real).decoded;
    ASSERT_TRUE(sum.vectors);
    ASSERT_EQ(sum.tiles.size(), 2u);
    for (const dvec2& st : {dvec2(2.5, 3.5) / 8.0, dvec2(16 + 3.5, 1.5) / 8.0}) { // centres of texels
        const dvec3 expected = sampleVectors(*vectors.vectors, st).c + dvec3(0, 0, sampleHeight(tiles, st).h);
        EXPECT_LT(glm::length(sampleVectors(*sum.vectors, st).c - expected), 1e-6);
    }
}

// A map over texture coordinates becomes one per face where it is added to one, nodes as fine as its texels.
TEST(MapLayers, overTextureCoordinatesCanBePerFace) {
    const Cage cage = torusWithSeams(6, 4);
    const Surface surface = buildSurface(cage, {.isolation = 1});
    const ReferenceSurface reference(cage, {.isolation = 1});
    const HeightMap texture = noise(24, 16, 3); // four texels per face each way
    const MapPlacement twice{.repeat = {2, 1}, .offset = {0.125, 0}};
    const HeightMap faces = toFaceMap(texture, twice, surface, reference);
    for (int f = 0; f < int(surface.faces.size()); ++f) {
        EXPECT_EQ(faces.tiles[std::size_t(f)].segments, ivec2(3, 2));
        const dvec2 uv(0.625, 0.5); // a node
        const dvec2 st = twice.at(reference.texture(f, uv).st);
        EXPECT_NEAR(sampleHeight(faces, {.face = f, .uv = uv}).h, sampleHeight(texture, st).h, 1e-6);
    }
    const HeightMap coarse = toFaceMap(texture, {}, surface, reference, 2);
    EXPECT_EQ(coarse.tiles[0].segments, ivec2(1));
}

TEST(MapLayers, ofFacesAreTheSumOfFittedMaps) {
    const Surface surface = buildSurface(torusWithSeams(6, 4), {.isolation = 1});
    std::mt19937 random(1);
    const auto faces = [&](const ivec2& segments) {
        return makeFaceMap(surface, std::vector<ivec2>(surface.faces.size(), segments),
                           [&](int, const dvec2&) { return double(random() % 100) / 100; });
    };
    const HeightMap a = faces({3, 1}), b = faces({1, 2});
    HeightMap sum = addLayers(std::vector{layerOf(a), layerOf(b)}, Wrap::repeat, MapFormat::real).decoded;
    fitToFaces(sum, surface);
    for (std::size_t f = 0; f < surface.faces.size(); ++f)
        for (const dvec2& uv : {dvec2(0.31, 0.47), dvec2(0, 0), dvec2(0.5, 0.125)}) {
            const MapPlace place{.face = int(f), .uv = uv};
            EXPECT_NEAR(sampleHeight(sum, place).h, sampleHeight(a, place).h + sampleHeight(b, place).h, 1e-6);
        }
    expectFailure(Failure::usage, {"per face", "relief map"}, [&] {
        addLayers(std::vector{layerOf(a), layerOf(noise(2, 2, 1))}, Wrap::repeat, MapFormat::real);
    });
}

TEST(MapLayers, thatAreTooLargeAreRefused) {
    expectFailure(Failure::input, {"map", "less often"}, [&] {
        addLayers(std::vector{layerOf(noise(64, 64, 1), {.repeat = {1000, 1}})}, Wrap::repeat, MapFormat::real);
    });
}

// The same heights in a map per face and in a map over texture coordinates, texel for node: heights and slopes are the
// same across all edges, those of the seams too.
TEST(FaceMaps, haveTheSlopesOfATextureOnAGrid) {
    constexpr int kAround = 8, kAcross = 6, kSegments = 8;
    Cage cage = torusWithSeams(kAround, kAcross);
    const dvec2 texels(kAround * kSegments, kAcross * kSegments);
    for (vec2& st : cage.texCoords) st += vec2(0.5 / texels.x, -0.5 / texels.y); // nodes at centres of texels
    const Surface surface = buildSurface(cage, {.isolation = 1});
    const ReferenceSurface reference(cage, {.isolation = 1});
    const HeightMap texture = noise(int(texels.x), int(texels.y), 5);
    const auto at = [&](int face, const dvec2& uv) { return sampleHeight(texture, reference.texture(face, uv).st); };
    const HeightMap faces = makeFaceMap(surface, std::vector<ivec2>(surface.faces.size(), ivec2(3, 3)),
                                        [&](int face, const dvec2& uv) { return at(face, uv).h; });
    double height = 0, slope = 0;
    for (int f = 0; f < int(surface.faces.size()); ++f)
        for (int j = 0; j <= 2 * kSegments; ++j)
            for (int i = 0; i <= 2 * kSegments; ++i) {
                const dvec2 uv = dvec2(i, j) / (2.0 * kSegments);
                const HeightSample expected = at(f, uv), own = sampleHeight(faces, {.face = f, .uv = uv});
                const dmat2 jacobian = reference.texture(f, uv).jacobian;
                const dvec2 gradient(expected.hs, expected.ht);
                const dvec2 alongFace(glm::dot(gradient, jacobian[0]), glm::dot(gradient, jacobian[1]));
                height = std::max(height, std::abs(own.h - expected.h));
                slope = std::max(slope, glm::length(dvec2(own.hs, own.ht) - alongFace));
            }
    EXPECT_LT(height, 1e-6);
    EXPECT_LT(slope, 1e-5);
}

} // namespace
} // namespace relief::test
