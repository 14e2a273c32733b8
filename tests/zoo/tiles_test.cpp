// Sets of tiles and maps per face: watertight to the bit on every path, over cages whose islands cross tiles.
#include <cstdlib>

#include "check/check.h"
#include "loads.h"
#include "triangles/stages.h"

namespace relief::test {
namespace {

class ZooTiles : public OnDevice {};

/// Few cages, and the first of the paths: for drivers that compile slowly, and for sanitizers.
bool isQuickRun() { return std::getenv("RELIEF_ZOO_QUICK") != nullptr; }

std::vector<Path> visitedPaths() {
    std::vector<Path> paths = capturedPaths();
    if (isQuickRun()) paths = {Path::dice};
    return paths;
}

/// Islands of a cage spread over the unit squares around the origin: most cross a border, some lie where no tile is.
Cage overTiles(Cage cage) {
    if (!cage.hasTexCoords()) cage = withIslands(std::move(cage));
    cage = withScatteredIslands(std::move(cage));
    for (vec2& st : cage.texCoords) st = 1.7f * st + vec2(0.4f, 0.7f);
    return cage;
}

/// Noise in tiles of different sizes; one of the squares in the middle is missing.
HeightMap noiseTiles(std::uint32_t seed = 5) {
    std::mt19937 random(seed);
    const auto noise = [&](int, int) { return double(random() % 2001) / 1000 - 1; };
    std::vector<HeightMap> maps;
    std::vector<ivec2> places;
    constexpr ivec2 kSizes[] = {{16, 16}, {64, 32}, {5, 7}, {33, 16}};
    for (int t = -1; t < 4; ++t)
        for (int s = -1; s < 4; ++s) {
            if (s == 1 && t == 0) continue;
            const ivec2 size = kSizes[std::size_t(s + 3 * t + 8) % 4];
            maps.push_back(mapOf(size.x, size.y, Wrap::clamp, noise));
            places.emplace_back(s, t);
        }
    return makeTileSet(maps, places);
}

/// Noise in tiles of all sizes up to 16 segments each way.
HeightMap noiseFaces(const Surface& surface) {
    std::mt19937 random(7);
    std::vector<ivec2> segments;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) segments.emplace_back(random() % 5, random() % 5);
    return makeFaceMap(surface, segments,
                       [&](int, const dvec2&) { return 0.15 * (double(random() % 2001) / 1000 - 1); });
}

/// Vectors in the same tiles.
HeightMap noiseVectorTiles(VectorSpace space) {
    std::array<HeightMap, 3> components;
    for (std::size_t k = 0; k < 3; ++k) {
        components[k] = noiseTiles(std::uint32_t(5 + k));
        scaleHeights(components[k], 0.6);
    }
    return joinComponents(components, space, MapFormat::real);
}

/// Heights of a set, waves that repeat under a mask, and vectors: added.
HeightMap threeLayers() {
    std::vector<MapLayer> layers(3);
    layers[0] = {.name = "tiles", .map = noiseTiles(9), .placement = {}, .maskName = {}, .mask = {}};
    layers[1] = {.name = "waves",
                 .map = sineMap(16, 0.1),
                 .placement = {.repeat = dvec2(2, 3), .offset = dvec2(0.25, 0)},
                 .maskName = "mask",
                 .mask = mapOf(8, 8, Wrap::repeat, [](int x, int y) { return (x + y) % 5 / 4.0; })};
    layers[2] = {
        .name = "vectors", .map = zooVectors(VectorSpace::tangent, 16), .placement = {}, .maskName = {}, .mask = {}};
    return addLayers(layers, Wrap::repeat, MapFormat::real).decoded;
}

void expectTight(const SurfaceModel& model, std::uint32_t& turn, const std::string& words) {
    const std::vector<Path> paths = visitedPaths();
    for (const RateKind kind : {RateKind::uniform2, RateKind::random, RateKind::levels}) {
        const EdgeRates rates = zooRates(model, kind, ++turn);
        for (const Path path : paths) {
            if (path != paths[turn % paths.size()]) continue;
            const Watertightness w =
                checkWatertight(capturer().capture(model, {.path = path}, rates), boundarySegments(model, rates));
            EXPECT_GT(w.triangles, 0u);
            EXPECT_TRUE(w.isWatertight()) << fmt::format("{}, {}, {}: {} open edges, {} ulp", words, nameOf(kind),
                                                         kPathNames[int(path)], w.openEdges, w.largestGapUlps);
        }
    }
}

/// Three of the pens: the others are more of the same. In a quick run one cage of regular patches alone: SwiftShader
/// takes minutes to compile all others.
std::vector<Pen> visitedPens() {
    if (isQuickRun()) return {{Scheme::catmark, {{"torus", withScatteredIslands(torusWithSeams(6, 4))}}}};
    std::vector<Pen> pens = zooPens();
    std::erase_if(pens, [](const Pen& pen) { return pen.scheme == Scheme::loop || pen.isSmall(); });
    pens.resize(std::min<std::size_t>(pens.size(), 3));
    return pens;
}

// Poses and kinds of maps take turns over the pens.
TEST_F(ZooTiles, areWatertight) {
    std::uint32_t turn = 0, penCount = 0;
    for (const Pen& pen : visitedPens()) {
        const Cage cage = pen.joined(), tiled = overTiles(cage);
        const std::string& name = pen.cages.front().name;
        const std::vector<vec3> positions = pen.posedTogether(kPoses[(penCount + 1) % 3]);
        const auto expect = [&](const Surface& surface, const HeightMap& map, const std::string& kind) {
            const SurfaceModel model(device(), {.surface = &surface, .cagePositions = positions, .height = &map});
            expectTight(model, turn, kind + ", " + name);
        };
        const Surface surface = buildSurface(cage, {.scheme = pen.scheme, .isolation = 2});
        expect(surface, noiseFaces(surface), "per face");
        const Surface tiledSurface = buildSurface(tiled, {.scheme = pen.scheme, .isolation = 2});
        expect(tiledSurface, noiseTiles(), "tiles");
        const VectorSpace space = penCount % 2 == 0 ? VectorSpace::tangent : VectorSpace::object;
        expect(tiledSurface, noiseVectorTiles(space), "tiles of vectors");
        expect(tiledSurface, threeLayers(), "three layers");
        ++penCount;
    }
}

std::vector<SampleQuery> gridQueries(const Surface& surface, int side) {
    std::vector<SampleQuery> queries;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face)
        for (int j = 0; j <= side && surface.faces[face].root != kNoPatch; ++j)
            for (int i = 0; i <= side; ++i) queries.push_back({face, vec2(i, j) / float(side)});
    return queries;
}

