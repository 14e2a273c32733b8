// Materials, tables, balls, lights and occlusion, each against what it stands for.
#include <algorithm>
#include <numbers>

#include <glm/gtc/matrix_transform.hpp>

#include "frame/device.h"
#include "light/pictures.h"
#include "meshes.h"

namespace relief::test {
namespace {

class ShadingOnDevice : public OnDevice {};

/// A ball of radius 1 with exact normals.
DenseMesh roundBall(std::uint32_t n) {
    DenseMesh ball;
    for (std::uint32_t j = 0; j <= n; ++j)
        for (std::uint32_t i = 0; i <= 2 * n; ++i) {
            const double theta = std::numbers::pi * j / n, phi = std::numbers::pi * i / n;
            ball.positions.emplace_back(std::sin(theta) * std::sin(phi), std::cos(theta),
                                        std::sin(theta) * std::cos(phi));
            ball.normals.push_back(ball.positions.back());
            if (i == 2 * n || j == n) continue;
            const std::uint32_t a = j * (2 * n + 1) + i, b = a + 2 * n + 1;
            ball.indices.insert(ball.indices.end(), {a, b, b + 1, a, b + 1, a + 1});
        }
    return ball;
}

constexpr int kSide = 128;

struct BallScene {
    DenseMesh mesh;
    MeshModel model;
    Renderer renderer{device(), {.width = kSide, .height = kSide, .shadowSide = 64}};
    RenderOptions options;

    explicit BallScene(std::uint32_t n = 96, double distance = 6)
        : mesh(roundBall(n)), model(device(), {.mesh = &mesh}) {
        options.bounds = computeBounds(mesh.positions);
        options.camera = {.eye = distance * directionAt(20, 10),
                          .fieldOfView = glm::degrees(2 * std::asin(1.02 / distance)),
                          .nearDistance = distance - 2,
                          .farDistance = distance + 2};
        options.lighting.castsShadows = false;
    }
    Image draw(const Material& material) { return renderer.render(Instance(model, material), options).image(); }
    Image drawDark(const Material& material) { // in the environment alone
        options.lighting.keyStrength = 0;
        return draw(material);
    }
};

bool isCovered(const Image& image, int x, int y) { return image.at(x, y)[3] == 1; }

/// The largest difference of two pictures where both are covered.
double largestDifference(const Image& a, const Image& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.texels.size(); i += 4)
        for (std::size_t c = 0; c < 3; ++c)
            if (a.texels[i + 3] == 1 && b.texels[i + 3] == 1)
                largest = std::max(largest, std::abs(double(a.texels[i + c]) - b.texels[i + c]));
    return largest;
}

/// The share of covered pixels that differ by more than `tolerance`.
double shareOfDifferent(const Image& a, const Image& b, double tolerance) {
    double count = 0, different = 0;
    for (std::size_t i = 0; i < a.texels.size(); i += 4) {
        if (a.texels[i + 3] < 1 || b.texels[i + 3] < 1) continue;
        ++count;
        for (std::size_t c = 0; c < 3; ++c)
            if (std::abs(a.texels[i + c] - b.texels[i + c]) > tolerance) {
                ++different;
                break;
            }
    }
    return different / std::max(count, 1.0);
}

/// The largest color, without alpha.
float brightestOf(const Image& image) {
    float brightest = 0;
    for (std::size_t i = 0; i < image.texels.size(); ++i)
        if (i % 4 != 3) brightest = std::max(brightest, image.texels[i]);
    return brightest;
}

// --- materials ----------------------------------------------------------------------------------------------------

// In light that is the same from everywhere a surface that absorbs nothing cannot be seen.
TEST_F(ShadingOnDevice, aWhiteFurnaceIsFlat) {
    BallScene scene;
    const GpuEnvironment even = uploadEnvironment(
        device(), makeEnvironment(drawPicture(EnvironmentShape::equirect, 16, [](const dvec3&) { return dvec3(1); })));
    scene.options.lighting.environment = &even;
    for (const float metallic : {0.0f, 0.5f, 1.0f})
        for (const float roughness : {0.0f, 0.3f, 0.7f, 1.0f}) {
            const Image image = scene.drawDark({.albedo = vec3(1), .roughness = roughness, .metallic = metallic});
            for (int y = 0; y < kSide; ++y)
                for (int x = 0; x < kSide; ++x)
                    for (int c = 0; c < 3 && isCovered(image, x, y); ++c)
                        ASSERT_NEAR(image.at(x, y)[c], 1, 0.02) << metallic << ' ' << roughness << ' ' << x << ' ' << y;
        }
    // The material without a value of metallic adds its reflection to all of the diffuse light: it is as it was.
    const Image usual = scene.drawDark({.albedo = vec3(1)});
    EXPECT_GT(usual.at(kSide / 2, kSide / 2)[0], 1.03f);
}

/// Calls take(x, y, mirrored) for each pixel that shows the unit ball around the origin, but the outermost, which see
/// all of the horizon: `mirrored` is where the ball
/// mirrors the ray through the pixel's centre to.
void forEachMirrored(const Camera& camera, const Image& image,
                     const std::function<void(int, int, const dvec3&)>& take) {
    const dvec3 back = glm::normalize(camera.eye), right = glm::normalize(glm::cross(dvec3(0, 1, 0), back)),
                up = glm::cross(back, right);
    const double tangent = std::tan(glm::radians(camera.fieldOfView) / 2), distance = glm::length(camera.eye);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const dvec3 ray = glm::normalize(((2 * x + 1.0) / kSide - 1) * tangent * right -
                                             ((2 * y + 1.0) / kSide - 1) * tangent * up - back);
            const double b = glm::dot(ray, camera.eye), root = b * b - distance * distance + 1;
            if (root < 0.05 || !isCovered(image, x, y)) continue;
            const dvec3 n = camera.eye + (-b - std::sqrt(root)) * ray;
            take(x, y, ray - 2 * glm::dot(ray, n) * n);
        }
}

