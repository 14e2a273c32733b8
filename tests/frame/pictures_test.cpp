// Whole pictures: the paths against each other and against a dense mesh of the reference; plans of draws.
#include <algorithm>

#include "device.h"
#include "meshes.h"

namespace relief::test {
namespace {

class Pictures : public OnDevice {};

Renderer& renderer() {
    static Renderer instance(device(), {.width = 192, .height = 192, .shadowSide = 512});
    return instance;
}

RenderOptions optionsFor(const Cage& cage, Show show) {
    RenderOptions options;
    std::vector<dvec3> points(cage.positions.begin(), cage.positions.end());
    for (const dvec3& p : points) options.bounds.add(p);
    options.camera = frameCamera(points, {}, 1);
    options.show = show;
    options.rate = 12;
    return options;
}

/// Root mean square of the difference of two pictures' channels, and of their coverage alone.
struct Difference {
    double color = 0, coverage = 0;
};

Difference difference(const Picture& a, const Picture& b) {
    Difference sum;
    const std::vector<float> left = a.image().texels, right = b.image().texels;
    for (std::size_t i = 0; i < left.size(); ++i) {
        const double d = double(left[i]) - double(right[i]);
        EXPECT_TRUE(std::isfinite(d));
        (i % 4 == 3 ? sum.coverage : sum.color) += d * d;
    }
    const double pixels = double(left.size()) / 4;
    return {std::sqrt(sum.color / (3 * pixels)), std::sqrt(sum.coverage / pixels)};
}

// The paths sample the surface at the same locations and join them by other diagonals: at this rate that is a few
// thousandths of a normal, and a sliver of a pixel along the outline.
TEST_F(Pictures, ofTessellationAndGridAgree) {
    if (!device().traits().hasTessellation) GTEST_SKIP() << "no tessellation shaders";
    const HeightMap map = sineMap(64, 0.1, 1);
    for (const NamedCage& named : allCages()) {
        if (named.name == "moebiusStrip") continue; // one-sided: which side a shared vertex faces depends on the draw
        const Surface surface = buildSurface(named.cage, {.isolation = 3});
        const SurfaceModel model(device(),
                                 {.surface = &surface, .cagePositions = named.cage.positions, .height = &map});
        RenderOptions options = optionsFor(named.cage, Show::normal);
        options.rate = 32;
        const Picture patches = renderer().render(model, options);
        options.path = Path::grid;
        const Picture grids = renderer().render(model, options);
        const Difference d = difference(patches, grids);
        EXPECT_LT(d.color, 0.02) << named.name;
        EXPECT_LT(d.coverage, 0.02) << named.name;
    }
}

TEST_F(Pictures, ofLoopSurfacesAgreeBetweenPaths) {
    if (!device().traits().hasTessellation) GTEST_SKIP() << "no tessellation shaders";
    const Cage cage = icosahedron();
    const Surface surface = buildSurface(cage, {.scheme = Scheme::loop, .isolation = 3});
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
    RenderOptions options = optionsFor(cage, Show::shaded);
    const Picture patches = renderer().render(model, options);
    options.path = Path::grid;
    const Difference d = difference(patches, renderer().render(model, options));
    EXPECT_LT(d.color, 0.015);
    EXPECT_LT(d.coverage, 0.015);
}

TEST_F(Pictures, ofTheGridEqualADenseMeshOfTheReference) {
    const Cage cage = torusWithSeams();
    const HeightMap map = sineMap(128, 0.1);
    const Surface surface = buildSurface(cage, {.isolation = 3});
    const SurfaceModel displaced(device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map});
    const DenseMesh mesh = denseMesh(ReferenceSurface(cage, {.isolation = 3}), &map, 12);
    const MeshModel dense(device(), {.mesh = &mesh});
    for (const Show show : {Show::normal, Show::shaded}) {
        RenderOptions options = optionsFor(cage, show);
        options.path = Path::grid;
        options.filtersHeights = false;
        const Difference d = difference(renderer().render(displaced, options), renderer().render(dense, options));
        EXPECT_LT(d.color, 0.002);
        EXPECT_LT(d.coverage, 0.002);
    }
}

/// Pixels that are not wholly covered and not connected to the border through others like them: background seen
/// through.
int holesIn(const Image& image) {
    std::vector<char> isOpen(std::size_t(image.width) * std::size_t(image.height));
    const auto index = [&](int x, int y) { return std::size_t(y) * std::size_t(image.width) + std::size_t(x); };
    std::vector<ivec2> front;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            isOpen[index(x, y)] = image.at(x, y)[3] < 1;
            if (x == 0 || y == 0 || x + 1 == image.width || y + 1 == image.height) front.emplace_back(x, y);
        }
    while (!front.empty()) {
        const ivec2 at = front.back();
        front.pop_back();
        if (at.x < 0 || at.y < 0 || at.x >= image.width || at.y >= image.height || isOpen[index(at.x, at.y)] == 0)
            continue;
        isOpen[index(at.x, at.y)] = 0;
        for (int k = 0; k < 9; ++k) front.emplace_back(at.x + k % 3 - 1, at.y + k / 3 - 1);
    }
    return int(std::ranges::count(isOpen, 1));
}

