// The model of bytes on cases computed by hand; resampled maps; encoded and simplified meshes.
#include <cmath>

#include "distance/distance.h"
#include "measure/measure.h"
#include "support.h"

namespace relief::test {
namespace {

TEST(Bytes, ofDenseMeshesAreThoseOfVerticesAndIndices) {
    EXPECT_EQ(denseBytes(100, 180), 100u * 32 + 180 * 12);
    EXPECT_EQ(denseBytes(100, 180, kQuantisedLayout), 100u * 12 + 180 * 12);
}

TEST(Bytes, ofPosesAreThoseOfMovedPointsAndNormals) {
    EXPECT_EQ(computePosedCageBytes(1452), 17'424u);
    EXPECT_EQ(computePosedDenseBytes(kRawLayout, 523'452), 24u * 523'452);
    EXPECT_EQ(computePosedDenseBytes(kQuantisedLayout, 523'452), 8u * 523'452);
}

TEST(Traffic, ofADenseMeshCountsVerticesOncePerMeshOrOncePerInvocation) {
    const Traffic traffic = computeDenseTraffic(kRawLayout, {100, 180}, 250);
    EXPECT_EQ(traffic.cached, 5360u);
    EXPECT_EQ(traffic.uncached, 250u * 32 + 180 * 12);
}

TEST(Traffic, ofAnEvaluationCountsRecordsControlPointsAndTexels) {
    // 16 bytes each for the root of the face and the patch, 2 words of the tree, 16 control points of 16 bytes with an
    // index of 2 bytes each, 12 texels.
    EXPECT_EQ(computeEvaluationBytes({.hasTexCoords = false}), 32u + 8 + 16 * 18 + 12 * 4);
    EXPECT_EQ(computeEvaluationBytes({.format = MapFormat::half}), 32u + 8 + 16 * 18 + 16 * 10 + 12 * 4);
    EXPECT_EQ(computeEvaluationBytes({.hasWideIndices = true}), 32u + 8 + 16 * 20 + 16 * 12 + 12 * 4);
    EXPECT_EQ(computeEvaluationBytes({.format = MapFormat::bc4}) - computeEvaluationBytes({}),
              12u * 4); // 8-byte blocks
}

TEST(Traffic, ofASurfaceCountsItsDicedMeshTwice) {
    const Traffic drawn = computeSurfaceTraffic({.residentBytes = 1000, .evaluationCount = 10});
    EXPECT_EQ(drawn.cached, 1000u);
    EXPECT_EQ(drawn.uncached, 10 * computeEvaluationBytes({}));
    const Traffic diced = computeSurfaceTraffic({.residentBytes = 1000, .evaluationCount = 10, .diced = {10, 12}});
    EXPECT_EQ(diced.cached, 1000u + 2 * (10 * 32 + 12 * 12));
    EXPECT_EQ(diced.uncached, 10 * computeEvaluationBytes({}) + 2 * (10 * 32 + 12 * 12));
}

// --- maps of other sizes

/// RMS difference of the lookups in two maps at a grid of points.
double computeLookupError(const HeightMap& a, const HeightMap& b) {
    double sum = 0;
    constexpr int kSide = 97;
    for (int i = 0; i < kSide * kSide; ++i) {
        const dvec2 st = (dvec2(i % kSide, i / kSide) + 0.5) / double(kSide);
        sum += std::pow(sampleHeight(a, st).h - sampleHeight(b, st).h, 2.0);
    }
    return std::sqrt(sum / (kSide * kSide));
}

HeightMap makePeriodicMap(int width, int height, Wrap wrap) {
    std::vector<float> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            texels.push_back(
                float(std::sin(6.2831853 * 3 * (x + 0.5) / width) * std::cos(6.2831853 * (y + 0.5) / height)));
    return makeHeightMap(width, height, texels, 0.2, 1.5, wrap);
}

// A finer map of three texels per texel and side that interpolate a coarse one has lost nothing of it.
TEST(Resampling, recoversTheCoarseMapThatAFinerOneInterpolates) {
    for (const Wrap wrap : {Wrap::repeat, Wrap::clamp}) {
        const HeightMap coarse = makePeriodicMap(12, 9, wrap);
        HeightMap fine = coarse;
        fine.width = 36, fine.height = 27, fine.texels.clear();
        for (int i = 0; i < 36 * 27; ++i) {
            const dvec2 st((i % 36 + 0.5) / 36, 1 - (i / 36 + 0.5) / 27);
            fine.texels.push_back(float(sampleHeight(coarse, st).h / 1.5 + 0.2));
        }
        const HeightMap back = resampleMap(fine, 12, 9);
        for (std::size_t i = 0; i < back.texels.size(); ++i) EXPECT_NEAR(back.texels[i], coarse.texels[i], 1e-5) << i;
    }
}

TEST(Resampling, hasASmallerErrorThanMeansOfTexels) {
    const HeightMap map = makePeriodicMap(96, 96, Wrap::repeat);
    const HeightMap fitted = resampleMap(map, 24, 24);
    std::vector<float> means(24 * 24, 0);
    for (int i = 0; i < 96 * 96; ++i)
        means[std::size_t(i / 96 / 4 * 24 + i % 96 / 4)] += map.texels[std::size_t(i)] / 16;
    const HeightMap averaged = makeHeightMap(24, 24, means, 0.2, 1.5, Wrap::repeat);
    EXPECT_LT(computeLookupError(fitted, map), 0.5 * computeLookupError(averaged, map));
    EXPECT_EQ(resampleMap(map, 96, 96).texels, map.texels);
    EXPECT_EQ(resampleMap(map, 1, 1).texels.size(), 1u);
}

// --- meshes

/// A wavy sheet of 2 n^2 triangles.
DenseMesh makeSheet(std::uint32_t n) {
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

double computeHausdorff(const DenseMesh& a, const DenseMesh& b) {
    return measureDistance(MeasuredSurface({a.positions, a.indices}, 5000),
                           MeasuredSurface({b.positions, b.indices}, 5000))
        .hausdorff();
}

TEST(Encoding, byQuantisationIsOffByHalfAStepAtMost) {
    const DenseMesh mesh = makeSheet(20);
    const EncodedMesh encoded = quantiseMesh(mesh);
    EXPECT_EQ(encoded.residentBytes, 441u * 12 + 800 * 12);
    EXPECT_GT(encoded.diskBytes, 441u);
    EXPECT_LT(encoded.diskBytes, encoded.residentBytes);
    EXPECT_EQ(encoded.decoded.indices.size(), mesh.indices.size());
    EXPECT_LE(computeHausdorff(mesh, encoded.decoded), std::sqrt(0.25 * (9 + 4 + 0.04)) / 65535 * 1.01);
    for (std::size_t i = 0; i < encoded.decoded.positions.size();
         ++i) { // vertices are in another order: normals are compared with the formula
        const double x = encoded.decoded.positions[i].x / 3;
        const vec3 n = glm::normalize(vec3(-0.2 * std::cos(6 * x), 1, 0));
        EXPECT_GT(glm::dot(n, encoded.decoded.normals[i]), std::cos(0.015)); // 8 bits: within a degree
    }
}

TEST(Simplification, leavesFewerTrianglesNearTheSameSurface) {
    const DenseMesh mesh = makeSheet(40), simple = simplifyMesh(mesh, 800);
    EXPECT_LE(simple.indices.size() / 3, 800u);
    EXPECT_GT(simple.indices.size() / 3, 500u);
    EXPECT_EQ(simple.normals.size(), simple.positions.size());
    EXPECT_EQ(simple.texCoords.size(), simple.positions.size());
    EXPECT_LT(simple.positions.size(), mesh.positions.size());
    EXPECT_LT(computeHausdorff(mesh, simple), 0.003);
}

TEST(Encoding, byDracoIsOffByAStepOfItsBitsAtMost) {
    const DenseMesh mesh = makeSheet(30);
    const EncodedMesh coarse = encodeWithDraco(mesh, 8), fine = encodeWithDraco(mesh, 14);
    EXPECT_LT(fine.diskBytes, 961u * 32 / 3);
    EXPECT_EQ(fine.decoded.indices.size(), mesh.indices.size());
    EXPECT_EQ(fine.decoded.normals.size(), fine.decoded.positions.size());
    const double step = 3.0 / 16383; // of the longest side
    EXPECT_LE(computeHausdorff(mesh, fine.decoded), 0.5 * std::sqrt(3.0) * step * 1.01);
    EXPECT_GT(computeHausdorff(mesh, coarse.decoded), step);
}

} // namespace
} // namespace relief::test
