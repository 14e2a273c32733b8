// Heights per face, in sets of tiles, and along lines that begin on a cage.
#include <algorithm>

#include <gtest/gtest.h>

#include "bake/sculpts.h"

namespace relief::test {
namespace {

/// A cage with everything that baking per face takes.
struct FaceBaking {
    FaceBaking(const Cage& cage, std::vector<ivec2> segments, int samplesPerSide = 1)
        : surface(buildSurface(cage, {})), reference(cage, SurfaceOptions()), directions(surface, reference),
          texels(surface, reference, {std::move(segments), samplesPerSide}) {}

    [[nodiscard]] BakedHeights bake(const TriangleMesh& sculpt) const {
        return bakeHeights(reference, measured(sculpt), texels,
                           {.lines = {.reach = {2, 2}, .directions = &directions}});
    }
    [[nodiscard]] HeightMap mapOf(const BakedHeights& baked) const {
        return makeFaceMap(surface, texels.segments(),
                           [&](int face, const dvec2& uv) { return double(baked.heights[texels.texelAt(face, uv)]); });
    }

    Surface surface;
    ReferenceSurface reference;
    DisplacementDirections directions;
    FaceTexels texels;
};

TEST(FaceHeights, lieOnABumpySphereWithoutTextureCoordinates) {
    const auto radiusAt = [](const dvec3& d) { return 1.2 + 0.05 * std::sin(7 * d.x) * std::sin(6 * d.y + 1); };
    const TriangleMesh sphere = sheetThrough(500, [&](double s, double t) {
        const double a = 2 * std::numbers::pi * s + 0.1, b = std::numbers::pi * (t - 0.5);
        const dvec3 d(std::cos(a) * std::cos(b), std::sin(b), -std::sin(a) * std::cos(b));
        // Turned, so that no line passes the seam or the poles to the bit.
        const double c = std::cos(0.3), e = std::sin(0.3);
        return radiusAt({c * d.x - e * d.y, e * d.x + c * d.y, d.z}) * dvec3(c * d.x - e * d.y, e * d.x + c * d.y, d.z);
    });
    // Faces of different sizes beside each other.
    const FaceBaking baking(cube(), {{5, 5}, {4, 5}, {5, 4}, {3, 5}, {5, 5}, {4, 4}});
    EXPECT_FALSE(baking.surface.hasTexCoords());
    const BakedHeights baked = baking.bake(sphere);
    EXPECT_EQ(baked.voidCount, 0u);
    EXPECT_EQ(baked.texelCount, 33u * 33 + 17 * 33 + 33 * 17 + 9 * 33 + 33 * 33 + 17 * 17);
    const HeightMap map = baking.mapOf(baked);
    for (int face = 0; face < 6; ++face) {
        const ivec2 count = map.tiles[std::size_t(face)].size - 1;
        for (int j = 1; j < count.y; ++j)
            for (int i = 1; i < count.x; ++i) {
                const DisplacedFrame frame = displacedFrame(baking.reference, &map, face, dvec2(i, j) / dvec2(count));
                EXPECT_NEAR(glm::length(frame.q), radiusAt(glm::normalize(frame.q)), 1e-4);
            }
    }
    const BakeCertificate certificate =
        certifyBake(baking.reference, map, measured(sphere), {.lines = {.reach = {2, 2}}, .triangleCount = 50'000});
    EXPECT_LT(certificate.distance.forth.rms, 0.002);
    EXPECT_LT(certificate.distance.back.rms, 0.002);
}

TEST(FaceHeights, fillVoidsAcrossFaces) {
    // A tilted plane without x in (0.55,2.45) and -z in (0.55,3.45): a membrane in a plane is that plane.
    const auto plane = [](double x, double z) { return 0.1 * x - 0.05 * z; };
    const TriangleMesh sheet = withHole(hillsOverGrid(80, plane), {0.55, 0.55}, {2.45, 3.45});
    const FaceBaking baking(squareGrid(), std::vector<ivec2>(16, {3, 3}));
    const BakedHeights baked = baking.bake(sheet);
    EXPECT_GT(baked.voidCount, 300u);
    const HeightMap map = baking.mapOf(baked);
    for (int face = 0; face < 16; ++face)
        for (int i = 0; i <= 8; ++i) {
            const dvec2 uv = dvec2(i, 8 - i) / 8.0;
            const dvec3 p = baking.reference.limit(face, uv).p;
            EXPECT_NEAR(sampleHeight(map, {.face = face, .uv = uv}).h, plane(p.x, -p.z), 2e-5) << face << " " << i;
        }
}

TEST(FaceHeights, areAlongSharedDirectionsOnSharpEdges) {
    // A cube within one that is larger by 0.2 on each side.
    Cage larger = hardCube();
    for (vec3& p : larger.positions) p *= 1.2f;
    TriangleMesh sculpt{.positions = larger.positions, .indices = {}};
    for (std::size_t face = 0; face < 6; ++face)
        for (const std::size_t k : {0, 1, 2, 0, 2, 3}) sculpt.indices.push_back(larger.corners[4 * face + k]);
    const FaceBaking baking(hardCube(), std::vector<ivec2>(6, {2, 2}));
    const BakedHeights baked = baking.bake(sculpt);
    for (int face = 0; face < 6; ++face)
        for (int j = 0; j <= 4; ++j)
            for (int i = 0; i <= 4; ++i) {
                const int sharedBy = (i % 4 == 0 ? 1 : 0) + (j % 4 == 0 ? 1 : 0);
                EXPECT_NEAR(baked.heights[baking.texels.texelAt(face, dvec2(i, j) / 4.0)],
                            0.2 * std::sqrt(1.0 + sharedBy), 1e-5)
                    << face << " " << i << " " << j;
            }
}

TEST(TileHeights, goOnAcrossTheBordersOfTiles) {
    Cage cage = squareGrid();
    for (vec2& st : cage.texCoords) st = 2.0f * st + vec2(1, 3);
    const auto hill = [](double x, double z) { return 0.3 * std::sin(2 * x) * std::cos(1.5 * z); };
    const MeasuredSurface sculpt = measured(hillsOverGrid(400, hill));
    const ReferenceSurface reference(cage, SurfaceOptions());
    const std::vector<ivec2> places = findTilesOfFaces(reference);
    EXPECT_EQ(places, (std::vector<ivec2>{{1, 3}, {2, 3}, {1, 4}, {2, 4}}));
    std::vector<HeightMap> maps;
    for (const ivec2& place : places) {
        const Baking baking(cage, {.width = 64, .height = 64, .wrap = Wrap::clamp, .origin = dvec2(place)});
        const BakedHeights baked = baking.bake(sculpt, {1, 1});
        EXPECT_EQ(baked.texelCount, 64u * 64);
        maps.push_back(baking.mapOf(baked));
    }
    const HeightMap set = makeTileSet(maps, places);
    for (int i = 0; i <= 100; ++i)
        for (const double s : {2 - 1e-9, 2 + 1e-9}) {
            const dvec2 st(s, 3.01 + 0.0198 * i);
            EXPECT_NEAR(sampleHeight(set, st).h, hill(2 * (s - 1), 2 * (st.y - 3)), 3e-4);
        }
}

// Islands of one face each, in four tiles: edges whose sides lie in different tiles show one height on both.
TEST(TileHeights, agreeAcrossSeamsBetweenTiles) {
    Cage cage = withIslands(torusWithSeams());
    for (vec2& st : cage.texCoords) st *= 2.0f;
    const TriangleMesh bumpy = sheetThrough(500, [](double s, double t) {
        const double a = 2 * std::numbers::pi * s, b = 2 * std::numbers::pi * t;
        const double r = 0.8 + 0.04 * std::sin(9 * a) * std::cos(5 * b);
        return dvec3((2 + r * std::cos(b)) * std::cos(a), r * std::sin(b), -(2 + r * std::cos(b)) * std::sin(a));
    });
    const MeasuredSurface sculpt = measured(bumpy);
    const Surface surface = buildSurface(cage, {});
    const ReferenceSurface reference(cage, SurfaceOptions());
    const auto largestGap = [&](double margin) {
        std::vector<HeightMap> maps;
        const std::vector<ivec2> places = findTilesOfFaces(reference);
        EXPECT_EQ(places, (std::vector<ivec2>{{0, 0}, {1, 0}, {0, 1}, {1, 1}}));
        for (const ivec2& place : places) {
            const Baking baking(
                cage, {.width = 256, .height = 256, .margin = margin, .wrap = Wrap::clamp, .origin = dvec2(place)});
            maps.push_back(baking.mapOf(baking.bake(sculpt, {1, 1})));
        }
        const HeightMap set = makeTileSet(maps, places);
        const EdgeIncidences edges = edgeIncidences(surface);
        double gap = 0;
        int between = 0;
        for (std::size_t edge = 0; edge < surface.edges.size(); ++edge)
            for (int i = 0; i <= 16; ++i) {
                dvec2 st[2];
                for (std::size_t k = 0; k < 2; ++k) {
                    const Incidence& side = edges.of(edge)[k];
                    const dvec2 uv =
                        sidePoint(4, int(side.side), std::lerp(double(side.start), double(side.end), i / 16.0));
                    st[k] = reference.texture(int(side.face), uv).st;
                }
                if (glm::floor(st[0]) == glm::floor(st[1])) continue;
                ++between;
                gap = std::max(gap, std::abs(sampleHeight(set, st[0]).h - sampleHeight(set, st[1]).h));
            }
        EXPECT_GT(between, 100);
        return gap;
    };
    EXPECT_LT(largestGap(2), 0.001);
    EXPECT_GT(largestGap(0), 0.003); // what it would be without texels beyond the borders
}

TEST(CageLines, findTheFirstSheetBelowTheCage) {
    const auto flat = [](double height) { return hillsOverGrid(8, [height](double, double) { return height; }); };
    TriangleMesh sheets = flat(0.3);
    for (const double height : {0.1, -0.05}) append(sheets, flat(height));
    const Cage grid = squareGrid();
    const Baking baking(grid, {.width = 8, .height = 8, .wrap = Wrap::clamp});
    const auto heightBelow = [&](double above) {
        const ReferenceSurface cage(inflateCage(grid, above), SurfaceOptions());
        const BakedHeights baked =
            bakeHeights(baking.reference, measured(sheets), baking.texels, {.lines = {.reach = {0, 1}, .cage = &cage}});
        EXPECT_EQ(baked.insideCount, above < 0 ? baked.sampleCount : 0u);
        const auto [low, high] = std::ranges::minmax(baked.heights);
        EXPECT_EQ(low, high);
        return double(low);
    };
    EXPECT_NEAR(baking.bake(measured(sheets), {1, 1}).heights[0], -0.05, 1e-6); // the nearest
    EXPECT_NEAR(heightBelow(0.35), 0.3, 1e-6);
    EXPECT_NEAR(heightBelow(0.15), 0.1, 1e-6);
    EXPECT_NEAR(heightBelow(0.01), -0.05, 1e-6);
    // Inside of the surface: the nearest sheet on either side.
    EXPECT_NEAR(heightBelow(-0.2), -0.05, 1e-6);
    const ReferenceSurface inside(inflateCage(grid, -0.2), SurfaceOptions());
    EXPECT_NEAR(
        bakeHeights(baking.reference, measured(flat(0.3)), baking.texels, {.lines = {.reach = {1, 1}, .cage = &inside}})
            .heights[0],
        0.3, 1e-6);
    // Normals of the inflated cage are smooth across sharp edges: corners of a cube move along its diagonals.
    const Cage box = hardCube(), inflated = inflateCage(box, 0.5);
    for (std::size_t i = 0; i < box.positions.size(); ++i)
        EXPECT_LT(glm::distance(inflated.positions[i], box.positions[i] + 0.5f * glm::normalize(box.positions[i])),
                  1e-6f);
}

} // namespace
} // namespace relief::test