// Directions of reflected rays in double precision, of a sphere without triangles.
TEST_F(ShadingOnDevice, aMirrorShowsTheEnvironment) {
    BallScene scene(192);
    const GpuEnvironment smooth =
        uploadEnvironment(device(), makeEnvironment(drawPicture(EnvironmentShape::equirect, 256, smoothLight), true));
    scene.options.lighting.environment = &smooth;
    const Image image = scene.drawDark({.albedo = vec3(1), .roughness = 0, .metallic = 1.0f});
    double sum = 0, largest = 0;
    int count = 0;
    forEachMirrored(scene.options.camera, image, [&](int x, int y, const dvec3& mirrored) {
        const dvec3 expected = smoothLight(mirrored);
        for (int c = 0; c < 3; ++c) {
            const double error = std::abs(image.at(x, y)[c] - expected[c]);
            sum += error, ++count, largest = std::max(largest, error);
        }
    });
    EXPECT_GT(count, 3 * 10'000);
    EXPECT_LT(sum / count, 0.002);
    EXPECT_LT(largest, 0.03);
}

// A mirror in what was captured where it stands, with another ball beside it: each pixel shows what its mirrored
// direction meets, as directions and spheres in double precision say.
TEST_F(ShadingOnDevice, aMirrorShowsCapturedSurroundings) {
    BallScene scene(192);
    const EnvironmentPicture sky = drawPicture(EnvironmentShape::equirect, 256, smoothLight);
    const GpuEnvironment plainSky = uploadEnvironment(device(), makeEnvironment(sky));
    const dvec3 beside(-1.5, 1.0, 4.0); // the centre of a black ball of radius 1, which sends no light
    RenderOptions around = scene.options;
    around.lighting.environment = &plainSky;
    around.lighting.keyStrength = 0;
    around.bounds.add(beside - 1.0);
    around.bounds.add(beside + 1.0);
    around.shading = Shading::phong;
    around.phong = {.ambient = 0, .diffuse = 0, .specular = 0, .exponent = 1};
    const Instance black(scene.model, {.albedo = vec3(0)}, glm::translate(mat4(1), vec3(beside)));
    const EnvironmentPicture captured =
        captureSurroundings(device(), std::span(&black, 1), around, {.at = dvec3(0), .side = 512, .behind = &sky});
    const GpuEnvironment environment = uploadEnvironment(device(), makeEnvironment(captured, true));
    scene.options.lighting.environment = &environment;
    const Image image = scene.drawDark({.albedo = vec3(1), .roughness = 0, .metallic = 1.0f});

    int count = 0, blacks = 0, wrong = 0;
    double sum = 0;
    forEachMirrored(scene.options.camera, image, [&](int x, int y, const dvec3& mirrored) {
        // Environments are far away: what a direction shows is what is seen along it from the middle.
        const double along = glm::dot(mirrored, beside), off = glm::length(beside - along * mirrored);
        const bool isBlack = along > 0 && off < 1;
        if (along > 0 && std::abs(off - 1) < 0.15) return; // outlines are blurred by the pixel's footprint
        const dvec3 expected = isBlack ? dvec3(0) : smoothLight(mirrored);
        double error = 0;
        for (int c = 0; c < 3; ++c) error = std::max(error, std::abs(image.at(x, y)[c] - expected[c]));
        ++count, blacks += isBlack, wrong += error > 0.03, sum += error;
    });
    EXPECT_GT(count, 8000);
    EXPECT_GT(blacks, 50);
    EXPECT_LE(wrong, count / 100);
    EXPECT_LT(sum / count, 0.006);
}

TEST_F(ShadingOnDevice, reflectionsAgreeBetweenShapesOfAnEnvironment) {
    BallScene scene;
    const EnvironmentPicture equirect = drawPicture(EnvironmentShape::equirect, 64, smoothLight);
    std::vector<Image> images;
    for (const EnvironmentShape shape :
         {EnvironmentShape::equirect, EnvironmentShape::cube, EnvironmentShape::sphere}) {
        const EnvironmentPicture picture = convert(equirect, shape, sideOf(equirect, shape));
        const GpuEnvironment environment = uploadEnvironment(device(), makeEnvironment(picture, true));
        scene.options.lighting.environment = &environment;
        images.push_back(scene.drawDark({.albedo = vec3(1), .roughness = 0, .metallic = 1.0f}));
    }
    EXPECT_LT(largestDifference(images[0], images[1]), 0.03);
    // A sphere map smears what is behind it, which a mirror shows at one point.
    EXPECT_LT(shareOfDifferent(images[0], images[2], 0.03), 0.03);
    EXPECT_LT(largestDifference(images[0], images[2]), 0.2);
}

TEST_F(ShadingOnDevice, roughMirrorsAreBlurred) {
    BallScene scene;
    const GpuEnvironment lamp = uploadEnvironment(
        device(), makeEnvironment(drawPicture(EnvironmentShape::equirect, 64,
                                              [](const dvec3& d) { return dvec3(d.y > 0.95 ? 20 : 0.1); }),
                                  true));
    scene.options.lighting.environment = &lamp;
    float brightest[3];
    const float roughness[] = {0, 0.4f, 0.8f};
    for (int i = 0; i < 3; ++i) {
        const Image image = scene.drawDark({.albedo = vec3(1), .roughness = roughness[i], .metallic = 1.0f});
        brightest[i] = brightestOf(image);
    }
    EXPECT_NEAR(brightest[0], 20, 1);
    EXPECT_LT(brightest[1], 0.8f * brightest[0]);
    EXPECT_LT(brightest[2], 0.6f * brightest[1]);
}

// A picture from the captured point, in a direction that is no face's, shows what the cube holds along its rays.
TEST_F(ShadingOnDevice, surroundingsAreWhatAnEyeSeesThere) {
    BallScene scene;
    const EnvironmentPicture sky = drawPicture(EnvironmentShape::equirect, 64, smoothLight);
    const GpuEnvironment environment = uploadEnvironment(device(), makeEnvironment(sky));
    scene.options.lighting.environment = &environment;
    const Instance ball(scene.model, {.albedo = {0.9f, 0.2f, 0.1f}});
    const dvec3 at(0.4, -0.7, 2.2);
    const EnvironmentPicture cube =
        captureSurroundings(device(), std::span(&ball, 1), scene.options, {.at = at, .side = 256, .behind = &sky});
    const dvec3 back = glm::normalize(dvec3(0.5, 0.4, 1)), right = glm::normalize(glm::cross(dvec3(0, 1, 0), back)),
                up = glm::cross(back, right);
    scene.options.camera = {.eye = at, .target = at - back, .fieldOfView = 60, .nearDistance = 0.1, .farDistance = 10};
    const Image seen = scene.renderer.render(ball, scene.options).image();
    double sum = 0;
    int balls = 0;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double tangent = std::tan(glm::radians(30.0));
            const dvec3 ray = glm::normalize(((2 * x + 1.0) / kSide - 1) * tangent * right -
                                             ((2 * y + 1.0) / kSide - 1) * tangent * up - back);
            const dvec3 held = lookUp(cube, ray), far = smoothLight(ray);
            const float* c = seen.at(x, y);
            for (int i = 0; i < 3; ++i) sum += std::abs(c[i] + (1 - c[3]) * far[i] - held[i]);
            balls += c[3] == 1;
        }
    EXPECT_GT(balls, kSide * kSide / 10);
    EXPECT_LT(balls, kSide * kSide * 9 / 10);
    EXPECT_LT(sum / (3 * kSide * kSide), 0.01); // outlines lie between pixels
}

