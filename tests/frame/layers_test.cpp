// Layers of a diced picture are those of its own triangles.
#include "device.h"
#include "meshes.h"

namespace relief::test {
namespace {

class DicedLayers : public OnDevice {};

struct LayeredCage {
    const char* name;
    Cage cage;
    Spacing spacing = Spacing::equal;
    Scheme scheme = Scheme::catmark;
};

/// Seams, sides of two edges, triangles, and a boundary.
std::vector<LayeredCage> layeredCages() {
    return {{"torus", torusWithSeams()},
            {"prism", withIslands(nGonPrism(5)), Spacing::fractional},
            {"mixed", withIslands(mixedFaces())},
            {"loop", withIslands(icosahedron()), Spacing::equal, Scheme::loop},
            {"grid", withIslands(hillyGrid()), Spacing::fractional}};
}

RenderOptions layerOptions(const Cage& cage, Spacing spacing) {
    RenderOptions options = optionsFor(cage, {.azimuth = 31, .elevation = 23});
    options.path = Path::dice;
    options.edgePixels = 17;
    options.spacing = spacing;
    options.layers = {Layer::depth};
    return options;
}

constexpr int kLayerSide = 128;

// The same triangles once more as a mesh: equal to the bit, which other triangles through the same samples are not.
TEST_F(DicedLayers, haveTheDepthsAndNormalsOfTheTriangles) {
    Renderer renderer(device(), {.width = kLayerSide, .height = kLayerSide, .shadowSide = 1});
    EdgeRater rater(device());
    Dicer dicer(device());
    const HeightMap map = sineMap(64, 0.2);
    for (const LayeredCage& one : layeredCages()) {
        const Surface surface = buildSurface(one.cage, {.scheme = one.scheme, .isolation = 3});
        const SurfaceModel model(device(), {.surface = &surface, .cagePositions = one.cage.positions, .height = &map});
        const RenderOptions options = layerOptions(one.cage, one.spacing);
        const EdgeRates rates = rater.rates(model, options, viewOf(options.camera, kLayerSide));
        const DenseMesh triangles = dicer.diceToHost(model, rates, {.wantsTexCoords = true});
        const MeshModel mesh(device(), {.mesh = &triangles});
        const Picture diced = renderer.render(model, options), same = renderer.render(mesh, options);
        ASSERT_EQ(diced.stats.triangleCount, same.stats.triangleCount) << one.name;
        std::size_t seen = 0, others = 0;
        for (std::size_t first = 0; first < diced.layerValues.size(); first += kLayerChannels) {
            seen += diced.layerValues[first + kLayerFace] >= 0 ? 1 : 0;
            for (const std::uint32_t channel :
                 {kLayerDepth, kLayerNormal, kLayerNormal + 1, kLayerNormal + 2, kLayerTexCoords, kLayerTexCoords + 1})
                others += diced.layerValues[first + channel] != same.layerValues[first + channel] ? 1 : 0;
        }
        EXPECT_GT(seen, 2000u) << one.name;
        EXPECT_EQ(others, 0u) << one.name;
    }
}

// Texture coordinates for layers leave the picture as it was.
TEST_F(DicedLayers, leaveThePictureAsItIs) {
    Renderer renderer(device(), {.width = kLayerSide, .height = kLayerSide, .shadowSide = 256});
    const HeightMap map = sineMap(64, 0.2);
    const Cage cage = torusWithSeams();
    const Surface surface = buildSurface(cage, {.isolation = 3});
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map});
    RenderOptions options = layerOptions(cage, Spacing::equal);
    const Picture with = renderer.render(model, options);
    options.layers.clear();
    const Picture without = renderer.render(model, options);
    EXPECT_EQ(with.halves, without.halves);
    EXPECT_TRUE(without.layerValues.empty());
}

} // namespace
} // namespace relief::test
