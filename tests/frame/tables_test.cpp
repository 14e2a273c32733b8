// Devices that read little from a texel buffer read storage buffers instead: the same bits.
#include <cstring>

#include "device.h"
#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

class StorageTables : public OnDevice {};

/// The least that Vulkan promises.
Device& smallDevice() {
    static Device instance({.maxTexelBufferElements = 65536});
    return instance;
}

/// A cage and a map of more words than the small device reads from a texel buffer.
struct Load {
    Cage cage = torusWithSeams();
    HeightMap map = sineMap(512, 0.1, 5);
    Surface surface = buildSurface(cage, {.isolation = 3});

    [[nodiscard]] SurfaceModel on(Device& device) const {
        return SurfaceModel(device, {.surface = &surface, .cagePositions = cage.positions, .height = &map});
    }
};

TEST_F(StorageTables, areReadWhereTexelBuffersAreSmall) {
    EXPECT_EQ(device().traits().readsTablesAs, TableAccess::texelBuffers);
    EXPECT_EQ(smallDevice().traits().readsTablesAs, TableAccess::storageBuffers);
}

TEST_F(StorageTables, giveTheSameFramesAndTriangles) {
    const Load load;
    const SurfaceModel large = load.on(device()), small = load.on(smallDevice());
    std::vector<SampleQuery> queries;
    for (std::uint32_t face = 0; face < load.surface.faces.size(); ++face)
        queries.push_back({face, vec2(float(face % 7) / 6, float(face % 5) / 4)});
    const std::vector<SampleResult> a = sampler().sample(large, queries),
                                    b = SurfaceSampler(smallDevice()).sample(small, queries);
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(SampleResult)), 0);

    const TriangleOptions options{.path = Path::dice, .edgePixels = 3};
    const View view{.eye = {0, 1, 4}, .nearDistance = 0.1f, .pixelsAtUnitDistance = 400};
    const EdgeRates rates = EdgeRater(device()).rates(large, options, view);
    EXPECT_EQ(EdgeRater(smallDevice()).rates(small, options, view).rates, rates.rates);
    const DenseMesh one = Dicer(device()).diceToHost(large, rates),
                    other = Dicer(smallDevice()).diceToHost(small, rates);
    EXPECT_GT(one.positions.size(), 65536u / 2) << "more vertices than the small device could read";
    EXPECT_EQ(one.positions, other.positions);
    EXPECT_EQ(one.normals, other.normals);
    EXPECT_EQ(one.indices, other.indices);
}

TEST_F(StorageTables, drawTheSamePicture) {
    const Load load;
    RenderOptions options{{.path = Path::dice, .rate = 12}};
    std::vector<dvec3> points(load.cage.positions.begin(), load.cage.positions.end());
    for (const dvec3& p : points) options.bounds.add(p);
    options.camera = frameCamera(points, {}, 1);
    const RendererDesc desc{.width = 128, .height = 128, .shadowSide = 256};
    EXPECT_EQ(Renderer(device(), desc).render(load.on(device()), options).halves,
              Renderer(smallDevice(), desc).render(load.on(smallDevice()), options).halves);
    EXPECT_TRUE(smallDevice().validationMessages().empty());
}

// Mesa's CPU driver alone.
TEST_F(StorageTables, areNotReadByVertexStagesThatGoWrong) {
    if (smallDevice().traits().evaluatesInVertexStages) GTEST_SKIP() << "this driver reads them rightly";
    const Load load;
    const SurfaceModel model = load.on(smallDevice());
    for (const Path path : {Path::tessellation, Path::grid})
        expectFailure(Failure::usage, {"storage buffers", "--path dice"},
                      [&] { EdgeRater(smallDevice()).rates(model, {.path = path, .rate = 4}, {}); });
}

} // namespace
} // namespace relief::test