// --- shading by dot products and by pictures ----------------------------------------------------------------------

struct TorusScene {
    Cage cage = torusWithSeams();
    HeightMap map = sineMap(64, 0.1);
    Surface surface = buildSurface(cage, {.isolation = 2});
    SurfaceModel model{device(), {.surface = &surface, .cagePositions = cage.positions, .height = &map}};
    Renderer renderer{device(), {.width = kSide, .height = kSide, .shadowSide = 256}};
    RenderOptions options = relief::test::optionsFor(cage);

    TorusScene() { options.path = Path::dice, options.rate = 12; }
    Image draw(const Material& material = {}) { return renderer.render(Instance(model, material), options).image(); }
};

TEST_F(ShadingOnDevice, aTableIsPhongWithinACode) {
    TorusScene scene;
    for (const relief::Raster raster : {relief::Raster::hardware, relief::Raster::compute}) {
        scene.options.raster = raster;
        scene.options.shading = Shading::phong;
        const Image direct = scene.draw();
        scene.options.shading = Shading::table;
        const Image table = scene.draw();
        EXPECT_LT(largestDifference(direct, table), 1 / 255.0);
        EXPECT_GT(brightestOf(direct), 0.6f);
        if (!device().traits().hasLongAtomics) break;
    }
}

// Hart, eq. 16.20, of one pixel.
TEST_F(ShadingOnDevice, phongIsItsFormula) {
    BallScene scene(96, 500);
    scene.options.shading = Shading::phong;
    scene.options.phong = {.ambient = 0.1f, .diffuse = 0.6f, .specular = 0.5f, .exponent = 12};
    scene.options.lighting.keyAzimuth = 50, scene.options.lighting.keyElevation = 30;
    scene.options.lighting.keyColor = vec3(1);
    scene.options.lighting.keyStrength = std::numbers::pi; // c of eq. 16.20 itself
    const Image image = scene.draw({.albedo = {0.5f, 0.25f, 0.125f}});
    const dvec3 n = directionAt(20, 10), l = directionAt(50, 30); // the eye looks at the middle along the normal
    const dvec3 r = 2 * glm::dot(n, l) * n - l;
    for (int c = 0; c < 3; ++c) {
        const double albedo = 0.5 / (1 << c);
        const double expected = albedo * (0.1 + 0.6 * glm::dot(n, l)) + 0.5 * std::pow(glm::dot(n, r), 12);
        EXPECT_NEAR(image.at(kSide / 2, kSide / 2)[c], expected, 0.01);
    }
}

