// Sets of tiles over unit squares and maps per face: names of files, lookups across borders, what the device holds.
#include <random>

#include "displacement/displacement.h"
#include "maps.h"
#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

HeightMap tileOf(int width, int height, const std::function<double(double, double)>& value) {
    std::vector<float> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) texels.push_back(float(value((x + 0.5) / width, 1 - (y + 0.5) / height)));
    return makeHeightMap(width, height, std::move(texels), 0, 2, Wrap::clamp);
}

double hills(double s, double t) { return std::sin(2.1 * s + 0.3) * std::cos(1.7 * t) + 0.1 * std::sin(9 * s + 5 * t); }

/// Three of four squares of `hills`; the one at (1,1) is missing.
HeightMap hillTiles(const ivec2& size, const ivec2& second) {
    std::vector<HeightMap> maps;
    std::vector<ivec2> places;
    for (const ivec2& place : {ivec2(1, 0), ivec2(0, 0), ivec2(0, 1)}) {
        const ivec2 texels = place == ivec2(1, 0) ? second : size;
        maps.push_back(tileOf(texels.x, texels.y, [&](double s, double t) { return hills(place.x + s, place.y + t); }));
        places.push_back(place);
    }
    return makeTileSet(maps, places);
}

// --- names -------------------------------------------------------------------------------------------------------

std::vector<ivec2> placesOf(const std::string& path) {
    std::vector<ivec2> places;
    for (const TileFile& file : listTiles(path)) places.push_back(file.place);
    return places;
}

TEST(TileNames, areNumberedInFourWays) {
    const TemporaryFolder folder;
    for (const char* name : {"a.1001.exr", "a.1012.exr", "a.1002.exr", "a.x.exr", "b.u0_v0.exr", "b.u10_v2.exr",
                             "c.u1_v1.exr", "c.u2_v1.exr"})
        putFile(folder / name, "");
    const std::vector<ivec2> udim{{0, 0}, {1, 0}, {1, 1}}, zero{{0, 0}, {10, 2}}, one{{0, 0}, {1, 0}};
    EXPECT_EQ(placesOf(folder / "a.<UDIM>.exr"), udim);
    EXPECT_EQ(placesOf(folder / "a.%(UDIM)d.exr"), udim);
    EXPECT_EQ(placesOf(folder / "b.<uvtile>.exr"), zero);
    EXPECT_EQ(placesOf(folder / "c.<UVTILE>.exr"), one);
    EXPECT_FALSE(findTilePattern(folder / "a.1001.exr").has_value());
}

TEST(TileNames, thatAreWrongAreRefused) {
    const TemporaryFolder folder;
    for (const char* name : {"low.1000.exr", "two.1001.exr", "two.01001.exr", "zero.u0_v1.exr", "own.<UDIM>.exr"})
        putFile(folder / name, "");
    expectFailure(Failure::input, {"low.1000.exr", "1001"}, [&] { listTiles(folder / "low.<UDIM>.exr"); });
    expectFailure(Failure::input, {"two.01001.exr", "two.1001.exr", "both"},
                  [&] { listTiles(folder / "two.<UDIM>.exr"); });
    expectFailure(Failure::input, {"u0_v1", "from 1"}, [&] { listTiles(folder / "zero.<UVTILE>.exr"); });
    expectFailure(Failure::input, {"own.<UDIM>.exr", "another name"}, [&] { listTiles(folder / "own.<UDIM>.exr"); });
    expectFailure(Failure::file, {"none.<UDIM>.exr", "none.1001.exr"}, [&] { listTiles(folder / "none.<UDIM>.exr"); });
    expectFailure(Failure::usage, {"one number"}, [&] { findTilePattern("a.<UDIM>.<uvtile>.exr"); });
}

// --- files -------------------------------------------------------------------------------------------------------