/// Largest difference between the device's heights and slopes and those of the reference.
struct MapErrors {
    double height = 0, slope = 0;
};
MapErrors errorsOf(const Cage& cage, const Surface& surface, const HeightMap& device_, const HeightMap& expected) {
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions, .height = &device_});
    const ReferenceSurface reference(cage, {.isolation = 2});
    const std::vector<SampleQuery> queries = gridQueries(surface, 13); // off the nodes, and off the borders of texels
    const std::vector<SampleResult> results = sampler().sample(model, queries);
    MapErrors errors;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const dvec2 uv(queries[i].uv);
        const int face = int(queries[i].face);
        const HeightSample sample =
            sampleHeight(expected, {.face = face, .uv = uv, .st = reference.texture(face, uv).st});
        errors.height = std::max(errors.height, std::abs(sample.h - double(results[i].h)));
        errors.slope = std::max(errors.slope, glm::length(dvec2(sample.hs, sample.ht) - dvec2(results[i].gradient)));
    }
    return errors;
}

/// Smooth heights, different in each tile, without a step at borders.
HeightMap smoothTiles(bool isSwapped) {
    std::vector<HeightMap> maps;
    std::vector<ivec2> places;
    for (int t = -1; t < 4; ++t)
        for (int s = -1; s < 4; ++s) {
            const ivec2 at = isSwapped && t == 0 && s < 2 && s >= 0 ? ivec2(1 - s, 0) : ivec2(s, t);
            maps.push_back(mapOf(32, 32, Wrap::clamp, [&](int x, int y) {
                return std::sin(0.9 * (at.x + (x + 0.5) / 32)) * std::cos(1.3 * (at.y + 1 - (y + 0.5) / 32));
            }));
            places.emplace_back(s, t);
        }
    return makeTileSet(maps, places);
}