// Two vertices per side of a face miss the highlight in its middle, which every pixel's own dot products show.
TEST_F(ShadingOnDevice, aTableAtVerticesMissesHighlights) {
    BallScene scene(6);
    scene.options.shading = Shading::table;
    scene.options.phong.exponent = 100;
    scene.options.lighting.keyAzimuth = 5, scene.options.lighting.keyElevation = 5; // half way: between vertices
    const Image pixels = scene.draw({});
    scene.options.tableAtVertices = true;
    const Image vertices = scene.draw({});
    const float bright = brightestOf(pixels), dull = brightestOf(vertices);
    EXPECT_LT(dull, bright - 0.1f) << bright;
    // With vertices nearer to each other than the highlight is wide, both are the same.
    BallScene fine(96);
    fine.options.shading = Shading::table;
    const Image finePixels = fine.draw({});
    fine.options.tableAtVertices = true;
    EXPECT_LT(shareOfDifferent(fine.draw({}), finePixels, 0.02), 0.02);

    // The dot products of a further light are others: what it adds is what it brings as the only one.
    fine.options.phong.ambient = 0;
    const Image key = fine.draw({});
    const DistantLight lamp{.azimuth = 110, .elevation = 20, .strength = 2, .color = {1, 0.5f, 0.2f}};
    fine.options.lighting.others = {lamp};
    Image both = fine.draw({});
    fine.options.lighting = {.keyAzimuth = lamp.azimuth,
                             .keyElevation = lamp.elevation,
                             .keyStrength = lamp.strength,
                             .keyColor = lamp.color,
                             .castsShadows = false};
    const Image added = fine.draw({});
    EXPECT_GT(brightestOf(added), 0.3f);
    for (std::size_t i = 0; i < both.texels.size(); ++i)
        if (i % 4 != 3) both.texels[i] -= added.texels[i];
    EXPECT_LT(largestDifference(both, key), 0.004); // halves: 2^-11 of up to 2, three times
}

