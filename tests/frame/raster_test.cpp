// The compute rasterizer against double precision, against the device's fixed function, and against itself.
#include <random>

#include "device.h"
#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

constexpr int kRasterSide = 128;
constexpr int kSubpixels = 256;

class Raster : public OnDevice {
protected:
    void SetUp() override {
        OnDevice::SetUp();
        if (!device().traits().hasLongAtomics) GTEST_SKIP() << "no 64-bit atomics";
    }
};

Renderer& rasterRenderer() {
    static Renderer instance(device(), {.width = kRasterSide, .height = kRasterSide, .shadowSide = 64});
    return instance;
}

/// A view in which float arithmetic is exact: from the origin along -z, with x / w from -1 to 1 across the picture.
RenderOptions exactView(relief::Raster raster) {
    RenderOptions options;
    options.camera = {
        .eye = {0, 0, 0}, .target = {0, 0, -1}, .fieldOfView = 90, .nearDistance = 0.5, .farDistance = 64};
    options.bounds.add(dvec3(-1, -1, -8));
    options.bounds.add(dvec3(1, 1, -1));
    options.lighting.castsShadows = false;
    options.raster = raster;
    return options;
}

/// A vertex at a place of the picture, in 1/256 of a pixel, at a distance that is a power of two.
vec3 vertexAt(const ivec2& place, float w) {
    const float unit = 2.0f / (kSubpixels * kRasterSide);
    return {w * (unit * float(place.x) - 1), w * (1 - unit * float(place.y)), -w};
}

DenseMesh meshOf(const std::vector<vec3>& positions, const std::vector<std::uint32_t>& indices,
                 const vec3& normal = {0, 0, 1}) {
    DenseMesh mesh;
    mesh.positions = positions;
    mesh.normals.assign(positions.size(), normal);
    mesh.indices = indices;
    return mesh;
}

// --- coverage ------------------------------------------------------------------------------------------------------

using Place = glm::i64vec2;

