// Layers of a diced picture are those of its own triangles.
#include <glm/gtc/matrix_transform.hpp>

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

/// Those that the device has.
std::vector<Raster> rasters() {
    std::vector<Raster> all{Raster::hardware};
    if (device().traits().hasLongAtomics) all.push_back(Raster::compute);
    return all;
}

// The same triangles once more as a mesh: equal to the bit, which other triangles through the same samples are not.
TEST_F(DicedLayers, haveTheDepthsAndNormalsOfTheTriangles) {
    Renderer renderer(device(), {.width = kLayerSide, .height = kLayerSide, .shadowSide = 1});
    EdgeRater rater(device());
    Dicer dicer(device());
    const HeightMap map = sineMap(64, 0.2);
    for (const LayeredCage& one : layeredCages()) {
        const Surface surface = buildSurface(one.cage, {.scheme = one.scheme, .isolation = 3});
        const SurfaceModel model(device(), {.surface = &surface, .cagePositions = one.cage.positions, .height = &map});
        RenderOptions options = layerOptions(one.cage, one.spacing);
        const EdgeRates rates = rater.rates(model, options, viewOf(options.camera, kLayerSide));
        const DenseMesh triangles = dicer.diceToHost(model, rates, {.wantsTexCoords = true});
        const MeshModel mesh(device(), {.mesh = &triangles});
        for (const Raster raster : rasters()) {
            options.raster = raster;
            const Picture diced = renderer.render(model, options), same = renderer.render(mesh, options);
            ASSERT_EQ(diced.stats.triangleCount, same.stats.triangleCount) << one.name;
            std::size_t seen = 0, others = 0;
            for (std::size_t first = 0; first < diced.layerValues.size(); first += kLayerChannels) {
                seen += diced.layerValues[first + kLayerFace] >= 0 ? 1 : 0;
                for (const std::uint32_t channel : {kLayerDepth, kLayerNormal, kLayerNormal + 1, kLayerNormal + 2,
                                                    kLayerTexCoords, kLayerTexCoords + 1})
                    others += diced.layerValues[first + channel] != same.layerValues[first + channel] ? 1 : 0;
            }
            EXPECT_GT(seen, 2000u) << one.name;
            EXPECT_EQ(others, 0u) << one.name;
        }
    }
}

/// How many pixels of two pictures differ in their layers: what they see, and what that is by more than rounding.
struct LayerDifferences {
    std::size_t seen = 0, seenByOne = 0, others = 0;
};

LayerDifferences compareLayers(const Picture& a, const Picture& b) {
    LayerDifferences d;
    for (std::size_t first = 0; first < a.layerValues.size(); first += kLayerChannels) {
        const std::span x(&a.layerValues[first], kLayerChannels), y(&b.layerValues[first], kLayerChannels);
        d.seenByOne += (x[kLayerFace] >= 0) != (y[kLayerFace] >= 0);
        if (x[kLayerFace] < 0 || y[kLayerFace] < 0) continue;
        ++d.seen;
        bool differ = x[kLayerFace] != y[kLayerFace];
        for (std::uint32_t channel = 0; channel < kLayerChannels; ++channel) {
            const bool isPixels = channel >= kLayerMotion && channel < kLayerMotion + 2;
            const double most = isPixels ? 0.01 : channel == kLayerDepth ? 1e-3 : 2e-4;
            differ = differ || std::abs(x[channel] - y[channel]) > most;
        }
        d.others += differ;
    }
    return d;
}

// One sample per pixel, at its centre. Triangles seen edge-on are what interpolation may differ in, and pixels where
// two instances meet.
TEST_F(DicedLayers, areThoseOfTheFixedFunctionByTheComputeRasterizer) {
    if (!device().traits().hasLongAtomics) GTEST_SKIP() << "no 64-bit atomics";
    Renderer renderer(device(), {.width = kLayerSide, .height = kLayerSide, .shadowSide = 1});
    const HeightMap map = sineMap(64, 0.2);
    const auto expectAlike = [&](std::span<const Instance> instances, RenderOptions options, const char* name) {
        options.cameraBefore = options.camera;
        options.cameraBefore->eye += dvec3(0.1, 0.05, 0);
        options.raster = Raster::hardware;
        const Picture drawn = renderer.render(instances, options);
        options.raster = Raster::compute;
        const Picture computed = renderer.render(instances, options);
        ASSERT_EQ(computed.stats.raster, Raster::compute);
        const LayerDifferences d = compareLayers(drawn, computed);
        EXPECT_GT(d.seen, 2000u) << name;
        EXPECT_EQ(d.seenByOne, 0u) << name;
        EXPECT_LT(d.others, d.seen / 100) << name;
    };
    for (const LayeredCage& one : layeredCages()) {
        const RenderOptions options = layerOptions(one.cage, one.spacing);
        const Surface surface = buildSurface(one.cage, {.scheme = one.scheme, .isolation = 3});
        const SurfaceModel model(device(), {.surface = &surface, .cagePositions = one.cage.positions, .height = &map});
        const Instance several[] = {{model}, {model, {}, glm::translate(mat4(1), vec3(0.3f, 0.2f, -0.4f))}};
        expectAlike(std::span(several).first(1), options, one.name);
        expectAlike(several, options, one.name);

        // Without texture coordinates, (u,v) of faces stand for them.
        Cage plain = one.cage;
        plain.texCoords.clear(), plain.texCorners.clear();
        const Surface faces = buildSurface(plain, {.scheme = one.scheme, .isolation = 3});
        const SurfaceModel ofFaces(device(), {.surface = &faces, .cagePositions = plain.positions});
        const Instance alone(ofFaces);
        expectAlike(std::span(&alone, 1), options, one.name);
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