TEST(TileFiles, ofDifferentTypesAreOneMap) {
    const TemporaryFolder folder;
    writeImage(folder / "m.1001.exr", {2, 2, 1, {0.25f, 0.25f, 0.25f, 0.25f}}, SampleType::real);
    writeImage(folder / "m.1002.exr", {4, 2, 1, std::vector<float>(8, 0.75f)}, SampleType::half);
    Warnings warnings;
    const EncodedMap map = loadHeightMap(folder / "m.<UDIM>.exr", {.scale = 2, .limits = {}}, warnings.warn());
    EXPECT_TRUE(warnings.lines.empty());
    EXPECT_EQ(map.decoded.tiles.size(), 2u);
    EXPECT_DOUBLE_EQ(sampleHeight(map.decoded, dvec2(0.5, 0.5)).h, 0.5);
    EXPECT_DOUBLE_EQ(sampleHeight(map.decoded, dvec2(1.5, 0.5)).h, 1.5);
    EXPECT_DOUBLE_EQ(sampleHeight(map.decoded, dvec2(2.5, 0.5)).h, 0);
}

TEST(TileFiles, thatAreWrongAreRefused) {
    const TemporaryFolder folder;
    const auto write = [&](const char* name, int channels, float value) {
        writeImage(folder / name, {2, 1, channels, std::vector<float>(std::size_t(2 * channels), value)},
                   SampleType::real);
    };
    write("mixed.1001.exr", 1, 0), write("mixed.1002.exr", 4, 0);
    write("nan.1001.exr", 1, 0), write("nan.1011.exr", 1, NAN);
    const auto load = [&](const char* name) { (void)loadHeightMap(folder / name, {.limits = {}}); };
    expectFailure(Failure::input, {"mixed.1002.exr", "4 channels"}, [&] { load("mixed.<UDIM>.exr"); });
    expectFailure(Failure::input, {"nan.1011.exr", "nan"}, [&] { load("nan.<UDIM>.exr"); });
}

// Vectors in tiles of different sizes and types: each component is the set of one channel, and missing tiles are 0.
TEST(TileFiles, ofThreeChannelsAreVectors) {
    const TemporaryFolder folder;
    const auto write = [&](const char* name, const ivec2& size, const vec3& c, SampleType type) {
        Image image{.width = size.x, .height = size.y, .channels = 3, .texels = {}};
        for (int i = 0; i < size.x * size.y; ++i) image.texels.insert(image.texels.end(), {c.x, c.y, c.z});
        writeImage(folder / name, image, type);
    };
    write("v.1001.exr", {4, 4}, {0.25f, 0.5f, 1}, SampleType::real);
    write("v.1002.exr", {2, 8}, {-1, 0, 0.5f}, SampleType::half);
    const VectorOptions options{.order = "xzy", .flip = "y", .scale = 2, .limits = {}};
    Warnings warnings;
    const HeightMap map = loadVectorMap(folder / "v.<UDIM>.exr", options, warnings.warn());
    EXPECT_TRUE(warnings.lines.empty());
    ASSERT_TRUE(map.vectors && map.addressing == Addressing::tiles);
    EXPECT_EQ(sampleVectors(*map.vectors, dvec2(0.5, 0.5)).c, dvec3(0.5, -2, 1));
    EXPECT_EQ(sampleVectors(*map.vectors, dvec2(1.5, 0.5)).c, dvec3(-2, -1, 0));
    EXPECT_EQ(sampleVectors(*map.vectors, dvec2(2.5, 0.5)).c, dvec3(0));
    EXPECT_NEAR(map.heightBound(), 2 * std::sqrt(0.25 * 0.25 + 0.5 * 0.5 + 1), 1e-6);
    // In one line: a tile of two channels, and one with a number that is none.
    writeImage(folder / "two.1001.exr", {1, 1, 2, {0, 0}}, SampleType::real);
    write("nan.1001.exr", {1, 1}, vec3(0), SampleType::real);
    write("nan.1011.exr", {1, 1}, vec3(0, NAN, 0), SampleType::real);
    const auto load = [&](const char* name) { (void)loadVectorMap(folder / name, options, warnings.warn()); };
    expectFailure(Failure::input, {"two.1001.exr", "3 channels"}, [&] { load("two.<UDIM>.exr"); });
    expectFailure(Failure::input, {"nan.1011.exr", "nan"}, [&] { load("nan.<UDIM>.exr"); });
}