std::int64_t edgeAt(const Place& a, const Place& b, const Place& p) {
    return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

/// Adds 1 for a front face, or takes it away for a back face, at pixels whose centre a triangle covers by the top-left
/// rule.
void addTriangle(Place a, Place b, Place c, std::vector<int>& sums) {
    std::int64_t area = edgeAt(a, b, c);
    if (area == 0) return;
    const int sign = area < 0 ? 1 : -1; // counter-clockwise as seen, with y down
    if (area < 0) std::swap(b, c);
    const auto covers = [](const Place& from, const Place& to, const Place& p) {
        const std::int64_t e = edgeAt(from, to, p);
        const bool isTopOrLeft = to.y < from.y || (to.y == from.y && to.x > from.x);
        return e > 0 || (e == 0 && isTopOrLeft);
    };
    const auto pixel = [](std::int64_t x) { return int(std::clamp<std::int64_t>(x / kSubpixels, 0, kRasterSide - 1)); };
    for (int y = pixel(std::min({a.y, b.y, c.y})); y <= pixel(std::max({a.y, b.y, c.y})); ++y)
        for (int x = pixel(std::min({a.x, b.x, c.x})); x <= pixel(std::max({a.x, b.x, c.x})); ++x) {
            const Place p(kSubpixels * x + kSubpixels / 2, kSubpixels * y + kSubpixels / 2);
            if (covers(a, b, p) && covers(b, c, p) && covers(c, a, p)) sums[std::size_t(y * kRasterSide + x)] += sign;
        }
}

/// Places of random triangles: pixel-sized ones, slivers, needles, large ones, and ones with corners at centres of
/// pixels.
std::vector<ivec2> randomPlaces(int triangleCount, std::mt19937& random) {
    const auto within = [&](int low, int high) { return std::uniform_int_distribution(low, high)(random); };
    std::vector<ivec2> places;
    for (int t = 0; t < triangleCount; ++t) {
        const ivec2 middle(within(-4000, kSubpixels * kRasterSide + 4000),
                           within(-4000, kSubpixels * kRasterSide + 4000));
        const int kind = t % 8, size = kind == 0 && t % 256 == 0 ? 100000 : kind == 1 ? 5000 : 400;
        // Long and thin, in any direction; one in eight longer than 32 bits hold the products of.
        const auto needle = [&](int k) {
            const int length = t % 512 == 5 ? 60000 : 16000;
            return k == 0 ? middle : middle + ivec2(within(-length, length), within(-length, length));
        };
        for (int k = 0; k < 3; ++k) {
            ivec2 place = middle + ivec2(within(-size, size), within(-size, size));
            if (kind == 2) place.y = middle.y + place.y % 3; // a sliver
            if (kind == 5 && t % 64 == 5)
                place = k < 2 ? needle(k) : places.back() + ivec2(within(-300, 300), within(-300, 300));
            if (kind == 3) place = place / kSubpixels * kSubpixels + kSubpixels / 2;
            if (kind == 4 && k > 0) place = places.back() + ivec2(within(-1, 1), within(-1, 1));
            places.push_back(place);
        }
    }
    return places;
}

TEST_F(Raster, coversWhatATriangleCoversByTheTopLeftRule) {
#ifdef __SANITIZE_ADDRESS__
    constexpr int kTriangles = 50000;
#else
    constexpr int kTriangles = 1000000;
#endif
    std::mt19937 random(1);
    const std::vector<ivec2> places = randomPlaces(kTriangles, random);
    std::vector<vec3> positions;
    std::vector<std::uint32_t> indices;
    std::vector<int> expected(std::size_t(kRasterSide) * kRasterSide);
    for (std::size_t i = 0; i < places.size(); ++i) {
        positions.push_back(vertexAt(places[i], float(1 << random() % 4)));
        indices.push_back(std::uint32_t(i));
        if (i % 3 == 2) addTriangle(places[i - 2], places[i - 1], places[i], expected);
    }
    const DenseMesh mesh = meshOf(positions, indices);
    const MeshModel model(device(), {.mesh = &mesh});
    const std::vector<int> found = rasterRenderer().countCrossings(model, exactView(relief::Raster::compute));
    ASSERT_GT(std::ranges::count_if(expected, [](int sum) { return sum != 0; }), kRasterSide * kRasterSide / 2);
    EXPECT_EQ(found, expected);
}

/// Cuts at the near plane and projects, in double precision.
std::vector<dvec2> clippedAndProjected(const dvec3 corners[3], double nearDistance) {
    std::vector<dvec2> result;
    const auto add = [&](const dvec3& p) {
        result.push_back(double(kSubpixels * kRasterSide) * (0.5 * dvec2(p.x, -p.y) / -p.z + 0.5));
    };
    for (int i = 0; i < 3; ++i) {
        const dvec3 &from = corners[i], &to = corners[(i + 1) % 3];
        const double a = -from.z - nearDistance, b = -to.z - nearDistance;
        if (a >= 0) add(from);
        if ((a >= 0) != (b >= 0)) add(from + a / (a - b) * (to - from));
    }
    return result;
}

/// Corners that clipping makes are rounded otherwise in single precision: a pixel may differ where an edge passes its
/// centre closely.
TEST_F(Raster, clipsTrianglesThatPassTheEye) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> coordinate(-3, 3), distance(-4, 6);
    const RenderOptions options = exactView(relief::Raster::compute);
    std::vector<vec3> positions;
    std::vector<std::uint32_t> indices;
    std::vector<int> expected(std::size_t(kRasterSide) * kRasterSide);
    int cutCount = 0;
    for (int t = 0; t < 200; ++t) {
        dvec3 corners[3];
        for (dvec3& corner : corners) {
            positions.emplace_back(coordinate(random), coordinate(random), -distance(random));
            indices.push_back(std::uint32_t(indices.size()));
            corner = dvec3(positions.back());
        }
        const std::vector<dvec2> polygon = clippedAndProjected(corners, options.camera.nearDistance);
        const auto place = [&](std::size_t i) { return Place(glm::round(polygon[i])); };
        for (std::size_t k = 2; k < polygon.size(); ++k) addTriangle(place(0), place(k - 1), place(k), expected);
        cutCount += polygon.size() == 4 || (polygon.size() == 3 && dvec2(Place(polygon[0])) == polygon[0]) ? 1 : 0;
    }
    ASSERT_GT(cutCount, 30);
    const DenseMesh mesh = meshOf(positions, indices);
    const MeshModel model(device(), {.mesh = &mesh});
    const std::vector<int> found = rasterRenderer().countCrossings(model, options);
    int different = 0;
    for (std::size_t i = 0; i < found.size(); ++i) different += found[i] != expected[i] ? 1 : 0;
    EXPECT_LT(different, kRasterSide * kRasterSide / 100);
}