// Every edge of this cage is a seam whose islands disagree about the height, and rates differ from edge to edge.
TEST_F(Pictures, haveNoHolesInsideAClosedSurface) {
    const Cage cage = cubeOfIslands();
    const HeightMap map = sineMap(32, 0.2, 3);
    const Surface surface = buildSurface(cage, {});
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map});
    for (const Path path : {Path::tessellation, Path::grid})
        for (const double azimuth : {30.0, 150.0, 270.0}) {
            RenderOptions options = optionsFor(cage, Show::normal);
            const std::vector<dvec3> points(cage.positions.begin(), cage.positions.end());
            options.camera = frameCamera(points, {.azimuth = azimuth, .elevation = azimuth / 5 - 30}, 1);
            options.rate.reset();
            options.edgePixels = 3;
            options.path = path;
            EXPECT_EQ(holesIn(renderer().render(model, options).image()), 0) << azimuth;
        }
}

TEST_F(Pictures, takeOneRatePerEdgeFromItsLengthOnScreen) {
    const Cage cage = mixedFaces();
    const Surface surface = buildSurface(cage, {});
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
    RenderOptions options = optionsFor(cage, Show::rate);
    options.rate.reset();
    std::uint64_t last = 0;
    for (const double pixels : {32.0, 8.0, 2.0}) {
        options.edgePixels = pixels;
        const FrameStats stats = renderer().render(model, options).stats;
        EXPECT_GT(stats.triangleCount, 3 * last) << pixels;
        last = stats.triangleCount;
    }
}

TEST(Plans, countTheTessellatorsTriangles) {
    using Rates = std::vector<std::uint32_t>;
    EXPECT_EQ(tessellatedTriangles(Rates{1, 1, 1, 1}), 2u);
    EXPECT_EQ(tessellatedTriangles(Rates{7, 7, 7, 7}), 98u);
    EXPECT_EQ(tessellatedTriangles(Rates{2, 2, 2, 2}), 8u);
    EXPECT_EQ(tessellatedTriangles(Rates{1, 1, 1}), 1u);
    EXPECT_EQ(tessellatedTriangles(Rates{2, 2, 2}), 6u);
    EXPECT_EQ(tessellatedTriangles(Rates{3, 3, 3}), 13u);
}

TEST_F(Pictures, areDrawnInBatchesThatSuitTheDevice) {
    const Cage cage = torusWithSeams();
    const Surface surface = buildSurface(cage, {.isolation = 2});
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
    const DrawPlan plan = planPatches(model, {uniformRates(model, 9)}, 1000); // 100 vertices per face
    EXPECT_EQ(plan.faces.size(), 48u);
    EXPECT_EQ(plan.batches.size(), 5u);
    EXPECT_EQ(plan.triangleCount, 48u * 2 * 81);
    EXPECT_EQ(plan.vertexCount, 48u * 81); // a closed torus: as many vertices as quads
}

TEST_F(Pictures, areTheSameBitsInHoweverManyPartsTheyAreDrawn) {
    const Cage cage = creasedCube();
    const Surface surface = buildSurface(cage, {.isolation = 3});
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
    for (const Path path : {Path::dice, Path::grid})
        for (const Show show : {Show::shaded, Show::faces, Show::wireframe, Show::texCoords}) {
            RenderOptions options = optionsFor(cage, show);
            options.path = path;
            options.rate = 5;
            const Picture whole = renderer().render(model, options);
            for (const std::uint32_t most : {77u, 120u, 3u}) { // faces have 50 triangles here
                options.meshTrianglesInFlight = most;
                EXPECT_EQ(renderer().render(model, options).halves, whole.halves) << int(path) << ' ' << int(show);
            }
        }
}

/// What the middle of the picture shows of a face that is looked at straight: red, green and blue in codes of 8 bits.
std::vector<float> codesOfFrontFace(const SurfaceModel& model, RenderOptions options) {
    options.camera = {.eye = {0, 0, 1000}, .fieldOfView = 0.1, .nearDistance = 900, .farDistance = 1100};
    const Image image = renderer().render(model, options).image();
    const float* middle = image.at(image.width / 2, image.height / 2);
    EXPECT_EQ(middle[3], 1);
    return {255 * middle[0], 255 * middle[1], 255 * middle[2]};
}

// Between codes, a color of a whole face would lie where devices could round it to either side. Ten bits and a half
// float move it by at most 0.19 codes.
TEST_F(Pictures, showColorsThatAreWholeCodes) {
    Cage cage = hardCube();
    for (const Show show : {Show::faces, Show::rate, Show::height})
        for (std::uint32_t i = 1; i <= 5; ++i) {
            std::rotate(cage.corners.begin(), cage.corners.begin() + 4, cage.corners.end()); // another face in front
            const Surface surface = buildSurface(cage, {.isolation = 2});
            const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
            RenderOptions options = optionsFor(cage, show);
            options.path = Path::grid;
            options.rate = show == Show::rate ? 12 * i : 1;
            for (const float code : codesOfFrontFace(model, options))
                EXPECT_NEAR(code, std::round(code), 0.2f) << int(show) << ' ' << i;
        }
}

TEST_F(Pictures, refuseRatesPastTheTessellator) {
    const Cage cage = cube();
    const Surface surface = buildSurface(cage, {.isolation = 2});
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions});
    RenderOptions options = optionsFor(cage, Show::shaded);
    options.rate = 65;
    EXPECT_THROW(renderer().render(model, options), Error);
    options.path = Path::grid;
    EXPECT_NO_THROW(renderer().render(model, options));
}

} // namespace
} // namespace relief::test
