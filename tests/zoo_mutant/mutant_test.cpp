// The test of the zoo: with shaders that evaluate one edge of sixteen at whatever face is drawn, all that the zoo
// promises is broken, on every path.
#include "check/check.h"
#include "zoo/pictures.h"

namespace relief::test {
namespace {

class Mutant : public OnDevice {};

/// Smooth, without the symmetry that makes both sides of a regular seam agree to the bit after all.
const HeightMap& smoothMap() {
    static const HeightMap map =
        mapOf(64, 64, Wrap::repeat, [](int x, int y) { return std::sin(0.13 * x + 0.4) * std::cos(0.11 * y); });
    return map;
}

/// The torus agrees with itself across its seams but for rounding, the islands not at all. Both have mutant edges among
/// their seams: dicing evaluates other smooth edges once, whatever the shaders do.
std::vector<NamedCage> seamedCages() {
    return {{"torusWithSeams", torusWithSeams()}, {"cubeOfIslands", cubeOfIslands()}};
}

TEST_F(Mutant, isNotWatertight) {
    for (const NamedCage& one : seamedCages()) {
        const Surface surface = buildSurface(one.cage, {.isolation = 2});
        const std::vector<vec3> positions = posed(one.cage, Pose::twist);
        const SurfaceModel model(device(), {.surface = &surface, .cagePositions = positions, .height = &smoothMap()});
        for (const RateKind kind : {RateKind::uniform7, RateKind::random, RateKind::fractional})
            for (const Path path : capturedPaths()) {
                const EdgeRates rates = zooRates(model, kind, 1);
                const CapturedMesh mesh = capturer().capture(model, {.path = path}, rates);
                const Watertightness w = checkWatertight(mesh, boundarySegments(model, rates));
                EXPECT_GT(w.openEdges, 0u) << one.name << ", " << nameOf(kind) << ", " << kPathNames[int(path)];
                EXPECT_GT(w.largestGapUlps, 0) << one.name << ", " << nameOf(kind) << ", " << kPathNames[int(path)];
            }
    }
}

TEST_F(Mutant, showsItsCracks) {
    for (const NamedCage& one : seamedCages()) {
        const Surface surface = buildSurface(one.cage, {.isolation = 2});
        const std::vector<vec3> positions = posed(one.cage, Pose::twist);
        const SurfaceModel model(device(), {.surface = &surface, .cagePositions = positions, .height = &smoothMap()});
        for (const Path path : drawnPaths()) {
            std::uint64_t pixels = 0;
            for (const CameraOptions& view : kCrackViews) {
                RenderOptions options = pictureOptions(positions, view);
                options.path = path;
                options.rate = 9;
                pixels += crackRenderer().crackPixels(model, options, crackShift(2.0 / 9));
            }
            EXPECT_GT(pixels, 0u) << one.name << ", " << kPathNames[int(path)];
        }
    }
}

} // namespace
} // namespace relief::test