TEST_F(Raster, leavesNoCracksInClosedSurfaces) {
    const HeightMap map = sineMap(64, 0.1, 3);
    int surfaceCount = 0;
    for (const NamedCage& named : allCages()) {
        const Surface surface = buildSurface(named.cage, {.isolation = 2});
        if (!enclosesVolume(surface)) continue;
        ++surfaceCount;
        const SurfaceModel model(device(),
                                 {.surface = &surface, .cagePositions = named.cage.positions, .height = &map});
        const std::vector<dvec3> points(named.cage.positions.begin(), named.cage.positions.end());
        for (const int rate : {3, 8}) {
            RenderOptions options;
            options.path = Path::dice;
            options.rate = rate;
            options.raster = relief::Raster::compute;
            options.camera = frameCamera(points, {.azimuth = 31.0 * rate}, 1);
            options.bounds = computeBounds(named.cage.positions);
            EXPECT_EQ(rasterRenderer().crackPixels(model, options, vec3(0)), 0u) << named.name << " at rate " << rate;
        }
    }
    EXPECT_GT(surfaceCount, 8);
}

// --- which sample is kept ------------------------------------------------------------------------------------------

/// Triangles at the same places and depths with different normals: the order in which they arrive must not show.
TEST_F(Raster, isTheSameInEveryOrder) {
    std::mt19937 random(3);
    std::vector<vec3> positions, normals;
    std::vector<std::uint32_t> indices;
    for (const ivec2& place : randomPlaces(3000, random)) positions.push_back(vertexAt(place, 2));
    DenseMesh mesh;
    for (int copy = 0; copy < 3; ++copy)
        for (const vec3& p : positions) {
            mesh.positions.push_back(p);
            mesh.normals.push_back(glm::normalize(vec3(copy - 1, 0.5f, 1)));
        }
    for (std::uint32_t i = 0; i < mesh.positions.size(); ++i) mesh.indices.push_back(i);
    RenderOptions options = exactView(relief::Raster::compute);
    options.show = Show::normal;
    const auto draw = [&] {
        const MeshModel model(device(), {.mesh = &mesh});
        return rasterRenderer().render(model, options).halves;
    };
    const std::vector<std::uint16_t> first = draw();
    EXPECT_EQ(draw(), first);
    std::vector<std::uint32_t> reversed;
    for (std::size_t t = mesh.indices.size(); t > 0; t -= 3)
        reversed.insert(reversed.end(), {mesh.indices[t - 3], mesh.indices[t - 2], mesh.indices[t - 1]});
    mesh.indices = reversed;
    EXPECT_EQ(draw(), first);
}

/// Normals of a triangle whose corners are at very different distances, small enough for one invocation and larger,
/// against double precision: those of the corners, weighted by areas on the screen over distances.
TEST_F(Raster, interpolatesNormalsInPerspective) {
    const double distances[] = {1, 4, 16};
    const dvec3 normals[] = {{-0.6, 0, 0.8}, {0.6, 0, 0.8}, {0, 0.6, 0.8}};
    RenderOptions options = exactView(relief::Raster::compute);
    options.show = Show::normal;
    for (const int pixels : {26, 100}) {
        const int middle = kSubpixels * kRasterSide / 2, half = kSubpixels * pixels / 2;
        const ivec2 places[] = {
            {middle - half, middle + half}, {middle + half, middle + half}, {middle, middle - half}};
        DenseMesh mesh;
        for (std::uint32_t i = 0; i < 3; ++i) {
            mesh.positions.push_back(vertexAt(places[i], float(distances[i])));
            mesh.normals.emplace_back(normals[i]);
            mesh.indices.push_back(i);
        }
        const MeshModel model(device(), {.mesh = &mesh});
        const Image image = rasterRenderer().render(model, options).image();
        int seen = 0;
        double largest = 0;
        for (int y = 0; y < kRasterSide; ++y)
            for (int x = 0; x < kRasterSide; ++x) {
                if (image.at(x, y)[3] < 1) continue;
                const dvec2 p = double(kSubpixels) * (dvec2(x, y) + 0.5);
                dvec3 n(0);
                for (int i = 0; i < 3; ++i) {
                    const dvec2 a(dvec2(places[(i + 1) % 3]) - p), b(dvec2(places[(i + 2) % 3]) - p);
                    n += std::abs(a.x * b.y - a.y * b.x) / distances[i] * normals[i];
                }
                n = 0.5 * glm::normalize(n) + 0.5;
                for (int c = 0; c < 3; ++c)
                    largest = std::max(largest, std::abs(n[c] - image.at(x, y)[std::size_t(c)]));
                ++seen;
            }
        EXPECT_GT(seen, pixels * pixels / 3);
        EXPECT_LT(largest, 0.02) << pixels; // the mean of four samples stands for the middle
    }
}