TEST(FaceFiles, keepAllHeights) {
    const TemporaryFolder folder;
    const Cage cage = torusWithSeams(6, 4);
    const Surface surface = buildSurface(cage, {.isolation = 1});
    std::mt19937 random(1);
    std::vector<ivec2> segments;
    for (std::size_t f = 0; f < surface.faces.size(); ++f) segments.emplace_back(random() % 6, random() % 6);
    HeightMap map = makeFaceMap(surface, segments, [&](int, const dvec2&) { return double(random() % 100); });
    map.topology = hashTopology(cage);
    saveFaceMap(folder / "f.exr", map);
    EncodedMap read = loadHeightMap(folder / "f.exr", {.limits = {}});
    EXPECT_EQ(read.decoded.topology, map.topology);
    fitToFaces(read.decoded, surface);
    EXPECT_EQ(read.decoded.texels, map.texels);
    EXPECT_NE(hashTopology(torusWithSeams(4, 6)), map.topology);
}

TEST(FaceFiles, thatAreWrongAreRefused) {
    const TemporaryFolder folder;
    // Two faces of 2 x 2 nodes, which a picture of 3 x 4 holds one above the other.
    const auto refuse = [&](int height, int channels, const char* faces, float value, std::vector<std::string> words) {
        words.emplace_back("f.exr");
        writeImage(folder / "f.exr",
                   {3, height, channels, std::vector<float>(std::size_t(3 * height * channels), value)},
                   SampleType::real, ImageAttributes{{"relief:faces", faces}, {"relief:topology", "0123"}});
        expectFailure(Failure::input, words, [&] { (void)loadHeightMap(folder / "f.exr", {.limits = {}}); });
    };
    refuse(4, 2, "0000", 0, {"one channel", "2"});
    refuse(5, 1, "0000", 0, {"3 x 5", "resized"});
    refuse(4, 1, "000", 0, {"header"});
    refuse(4, 1, "00x0", 0, {"header"});
    refuse(4, 1, "0000", NAN, {"column 0, row 0", "nan"});
}

// --- lookups -----------------------------------------------------------------------------------------------------

TEST(Tiles, areContinuousAcrossBordersOfTilesOfOneSize) {
    const HeightMap set = hillTiles({32, 16}, {32, 16});
    for (const double x : {0.1, 0.37, 0.5, 0.9})
        for (const dvec2& along : {dvec2(1, x), dvec2(x, 1)}) {
            const dvec2 across = along.x == 1 ? dvec2(1e-9, 0) : dvec2(0, 1e-9);
            const HeightSample a = sampleHeight(set, along - across), b = sampleHeight(set, along + across);
            EXPECT_NEAR(a.h, b.h, 1e-6);
            EXPECT_NEAR(a.hs, b.hs, 1e-5);
            EXPECT_NEAR(a.ht, b.ht, 1e-5);
            EXPECT_NEAR(a.h, 2 * hills(along.x, along.y), 0.02);
        }
}

TEST(Tiles, ofOtherSizesMeetNearly) {
    const HeightMap set = hillTiles({64, 64}, {16, 32});
    for (const double t : {0.2, 0.5, 0.81})
        EXPECT_NEAR(sampleHeight(set, dvec2(1 - 1e-9, t)).h, sampleHeight(set, dvec2(1 + 1e-9, t)).h, 0.1);
}

TEST(Tiles, thatAreMissingDisplaceNothingAndEndAtTheirBorder) {
    const HeightMap set = hillTiles({16, 16}, {16, 16});
    EXPECT_EQ(sampleHeight(set, dvec2(1.5, 1.5)).h, 0);
    EXPECT_EQ(sampleHeight(set, dvec2(-0.5, 0.5)).h, 0);
    // On the outer border of a tile, and there within rounding.
    for (const double s : {2.0, 2.0 + 1e-7})
        EXPECT_NEAR(sampleHeight(set, dvec2(s, 0.5)).h, sampleHeight(set, dvec2(2 - 1e-7, 0.5)).h, 1e-5);
    EXPECT_NEAR(sampleHeight(set, dvec2(2, 1)).h, sampleHeight(set, dvec2(2 - 1e-7, 1 - 1e-7)).h, 1e-5);
}