// What a .png shows, for an eye so far away that all lines of sight are parallel, as those to the ball are.
TEST_F(ShadingOnDevice, aMatcapIsDirectShading) {
    TorusScene scene;
    const dvec3 back = glm::normalize(scene.options.camera.eye - scene.options.camera.target);
    scene.options.camera.eye = scene.options.camera.target + 400.0 * back;
    scene.options.camera.fieldOfView = 0.4;
    fitDepth(scene.options.camera, scene.options.bounds);
    scene.options.lighting.castsShadows = false;
    scene.options.lighting.others = {{.azimuth = 120, .elevation = 20, .strength = 1.5, .color = {0.3f, 0.5f, 1}}};
    const Material material{.albedo = {0.7f, 0.3f, 0.2f}, .roughness = 0.5f};
    const auto drawCodes = [&] {
        Picture picture = scene.renderer.render(Instance(scene.model, material), scene.options);
        Image codes = displayed(picture, {.background = Background::transparent});
        return codes;
    };
    const Image direct = drawCodes();
    scene.options.shading = Shading::matcap;
    const Image ball = drawCodes();
    EXPECT_LT(shareOfDifferent(direct, ball, 2 / 255.0), 0.002);
    EXPECT_LT(largestDifference(direct, ball), 20 / 255.0) << "at outlines, of folds too, where the ball's rim is seen";

    // A ball has no folds: two codes wherever it faces the eye by more than nine degrees.
    BallScene smooth(192, 400);
    smooth.options.lighting.others = scene.options.lighting.others;
    const auto drawBall = [&](Shading shading) {
        smooth.options.shading = shading;
        return displayed(smooth.renderer.render(Instance(smooth.model, material), smooth.options),
                         {.background = Background::transparent});
    };
    const Image directBall = drawBall(Shading::physical), matcapBall = drawBall(Shading::matcap);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            const double radius = 1.02 * glm::length(dvec2(2 * x + 1, 2 * y + 1) / double(kSide) - 1.0);
            if (1 - radius * radius < 0.15 * 0.15) continue;
            for (int c = 0; c < 3; ++c)
                ASSERT_LE(std::abs(directBall.at(x, y)[c] - matcapBall.at(x, y)[c]), 2.01 / 255) << x << ' ' << y;
        }

    // An artist's: red on the left, blue on the right.
    Image artist{64, 64, 3, {}};
    for (int i = 0; i < 64 * 64; ++i) {
        const float right = i % 64 < 32 ? 0.0f : 1.0f;
        artist.texels.insert(artist.texels.end(), {1 - right, 0.0f, right});
    }
    const GpuMatcap matcap = uploadMatcap(device(), artist);
    BallScene balls;
    balls.options.shading = Shading::matcap;
    balls.options.matcap = &matcap;
    const Image seen = balls.draw({});
    EXPECT_GT(seen.at(kSide / 4, kSide / 2)[0], 0.95f);
    EXPECT_GT(seen.at(3 * kSide / 4, kSide / 2)[2], 0.95f);
}

// --- lights -------------------------------------------------------------------------------------------------------