// --- pictures ------------------------------------------------------------------------------------------------------

/// A displaced ball with a color map.
struct Scene {
    Cage cage = torusWithSeams();
    HeightMap map = sineMap(64, 0.1, 3);
    Image albedo = makeAlbedo();
    Surface surface = buildSurface(cage, {.isolation = 3});
    SurfaceModel model{device(),
                       {.surface = &surface, .cagePositions = cage.positions, .height = &map, .albedo = &albedo}};
    SurfaceModel plain{device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map}};
    SurfaceModel bent{device(), {.surface = &surface, .cagePositions = cage.positions, .bump = &map}};

    static Image makeAlbedo() {
        Image image{32, 32, 3, {}};
        for (int i = 0; i < 32 * 32; ++i)
            for (int c = 0; c < 3; ++c) image.texels.push_back(0.2f + 0.1f * float((i / 4 + i / 128 * 3 + c) % 7));
        return image;
    }
};

Scene& scene() {
    static Scene instance;
    return instance;
}

RenderOptions sceneOptions(const Cage& cage, relief::Raster raster) {
    RenderOptions options;
    options.path = Path::dice;
    options.rate = 12;
    const std::vector<dvec3> points(cage.positions.begin(), cage.positions.end());
    options.camera = frameCamera(points, {.azimuth = 20, .elevation = 50}, 1);
    options.bounds = computeBounds(cage.positions);
    options.raster = raster;
    return options;
}

/// Each pixel the mean of 4 x 4.
Image reduced(const Image& large) {
    Image small{large.width / 4, large.height / 4, large.channels, {}};
    for (int y = 0; y < small.height; ++y)
        for (int x = 0; x < small.width; ++x)
            for (int c = 0; c < small.channels; ++c) {
                float sum = 0;
                for (int k = 0; k < 16; ++k) sum += large.at(4 * x + k % 4, 4 * y + k / 4)[std::size_t(c)];
                small.texels.push_back(sum / 16);
            }
    return small;
}

double rmsDifference(const Image& a, const Image& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.texels.size(); ++i) {
        const double d = std::min(a.texels[i], 2.0f) - std::min(b.texels[i], 2.0f);
        sum += d * d;
    }
    return std::sqrt(sum / double(a.texels.size()));
}

/// The fixed function evaluates fragments at centres of pixels, outside of triangles that only touch the pixel; ours
/// evaluates samples where they are. It must be as near to a picture of sixteen times as many pixels.
TEST_F(Raster, isAsNearToALargePictureAsTheFixedFunction) {
    Renderer large(device(), {.width = 4 * kRasterSide, .height = 4 * kRasterSide, .shadowSide = 64});
    const auto compare = [&](const SurfaceModel& model, Show show, const std::string& name) {
        RenderOptions options = sceneOptions(scene().cage, relief::Raster::hardware);
        options.show = show;
        options.lighting.castsShadows = false;
        const Image reference = reduced(large.render(model, options).image());
        const Image hardware = rasterRenderer().render(model, options).image();
        options.raster = relief::Raster::compute;
        const Picture picture = rasterRenderer().render(model, options);
        ASSERT_EQ(int(picture.stats.raster), int(relief::Raster::compute));
        const Image compute = picture.image();
        EXPECT_LT(rmsDifference(compute, reference), 1.02 * rmsDifference(hardware, reference)) << name;
        // Coverage is the fixed function's, sample by sample.
        std::size_t different = 0;
        for (std::size_t i = 3; i < compute.texels.size(); i += 4) different += compute.texels[i] != hardware.texels[i];
        EXPECT_EQ(different, 0u) << name;
    };
    compare(scene().plain, Show::shaded, "plain");
    compare(scene().model, Show::shaded, "color map");
    compare(scene().bent, Show::shaded, "bump");
    for (const auto& [show, name] :
         {std::pair(Show::normal, "normal"), std::pair(Show::height, "height"), std::pair(Show::rate, "rate"),
          std::pair(Show::faces, "faces"), std::pair(Show::texCoords, "uv")})
        compare(scene().model, show, name);
}