TEST(FaceMaps, haveTheSlopesOfATextureAcrossEdges) {
    const Cage cage = torusWithSeams(6, 4);
    const Surface surface = buildSurface(cage, {.isolation = 1});
    const ReferenceSurface reference(cage, {.isolation = 1});
    // Any function that goes on across edges: of positions in space.
    const auto height = [&](int face, const dvec2& uv) {
        const dvec3 p = reference.limit(face, uv).p;
        return std::sin(1.3 * p.x) * std::cos(1.1 * p.z) + 0.2 * p.y;
    };
    const int n = 8;
    const HeightMap map = makeFaceMap(surface, std::vector<ivec2>(surface.faces.size(), ivec2(3, 3)), height);
    // Along a side the central difference reaches into the next face: nodes at equal steps of the parameter, over both.
    int count = 0;
    for (std::uint32_t f = 0; f < surface.faces.size(); ++f)
        for (int k = 1; k < n; ++k) {
            const dvec2 uv(1, double(k) / n);
            const HeightSample sample = sampleHeight(map, {.face = int(f), .uv = uv});
            const double h = height(int(f), uv);
            EXPECT_NEAR(sample.h, h, 1e-5);
            // Across side 1: this face's last node but one, and the neighbour's first but one.
            const FaceLink& link = map.links->links[8 * f + 2];
            ASSERT_TRUE(link.continues);
            const double x = double(link.start) + (uv.y - double(link.ownStart)) * double(link.end - link.start) /
                                                      double(link.ownEnd - link.ownStart);
            const dvec2 beyond = link.side == 3   ? dvec2(1.0 / n, 1 - x)
                                 : link.side == 1 ? dvec2(1 - 1.0 / n, x)
                                 : link.side == 0 ? dvec2(x, 1.0 / n)
                                                  : dvec2(1 - x, 1 - 1.0 / n);
            const double expected = (height(int(link.face), beyond) - height(int(f), dvec2(1 - 1.0 / n, uv.y))) * n / 2;
            EXPECT_NEAR(sample.hs, expected, 1e-5) << "face " << f << " at " << k;
            ++count;
        }
    EXPECT_EQ(count, 24 * 7);
}

// --- on the device -----------------------------------------------------------------------------------------------

/// What a reader of the words finds around a tile: the reader's own arithmetic.
TEST(TileWords, holdEveryTileWithItsApron) {
    const HeightMap set = hillTiles({8, 4}, {8, 4});
    const MapWords words = toWords(set);
    EXPECT_EQ(words.words.size() * 4, mapBytes(MapFormat::real, set));
    // Entries: a grid of 4 x 4 squares around the 2 x 2.
    const auto entry = [&](int column, int row) { return &words.words[std::size_t(2 * (4 * row + column))]; };
    EXPECT_EQ(entry(2, 2)[0], kNoTile);
    EXPECT_EQ(entry(2, 2)[1], 1u << 1 | 1u << 3 | 1u << 0); // below, to the left, and between them
    const std::uint32_t* first = entry(1, 1);
    EXPECT_EQ(first[1], 8u | 4u << 16);
    const auto texel = [&](std::uint32_t word, int width, int x, int y) {
        return std::bit_cast<float>(
            words.words[word + std::uint32_t((y + kTileApron) * (width + 2 * kTileApron) + x + kTileApron)]);
    };
    const std::uint32_t right = entry(2, 1)[0];
    for (int y = 0; y < 4; ++y)
        for (int x = 0; x < 2; ++x) EXPECT_EQ(texel(first[0], 8, 8 + x, y), texel(right, 8, x, y));
    // Level 1 begins where the word before level 0 says, and holds means of four.
    const std::uint32_t level = words.words[first[0] - 1];
    EXPECT_NEAR(
        texel(level, 4, 0, 0),
        (texel(first[0], 8, 0, 0) + texel(first[0], 8, 1, 0) + texel(first[0], 8, 0, 1) + texel(first[0], 8, 1, 1)) / 4,
        1e-6);
}

} // namespace
} // namespace relief::test
