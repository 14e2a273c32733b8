// Normals that a height function bends, against closed forms and against a map of the same formula.
#include "seen.h"

namespace relief::test {
namespace {

class FunctionNormals : public OnDevice {};

// As sineMap(256, 0.03, 6).
TEST_F(FunctionNormals, areThoseOfAMapOfTheSameFormula) {
    const HeightMap map = sineMap(256, 0.03, 6);
    const FunctionHeights heights =
        heightsByFunction("0.03 * sin(37.69911184 * st.x) * cos(37.69911184 * st.y)", ByFunction::bends);
    Islands& cube = cubeWithIslands();
    const SurfaceModel model(device(),
                             {.surface = &cube.surface, .cagePositions = cube.cage.positions, .function = &heights});
    for (const Path path : kDetailPaths) {
        RenderOptions options = bilinear();
        options.path = path;
        options.rate = 32;
        const std::vector<double> angles = anglesTo(look(model, options, {2, 3, 4}, 0.8), &map, NormalKind::firstOrder);
        EXPECT_GT(angles.size(), 3000u) << int(path);
        EXPECT_LT(rms(angles), 0.2) << int(path);
    }
}

/// Angles to the normals of h = 0.06 sin(15 x) cos(9 y) over the point (x, y) that a pixel sees; (u,v) of the square
/// are its texture coordinates.
std::vector<double> anglesToWaves(const std::vector<Seen>& pixels) {
    std::vector<double> angles;
    for (const Seen& seen : pixels) {
        const double x = 15 * (2 * seen.st.x - 1), y = 9 * (2 * seen.st.y - 1);
        const dvec2 slopes = 0.06 * dvec2(15 * std::cos(x) * std::cos(y), -9 * std::sin(x) * std::sin(y));
        angles.push_back(degreesBetween(seen.normal, {-slopes.x, -slopes.y, 1}));
    }
    return angles;
}
const char* const kWaves = "0.06 * sin(15.0 * p.x) * cos(9.0 * p.y)";

// Steep waves, up to 42 degrees: whatever the triangles are, each pixel has the normal of the function there. With
// displacement alone it has that of the triangles.
TEST_F(FunctionNormals, areThoseOfTheFunctionAtEveryRate) {
    const Cage plane = squareCage(true);
    const Surface surface = buildSurface(plane, {.scheme = Scheme::bilinear});
    for (const ByFunction how : {ByFunction::bends, ByFunction::both, ByFunction::moves}) {
        const FunctionHeights heights = heightsByFunction(kWaves, how);
        const SurfaceModel model(device(),
                                 {.surface = &surface, .cagePositions = plane.positions, .function = &heights});
        for (const Way& way : detailWays())
            for (const int rate : {64, 16, 8}) {
                RenderOptions options = bilinear();
                options.path = way.path, options.raster = way.raster;
                options.rate = rate;
                const std::vector<Seen> pixels = look(model, options, {0, 0, 4}, 0.9);
                const std::vector<double> angles = anglesToWaves(pixels);
                EXPECT_GT(angles.size(), 10000u);
                const double highest =
                    std::ranges::max(pixels, {}, [](const Seen& seen) { return std::abs(seen.height); }).height;
                EXPECT_EQ(highest != 0, how != ByFunction::bends);
                if (how != ByFunction::moves) {
                    EXPECT_LT(rms(angles), 0.3) << nameOf(way) << " rate " << rate << " how " << int(how);
                } else if (rate < 64) {
                    EXPECT_GT(rms(angles), 3) << nameOf(way) << " rate " << rate;
                }
            }
    }
}

// A plain mesh is the same to a function, with texture coordinates and without.
TEST_F(FunctionNormals, areThoseOfTheFunctionOnPlainTriangles) {
    const FunctionHeights ofPoint = heightsByFunction(kWaves, ByFunction::bends);
    const FunctionHeights ofTexture =
        heightsByFunction("0.06 * sin(15.0 * (2.0 * st.x - 1.0)) * cos(9.0 * (2.0 * st.y - 1.0))", ByFunction::bends);
    DenseMesh mesh = denseMesh(squareCage(true));
    const Tangents tangents = computeTangents(mesh);
    for (const FunctionHeights* heights : {&ofPoint, &ofTexture}) {
        const MeshModel model(device(), {.mesh = &mesh, .function = heights, .tangents = &tangents});
        for (const Way& way : detailWays()) {
            RenderOptions options = bilinear();
            options.raster = way.raster;
            const std::vector<double> angles = anglesToWaves(look(model, options, {0, 0, 4}, 0.9));
            EXPECT_GT(angles.size(), 10000u);
            EXPECT_LT(rms(angles), 0.2) << nameOf(way);
        }
    }
    mesh.texCoords.clear();
    const MeshModel model(device(), {.mesh = &mesh, .function = &ofTexture});
    for (const Seen& seen : look(model, bilinear(), {0, 0, 4}, 0.9))
        ASSERT_LT(degreesBetween(seen.normal, {0, 0, 1}), 0.1) << "st is (0,0)";
}

// Without texture coordinates st is (0,0) on every path, where the function moves the surface and where it bends
// normals.
TEST_F(FunctionNormals, areGivenNoTextureCoordinatesWhereThereAreNone) {
    const Cage plane = squareCage(false);
    const Surface surface = buildSurface(plane, {.scheme = Scheme::bilinear});
    for (const ByFunction how : {ByFunction::bends, ByFunction::both, ByFunction::moves}) {
        const FunctionHeights heights = heightsByFunction("0.1 * sin(20.0 * st.x + 0.5)", how);
        const SurfaceModel model(device(),
                                 {.surface = &surface, .cagePositions = plane.positions, .function = &heights});
        for (const Path path : kDetailPaths) {
            RenderOptions options = bilinear();
            options.path = path;
            options.rate = 16;
            for (const Seen& seen : look(model, options, {0, 0, 4}, 0.9)) {
                ASSERT_LT(degreesBetween(seen.normal, {0, 0, 1}), 0.1) << int(path) << " how " << int(how);
                ASSERT_NEAR(seen.height, how == ByFunction::bends ? 0 : 0.1 * std::sin(0.5), 1e-6);
            }
        }
    }
}

} // namespace
} // namespace relief::test