/// The same samples come of the same vertices, in less memory, with shadows and further lights, and no crack between
/// pieces.
void expectSameInPieces(std::span<const Instance> instances, Show show) {
    RenderOptions options = sceneOptions(scene().cage, relief::Raster::compute);
    options.show = show;
    options.rate.reset(); // faces differ in their numbers of segments
    options.edgePixels = 0.4;
    options.lighting.keyElevation = 15;
    options.lighting.others = {{.azimuth = 110, .elevation = 20, .strength = 2, .color = {1, 0.5f, 0.2f}}};
    std::uint64_t wholeBytes = 0, triangleCount = 0;
    std::vector<std::uint16_t> whole;
    std::vector<int> crossings;
    for (const std::uint64_t pieceTriangles : {1u << 20, 20'000u, 1u}) {
        options.pieceTriangles = pieceTriangles;
        device().startPeak();
        const Picture picture = rasterRenderer().render(instances, options);
        const std::uint64_t bytes = device().peakBytes();
        const std::vector<int> sums = rasterRenderer().countCrossings(instances.front(), options);
        if (whole.empty()) {
            whole = picture.halves, crossings = sums;
            wholeBytes = bytes, triangleCount = picture.stats.triangleCount;
            ASSERT_GT(triangleCount, 100'000u);
            ASSERT_LT(triangleCount, 1u << 20);
        }
        EXPECT_EQ(picture.stats.triangleCount, triangleCount);
        EXPECT_TRUE(picture.halves == whole) << int(show) << " pieces of " << pieceTriangles;
        EXPECT_TRUE(sums == crossings) << pieceTriangles;
        const std::uint64_t saved = pieceTriangles > 20'000 ? 0 : 16 * triangleCount; // of 28 and more
        EXPECT_LE(bytes + saved, wholeBytes) << int(show) << " pieces of " << pieceTriangles;
    }
}

TEST_F(Raster, drawsASurfaceInPieces) {
    mat4 aside(1);
    aside[3] = {0.6f, 0.4f, 0.3f, 1};
    const Instance two[] = {{scene().model, {.albedo = vec3(0.8f, 0.1f, 0.1f)}}, {scene().bent, {}, aside}};
    expectSameInPieces(std::span(two), Show::shaded);
    const Instance plain(scene().plain);
    for (const Show show : {Show::shaded, Show::height, Show::wireframe})
        expectSameInPieces(std::span(&plain, 1), show);
}

/// Passes over pieces count as what they do, also where some instance is not in pieces.
TEST_F(Raster, timesThePassesOfPieces) {
    if (device().traits().timestampNanoseconds == 0) GTEST_SKIP() << "no times";
    const DenseMesh mesh = meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
    const MeshModel model(device(), {.mesh = &mesh});
    const Instance two[] = {{scene().plain}, {model}};
    for (const bool castsShadows : {false, true}) {
        RenderOptions options = sceneOptions(scene().cage, relief::Raster::compute);
        options.rate = 40;
        options.pieceTriangles = 20'000;
        options.lighting.castsShadows = castsShadows;
        const FrameStats stats = rasterRenderer().render(two, options).stats;
        ASSERT_GT(stats.triangleCount, 100'000u);
        EXPECT_GT(stats.diceMs, 0);
        EXPECT_GT(stats.colorMs, 0);
        EXPECT_TRUE(stats.shadowMs > 0 || !castsShadows);
        EXPECT_LT(stats.diceMs + stats.shadowMs + stats.colorMs + stats.lightMs, stats.wallMs);
    }
}

/// What does not fit is the largest piece.
TEST_F(Raster, saysHowLargeAPieceIsThatMemoryDoesNotHold) {
    RenderOptions options = sceneOptions(scene().cage, relief::Raster::compute);
    const std::uint64_t triangleCount = rasterRenderer().render(scene().plain, options).stats.triangleCount;
    options.pieceTriangles = 2000;
    ASSERT_GT(triangleCount, 2 * *options.pieceTriangles);
    options.memory = 50'000;
    std::string message;
    try {
        rasterRenderer().render(scene().plain, options);
    } catch (const Error& error) {
        message = error.what();
    }
    unsigned long long vertices = 0, triangles = 0, all = 0;
    ASSERT_EQ(std::sscanf(message.c_str(), "dicing makes %llu vertices and %llu triangles at a time, of %llu triangles",
                          &vertices, &triangles, &all),
              3)
        << message;
    EXPECT_EQ(all, triangleCount);
    EXPECT_LE(triangles, *options.pieceTriangles);
    EXPECT_GT(triangles, *options.pieceTriangles / 2);
    EXPECT_GT(vertices, triangles / 2);
    EXPECT_LT(vertices, triangleCount / 2);
}

// Mesa's CPU driver ended the process where dispatches were counted and draws followed.
TEST_F(Raster, isNotCountedAsDraws) {
    RenderOptions options = sceneOptions(scene().cage, relief::Raster::compute);
    options.countsPipeline = true;
    options.lighting.castsShadows = false;
    EXPECT_EQ(rasterRenderer().render(scene().plain, options).stats.pipeline.fragmentCalls, 0u);
    options.raster = relief::Raster::hardware;
    options.lighting.castsShadows = true;
    EXPECT_GT(rasterRenderer().render(scene().plain, options).stats.pipeline.fragmentCalls, 0u);
}

TEST_F(Raster, castsTheShadowsOfTheFixedFunction) {
    RenderOptions options = sceneOptions(scene().cage, relief::Raster::hardware);
    options.lighting.keyElevation = 15;
    Renderer renderer(device(), {.width = kRasterSide, .height = kRasterSide, .shadowSide = 512});
    const Image hardware = renderer.render(scene().plain, options).image();
    options.raster = relief::Raster::compute;
    const Image compute = renderer.render(scene().plain, options).image();
    options.lighting.castsShadows = false;
    const double without = rmsDifference(renderer.render(scene().plain, options).image(), compute);
    EXPECT_GT(without, 0.02);
    EXPECT_LT(rmsDifference(hardware, compute), without / 4);
}

TEST_F(Raster, drawsSeveralInstancesEachInItsMaterial) {
    RenderOptions options = sceneOptions(scene().cage, relief::Raster::hardware);
    mat4 aside(1);
    aside[3] = {0.6f, 0.4f, 0.3f, 1};
    const Instance two[] = {{scene().plain, {.albedo = vec3(0.8f, 0.1f, 0.1f)}},
                            {scene().model, {.albedo = vec3(0.2f, 0.9f, 0.3f), .roughness = 0.9f}, aside}};
    const Image hardware = rasterRenderer().render(two, options).image();
    options.raster = relief::Raster::compute;
    const Image compute = rasterRenderer().render(two, options).image();
    EXPECT_LT(rmsDifference(hardware, compute), 0.03);
    EXPECT_GT(rmsDifference(rasterRenderer().render(two[0], options).image(), compute), 0.1);
}

TEST_F(Raster, isRefusedWhereItCannotDraw) {
    RenderOptions options = sceneOptions(scene().cage, relief::Raster::compute);
    options.path = Path::grid;
    expectFailure(Failure::usage, {"compute rasterizer", "--path dice"},
                  [&] { rasterRenderer().render(scene().plain, options); });
}

/// Samples in the rectangles around lines are the same but for the rounding of their edges; of what lies at the same
/// depth one line or another is seen.
TEST_F(Raster, drawsTheLinesOfTheFixedFunction) {
    if (!device().traits().hasWireframe) GTEST_SKIP() << "no lines of the device";
    const auto expectAlike = [&](const Instance& instance, RenderOptions options, const std::string& name) {
        options.show = Show::faces;
        options.raster = relief::Raster::hardware;
        const Image faces = rasterRenderer().render(instance, options).image();
        options.show = Show::wireframe;
        const Image hardware = rasterRenderer().render(instance, options).image();
        options.raster = relief::Raster::compute;
        const Picture picture = rasterRenderer().render(instance, options);
        ASSERT_EQ(int(picture.stats.raster), int(relief::Raster::compute));
        EXPECT_LT(rmsDifference(picture.image(), hardware), 0.02) << name;
        EXPECT_GT(rmsDifference(faces, hardware), 0.08) << name;
    };
    RenderOptions options = sceneOptions(scene().cage, relief::Raster::compute);
    for (const int rate : {3, 12}) {
        options.rate = rate;
        expectAlike(scene().plain, options, fmt::format("rate {}", rate));
    }
    // Lines that pass the eye, end far beside the picture, and are longer than it.
    const DenseMesh floor =
        meshOf({{-6, -1, 3}, {6, -1, 3}, {90, -1, -60}, {-90, -1, -60}}, {0, 1, 2, 0, 2, 3}, {0, 1, 0});
    const MeshModel model(device(), {.mesh = &floor});
    expectAlike(model, exactView(relief::Raster::compute), "floor");
}

/// How much nearer lines are drawn than they lie follows from the plane of the triangle, also where its first corner is
/// so near to the plane through the eye that x / w and y / w overflow. A wall shows what is drawn much nearer.
TEST_F(Raster, drawsTheLinesOfTrianglesThatPassTheEye) {
    if (!device().traits().hasWireframe) GTEST_SKIP() << "no lines of the device";
    const DenseMesh wall = meshOf({{-9, -3, -8}, {0.1f, -3, -8}, {-2, 2, -8}}, {0, 1, 2});
    for (const float w : {1e-2f, 1e-7f, 1e-9f, 1e-20f, 0.0f, -1e-20f, -1e-9f, -1.0f}) {
        DenseMesh mesh = wall;
        for (const vec3& p : {vec3(0.3f, -1, -w), vec3(20, -1, -60), vec3(-20, -1, -60)}) {
            mesh.indices.push_back(std::uint32_t(mesh.positions.size()));
            mesh.positions.push_back(p);
            mesh.normals.emplace_back(0, 1, 0);
        }
        const MeshModel model(device(), {.mesh = &mesh});
        RenderOptions options = exactView(relief::Raster::hardware);
        options.show = Show::wireframe;
        const Image hardware = rasterRenderer().render(model, options).image();
        options.raster = relief::Raster::compute;
        const double rms = rmsDifference(rasterRenderer().render(model, options).image(), hardware);
        EXPECT_LT(rms, 0.007) << w; // twice what the rounding of edges makes
    }
}

/// n.l and v.r of vertices, interpolated, in the place of normals: once per light.
TEST_F(Raster, shadesVerticesAsTheFixedFunction) {
    RenderOptions options = sceneOptions(scene().cage, relief::Raster::hardware);
    options.rate = 4;
    options.shading = Shading::table;
    options.phong.exponent = 100;
    options.lighting.castsShadows = false;
    options.lighting.others = {{.azimuth = 110, .elevation = 20, .strength = 2, .color = {1, 0.5f, 0.2f}}};
    const Image pixels = rasterRenderer().render(scene().plain, options).image();
    options.tableAtVertices = true;
    const Image hardware = rasterRenderer().render(scene().plain, options).image();
    options.raster = relief::Raster::compute;
    const Image compute = rasterRenderer().render(scene().plain, options).image();
    const double asPixels = rmsDifference(pixels, hardware);
    EXPECT_GT(asPixels, 0.005);
    EXPECT_LT(rmsDifference(compute, hardware), asPixels / 2); // at samples, not at centres of pixels
}

/// By default small triangles are drawn by the way that is faster on the device, and large ones by the fixed function.
TEST_F(Raster, isChosenForSmallTriangles) {
    RenderOptions options = sceneOptions(scene().cage, relief::Raster::automatic);
    const auto chosen = [&] { return int(rasterRenderer().render(scene().plain, options).stats.raster); };
    const bool isFaster = device().traits().rastersFasterInCompute;
    EXPECT_EQ(chosen(), int(isFaster ? relief::Raster::compute : relief::Raster::hardware));
    options.rate = 2;
    EXPECT_EQ(chosen(), int(relief::Raster::hardware));
    // In pieces it is the compute rasterizer, whatever their size.
    options.pieceTriangles = 100;
    EXPECT_EQ(chosen(), int(isFaster ? relief::Raster::compute : relief::Raster::hardware));
    options.raster = relief::Raster::hardware; // never in pieces
    EXPECT_EQ(chosen(), int(relief::Raster::hardware));
}

} // namespace
} // namespace relief::test