// Light adds up: a picture in three lights is that of the environment plus what each brings alone, shadows included.
TEST_F(ShadingOnDevice, severalLightsAddUpWithTheirShadows) {
    TorusScene scene;
    const DistantLight lights[] = {{.azimuth = 70, .elevation = 25, .strength = 2, .color = {1, 0.4f, 0.2f}},
                                   {.azimuth = -80, .elevation = 15, .strength = 1.5, .color = {0.2f, 0.5f, 1}}};
    for (const relief::Raster raster : {relief::Raster::hardware, relief::Raster::compute}) {
        if (raster == relief::Raster::compute && !device().traits().hasLongAtomics) break;
        scene.options.raster = raster;
        scene.options.lighting = {};
        const Image key = scene.draw();
        scene.options.lighting.others.assign(std::begin(lights), std::end(lights));
        const Image all = scene.draw();
        scene.options.lighting = {};
        scene.options.lighting.keyStrength = 0;
        const Image dark = scene.draw();
        Image expected = key;
        std::size_t shadowed = 0;
        for (const DistantLight& light : lights) {
            scene.options.lighting.keyAzimuth = light.azimuth, scene.options.lighting.keyElevation = light.elevation;
            scene.options.lighting.keyStrength = light.strength, scene.options.lighting.keyColor = light.color;
            const Image one = scene.draw();
            scene.options.lighting.castsShadows = false;
            const Image open = scene.draw();
            scene.options.lighting.castsShadows = true;
            for (std::size_t i = 0; i < expected.texels.size(); ++i) {
                if (i % 4 != 3) expected.texels[i] += one.texels[i] - dark.texels[i];
                shadowed += open.texels[i] > one.texels[i] + 0.02f;
            }
        }
        EXPECT_LT(largestDifference(all, expected), 0.006) << int(raster); // halves: 2^-11 of up to 3, four times
        EXPECT_GT(shadowed, 100u) << "the lights do cast shadows";
    }
}

// A floor and a wall at right angles. At the distance d from a wall of height H, a point of the floor loses
// (1 - d / sqrt(d^2 + H^2)) / 2 of even light (Lambert; the form factor of a half plane's strip).
TEST_F(ShadingOnDevice, occlusionIsThatOfAWallBesideAFloor) {
    constexpr float kHeight = 0.5f;
    DenseMesh mesh;
    const auto add = [&](const vec3& origin, const vec3& u, const vec3& v) {
        const auto first = std::uint32_t(mesh.positions.size());
        for (const vec3& p : {origin, origin + u, origin + u + v, origin + v})
            mesh.positions.push_back(p), mesh.normals.push_back(glm::normalize(glm::cross(u, v)));
        mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2, first, first + 2, first + 3});
    };
    add({-2, 0, 0}, {0, 0, 2}, {4, 0, 0});       // the floor: y = 0, z from 0 to 2
    add({-2, 0, 0}, {4, 0, 0}, {0, kHeight, 0}); // the wall: z = 0
    const MeshModel model(device(), {.mesh = &mesh});
    RenderOptions options;
    options.bounds = computeBounds(mesh.positions);
    options.camera = {.eye = {0, 6, 6}, .target = {0, 0, 0.7}, .fieldOfView = 20, .nearDistance = 4, .farDistance = 12};
    options.lighting.castsShadows = false;
    options.lighting.keyStrength = 0;
    const GpuEnvironment even = uploadEnvironment(
        device(), makeEnvironment(drawPicture(EnvironmentShape::equirect, 16, [](const dvec3&) { return dvec3(1); })));
    options.lighting.environment = &even;
    constexpr int kSize = 256;
    Renderer renderer(device(), {.width = kSize, .height = kSize, .shadowSide = 64});
    const Instance instance(model, {.albedo = vec3(1), .roughness = 1, .metallic = 0.0f});
    for (const relief::Raster raster : {relief::Raster::hardware, relief::Raster::compute}) {
        if (raster == relief::Raster::compute && !device().traits().hasLongAtomics) break;
        options.raster = raster;
        options.lighting.occlusionRadius = 0;
        const Image open = renderer.render(instance, options).image();
        options.lighting.occlusionRadius = 0.4;
        const Image dark = renderer.render(instance, options).image();
        const double aspect = std::tan(glm::radians(10.0));
        const dvec3 back = glm::normalize(options.camera.eye - options.camera.target),
                    up = glm::cross(back, dvec3(1, 0, 0));
        int count = 0;
        for (int y = 0; y < kSize; ++y) {
            // The point of the floor in the middle column.
            const dvec3 ray = -back - ((2 * y + 1.0) / kSize - 1) * aspect * up;
            const double z = options.camera.eye.z - ray.z * options.camera.eye.y / ray.y;
            if (z < 0.05 || z > 1.9) continue;
            const double expected = 1 - 0.5 * (1 - z / std::hypot(z, kHeight));
            EXPECT_NEAR(dark.at(kSize / 2, y)[0] / open.at(kSize / 2, y)[0], expected, 0.08) << z;
            ++count;
        }
        EXPECT_GT(count, 60);
        EXPECT_LT(dark.at(kSize / 2, kSize / 2)[0], 1);
    }
}

} // namespace
} // namespace relief::test
