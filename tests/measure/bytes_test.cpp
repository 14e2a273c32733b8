// The model of bytes on cases computed by hand, and what formats leave of heights.
#include <cmath>

#include "measure/measure.h"
#include "support.h"

namespace relief::test {
namespace {

TEST(Bytes, ofDenseMeshesAreThoseOfVerticesAndIndices) {
    EXPECT_EQ(residentBytes(kRawLayout, {100, 180}), 100u * 32 + 180 * 12);
    EXPECT_EQ(residentBytes(kRawLayout, {100, 180}), denseBytes(100, 180));
    EXPECT_EQ(residentBytes(kQuantisedLayout, {100, 180}), 100u * 12 + 180 * 12);
}

TEST(Bytes, ofPosesAreWhatMoves) {
    EXPECT_EQ(posedCageBytes(1452), 17'424u);
    EXPECT_EQ(posedDenseBytes(kRawLayout, 523'452), 24u * 523'452);
    EXPECT_EQ(posedDenseBytes(kQuantisedLayout, 523'452), 8u * 523'452);
}

TEST(Traffic, ofADenseMeshIsBetweenItsBytesAndItsCalls) {
    const Traffic traffic = denseTraffic(kRawLayout, {100, 180}, 250);
    EXPECT_EQ(traffic.least, 5360u);
    EXPECT_EQ(traffic.cacheless, 250u * 32 + 180 * 12);
}

TEST(Traffic, ofAnEvaluationIsItsRecordsPointsAndTexels) {
    // The face's root and the patch 16 each, 2 words of the tree, 16 points of 16 bytes with 2 for each number, 12
    // texels.
    EXPECT_EQ(evaluationBytes({.hasTexCoords = false}), 32u + 8 + 16 * 18 + 12 * 4);
    EXPECT_EQ(evaluationBytes({.format = MapFormat::half}), 32u + 8 + 16 * 18 + 16 * 10 + 12 * 4);
    EXPECT_EQ(evaluationBytes({.hasWideIndices = true}), 32u + 8 + 16 * 20 + 16 * 12 + 12 * 4);
    EXPECT_EQ(evaluationBytes({.format = MapFormat::bc4}) - evaluationBytes({}), 12u * 4); // a block a texel
}

TEST(Traffic, ofASurfaceHasItsDicedMeshTwice) {
    const Traffic drawn = surfaceTraffic({.residentBytes = 1000, .calls = 10});
    EXPECT_EQ(drawn.least, 1000u);
    EXPECT_EQ(drawn.cacheless, 10 * evaluationBytes({}));
    const Traffic diced = surfaceTraffic({.residentBytes = 1000, .calls = 10, .diced = {10, 12}});
    EXPECT_EQ(diced.least, 1000u + 2 * (10 * 32 + 12 * 12));
    EXPECT_EQ(diced.cacheless, 10 * evaluationBytes({}) + 2 * (10 * 32 + 12 * 12));
}

// --- maps of other sizes

/// What lookups find at a grid of points, less what they find in the other map: root of the mean square.
double lookupError(const HeightMap& a, const HeightMap& b) {
    double sum = 0;
    constexpr int kSide = 97;
    for (int i = 0; i < kSide * kSide; ++i) {
        const dvec2 st = (dvec2(i % kSide, i / kSide) + 0.5) / double(kSide);
        sum += std::pow(sampleHeight(a, st).h - sampleHeight(b, st).h, 2.0);
    }
    return std::sqrt(sum / (kSide * kSide));
}

HeightMap periodic(int width, int height, Wrap wrap) {
    std::vector<float> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            texels.push_back(
                float(std::sin(6.2831853 * 3 * (x + 0.5) / width) * std::cos(6.2831853 * (y + 0.5) / height)));
    return makeHeightMap(width, height, texels, 0.2, 1.5, wrap);
}

// Where each texel of a map becomes three a side that interpolate it, nothing is lost on the way back.
TEST(Resampling, findsTheTexelsThatAFinerMapWasMadeOf) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
        const HeightMap coarse = periodic(12, 9, wrap);
        HeightMap fine = coarse;
        fine.width = 36, fine.height = 27, fine.texels.clear();
        for (int i = 0; i < 36 * 27; ++i) {
            const dvec2 st((i % 36 + 0.5) / 36, 1 - (i / 36 + 0.5) / 27);
            fine.texels.push_back(float(sampleHeight(coarse, st).h / 1.5 + 0.2));
        }
        const HeightMap back = resampled(fine, 12, 9);
        for (std::size_t i = 0; i < back.texels.size(); ++i) EXPECT_NEAR(back.texels[i], coarse.texels[i], 1e-5) << i;
    }
}

TEST(Resampling, comesNearerThanMeansDo) {
    const HeightMap map = periodic(96, 96, Wrap::repeat);
    const HeightMap fitted = resampled(map, 24, 24);
    std::vector<float> means(24 * 24, 0);
    for (int i = 0; i < 96 * 96; ++i)
        means[std::size_t(i / 96 / 4 * 24 + i % 96 / 4)] += map.texels[std::size_t(i)] / 16;
    const HeightMap averaged = makeHeightMap(24, 24, means, 0.2, 1.5, Wrap::repeat);
    EXPECT_LT(lookupError(fitted, map), 0.5 * lookupError(averaged, map));
    EXPECT_EQ(resampled(map, 96, 96).texels, map.texels);
    EXPECT_EQ(resampled(map, 1, 1).texels.size(), 1u);
}

// --- meshes

/// A wavy sheet of 2 n^2 triangles.
DenseMesh sheet(std::uint32_t n) {
    DenseMesh mesh;
    for (std::uint32_t y = 0; y <= n; ++y)
        for (std::uint32_t x = 0; x <= n; ++x) {
            const vec2 st(float(x) / float(n), float(y) / float(n));
            mesh.positions.emplace_back(3 * st.x, 0.1 * std::sin(6 * st.x), 2 * st.y);
            mesh.normals.push_back(glm::normalize(vec3(-0.2 * std::cos(6 * st.x), 1, 0)));
            mesh.texCoords.push_back(st);
        }
    for (std::uint32_t y = 0; y < n; ++y)
        for (std::uint32_t x = 0; x < n; ++x) {
            const std::uint32_t a = y * (n + 1) + x;
            mesh.indices.insert(mesh.indices.end(), {a, a + n + 1, a + n + 2, a, a + n + 2, a + 1});
        }
    return mesh;
}

double hausdorff(const DenseMesh& a, const DenseMesh& b) {
    return measureDistance(MeasuredSurface({a.positions, a.indices}, 5000),
                           MeasuredSurface({b.positions, b.indices}, 5000))
        .hausdorff();
}

TEST(Opponents, quantisedMeshesAreOffByHalfAStep) {
    const DenseMesh mesh = sheet(20);
    const EncodedMesh encoded = quantised(mesh);
    EXPECT_EQ(encoded.residentBytes, 441u * 12 + 800 * 12);
    EXPECT_GT(encoded.diskBytes, 441u);
    EXPECT_LT(encoded.diskBytes, encoded.residentBytes);
    EXPECT_EQ(encoded.decoded.indices.size(), mesh.indices.size());
    EXPECT_LE(hausdorff(mesh, encoded.decoded), std::sqrt(0.25 * (9 + 4 + 0.04)) / 65535 * 1.01);
    for (std::size_t i = 0; i < encoded.decoded.positions.size();
         ++i) { // vertices have moved: compare with the formula
        const double x = encoded.decoded.positions[i].x / 3;
        const vec3 n = glm::normalize(vec3(-0.2 * std::cos(6 * x), 1, 0));
        EXPECT_GT(glm::dot(n, encoded.decoded.normals[i]), std::cos(0.015)); // 8 bits: within a degree
    }
}

TEST(Opponents, simplifiedMeshesHaveFewerTrianglesOnTheSameSurface) {
    const DenseMesh mesh = sheet(40), simple = simplified(mesh, 800);
    EXPECT_LE(simple.indices.size() / 3, 800u);
    EXPECT_GT(simple.indices.size() / 3, 500u);
    EXPECT_EQ(simple.normals.size(), simple.positions.size());
    EXPECT_EQ(simple.texCoords.size(), simple.positions.size());
    EXPECT_LT(simple.positions.size(), mesh.positions.size());
    EXPECT_LT(hausdorff(mesh, simple), 0.003);
}

TEST(Opponents, dracoMeshesAreAsNearAsTheirBits) {
    const DenseMesh mesh = sheet(30);
    const EncodedMesh coarse = dracoEncoded(mesh, 8), fine = dracoEncoded(mesh, 14);
    EXPECT_LT(fine.diskBytes, 961u * 32 / 3);
    EXPECT_EQ(fine.decoded.indices.size(), mesh.indices.size());
    EXPECT_EQ(fine.decoded.normals.size(), fine.decoded.positions.size());
    const double step = 3.0 / 16383; // of the longest side
    EXPECT_LE(hausdorff(mesh, fine.decoded), 0.5 * std::sqrt(3.0) * step * 1.01);
    EXPECT_GT(hausdorff(mesh, coarse.decoded), step);
}

} // namespace
} // namespace relief::test
