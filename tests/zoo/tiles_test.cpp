// Sets of tiles and maps per face: watertight to the bit on every path, over cages whose islands cross tiles.
#include "check/check.h"
#include "loads.h"

namespace relief::test {
namespace {

class ZooTiles : public OnDevice {};

/// Islands of a cage spread over the unit squares around the origin: most cross a border, some lie where no tile is.
Cage overTiles(Cage cage) {
    if (!cage.hasTexCoords()) cage = withIslands(std::move(cage));
    cage = withScatteredIslands(std::move(cage));
    for (vec2& st : cage.texCoords) st = 1.7f * st + vec2(0.4f, 0.7f);
    return cage;
}

/// Noise in tiles of different sizes; one of the squares in the middle is missing.
HeightMap noiseTiles() {
    std::mt19937 random(5);
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

void expectTight(const SurfaceModel& model, std::uint32_t& turn, const std::string& words) {
    const std::vector<Path> paths = capturedPaths();
    for (const RateKind kind : {RateKind::uniform2, RateKind::random, RateKind::fractional, RateKind::levels}) {
        const EdgeRates rates = zooRates(model, kind, ++turn);
        for (const Path path : paths) {
            if (path != paths[turn % paths.size()]) continue;
            const Watertightness w =
                checkWatertight(capturer().capture(model, {.path = path}, rates), boundarySegments(model, rates));
            EXPECT_GT(w.triangles, 0u);
            EXPECT_TRUE(w.isWatertight())
                << fmt::format("{}, {}, {}: {} open edges, {} ulp", words, nameOf(kind), kPathNames[int(path)],
                               w.openEdges, w.largestGapUlps);
        }
    }
}

TEST_F(ZooTiles, areWatertight) {
    std::uint32_t turn = 0;
    for (const Pen& pen : zooPens()) {
        if (pen.scheme == Scheme::loop) continue;
        const Cage cage = pen.joined(), tiled = overTiles(cage);
        const Surface surface = buildSurface(cage, {.scheme = pen.scheme, .isolation = 2});
        const HeightMap faces = noiseFaces(surface), tiles = noiseTiles();
        const std::vector<vec3> positions = pen.posedTogether(Pose::twist);
        const SurfaceModel perFace(device(), {.surface = &surface, .cagePositions = positions, .height = &faces});
        expectTight(perFace, turn, "per face, " + pen.cages.front().name);
        const Surface tiledSurface = buildSurface(tiled, {.scheme = pen.scheme, .isolation = 2});
        const SurfaceModel overSquares(device(),
                                       {.surface = &tiledSurface, .cagePositions = positions, .height = &tiles});
        expectTight(overSquares, turn, "tiles, " + pen.cages.front().name);
    }
}

} // namespace
} // namespace relief::test