// Each component is looked up in its own words, in tiles of different sizes, and is 0 where there is no tile.
TEST_F(ZooTiles, ofVectorsAreThoseOfTheReference) {
    Cage cage = overTiles(cubeOfIslands());
    for (vec2& st : cage.texCoords) st += vec2(1, -0.5f);
    const Surface surface = buildSurface(cage, {.isolation = 2});
    const HeightMap map = noiseVectorTiles(VectorSpace::object);
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map});
    const ReferenceSurface reference(cage, {.isolation = 2});
    const std::vector<SampleQuery> queries = gridQueries(surface, 13);
    const std::vector<SampleResult> results = sampler().sample(model, queries);
    std::size_t still = 0;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const dvec2 st = reference.texture(int(queries[i].face), dvec2(queries[i].uv)).st;
        const dvec3 expected = sampleVectors(*map.vectors, st).c;
        EXPECT_LT(glm::length(expected - dvec3(results[i].c)), 1e-4) << st.x << ", " << st.y;
        still += expected == dvec3(0) ? 1 : 0;
    }
    EXPECT_GT(still, 10u);
}

TEST_F(ZooTiles, areThoseOfTheReferenceAndNoOthers) {
    const Cage cage = overTiles(cubeOfIslands());
    const Surface surface = buildSurface(cage, {.isolation = 2});
    const HeightMap right = smoothTiles(false), swapped = smoothTiles(true);
    const MapErrors errors = errorsOf(cage, surface, right, right);
    EXPECT_LT(errors.height, 1e-5);
    EXPECT_LT(errors.slope, 1e-3);
    EXPECT_GT(errorsOf(cage, surface, swapped, right).height, 0.01) << "two tiles in each other's place";

    std::mt19937 random(3);
    std::vector<ivec2> segments;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) segments.emplace_back(random() % 5, random() % 5);
    const HeightMap faces =
        makeFaceMap(surface, segments, [&](int, const dvec2&) { return double(random() % 2001) / 1e4; });
    const MapErrors ofFaces = errorsOf(cage, surface, faces, faces);
    EXPECT_LT(ofFaces.height, 1e-6);
    EXPECT_LT(ofFaces.slope, 1e-4);
    for (const MapFormat format : {MapFormat::half, MapFormat::unorm16, MapFormat::unorm8, MapFormat::bc4}) {
        if (isQuickRun() && format != MapFormat::bc4) continue;
        const EncodedMap encoded = encode(faces, format);
        const SurfaceModel model(device(), {.surface = &surface,
                                            .cagePositions = cage.positions,
                                            .height = &encoded.decoded,
                                            .encoding = &encoded.encoding});
        const std::vector<SampleQuery> queries = gridQueries(surface, 5);
        const std::vector<SampleResult> results = sampler().sample(model, queries);
        for (std::size_t i = 0; i < queries.size(); ++i) {
            const MapPlace place{.face = int(queries[i].face), .uv = dvec2(queries[i].uv)};
            EXPECT_NEAR(double(results[i].h), sampleHeight(encoded.decoded, place).h, 1e-5);
        }
    }
}

// With a rate that divides the segments each vertex is a node, which is read by other code: the same points come out.
TEST_F(ZooTiles, ofFacesAreTheSameOnTheirNodes) {
    const Cage cage = cube();
    const Surface surface = buildSurface(cage, {.isolation = 2});
    std::mt19937 random(3);
    const HeightMap map = makeFaceMap(surface, std::vector<ivec2>(surface.faces.size(), ivec2(4, 3)),
                                      [&](int, const dvec2&) { return double(random() % 2001) / 1e4; });
    const SurfaceModel model(device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map});
    const EdgeRates rates{uniformRates(model, 8), Spacing::equal, {}};
    EXPECT_TRUE(readsNodes(model, rates));
    EXPECT_FALSE(readsNodes(model, {uniformRates(model, 7), Spacing::equal, {}}));
    EXPECT_FALSE(readsNodes(model, {uniformRates(model, 16), Spacing::equal, {}}));
    const std::vector<SampleResult> results = sampler().sample(model, gridQueries(surface, 8));
    for (const Path path : visitedPaths()) {
        const CapturedMesh mesh = capturer().capture(model, {.path = path}, rates);
        for (const SampleResult& result : results) {
            float nearest = 1e9f;
            for (const vec3& p : mesh.positions) nearest = std::min(nearest, glm::length(p - result.q));
            EXPECT_LT(nearest, 1e-5f) << kPathNames[int(path)];
        }
    }
}

} // namespace
} // namespace relief::test
