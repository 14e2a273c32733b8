// Shadows of displaced surfaces against rays through the double-precision reference of them (Embree).
#include "distance/distance.h"
#include "frame/device.h"
#include "meshes.h"

namespace relief::test {
namespace {

class ShadowsOnDevice : public OnDevice {};

constexpr int kShadowPixels = 160, kShadowSide = 2048;

struct ShadowScene {
    Cage cage;
    double height;
    int waves, rate;
    double azimuth, elevation; ///< of the light
    double eyeElevation = CameraOptions().elevation;
    double mostDifferent = 0.01; ///< share of pixels
};

/// A square in the plane y = 0 from (-1, -1) to (1, 1).
Cage texturedSquare() {
    Cage square;
    square.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    square.texCoords = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
    addFace(square, {0, 1, 2, 3}, {0, 1, 2, 3});
    return square;
}

/// A point that the middle of a pixel sees.
struct SeenPoint {
    int x, y;
    dvec3 at, normal;
};

std::vector<SeenPoint> seenPoints(const Picture& picture, const Camera& camera) {
    const dvec3 back = glm::normalize(camera.eye - camera.target),
                right = glm::normalize(glm::cross(dvec3(0, 1, 0), back)), up = glm::cross(back, right);
    const double tangent = std::tan(glm::radians(camera.fieldOfView) / 2);
    std::vector<SeenPoint> points;
    for (int y = 0; y < kShadowPixels; ++y)
        for (int x = 0; x < kShadowPixels; ++x) {
            const float* layer = &picture.layerValues[kLayerChannels * std::size_t(y * kShadowPixels + x)];
            if (layer[kLayerDepth] > 1e9f) continue;
            const dvec3 ray = ((2 * x + 1.0) / kShadowPixels - 1) * tangent * right -
                              ((2 * y + 1.0) / kShadowPixels - 1) * tangent * up - back;
            points.push_back({x, y, camera.eye + double(layer[kLayerDepth]) * ray,
                              dvec3(layer[kLayerNormal], layer[kLayerNormal + 1], layer[kLayerNormal + 2])});
        }
    return points;
}

/// Pixels, those of them that rays to the light say are in shadow, and those where picture and rays differ.
struct Census {
    int count = 0, inShadow = 0, different = 0;
};

// A ray begins as far over the surface as the shadow map's bias is. A soft shadow counts where it takes half of the
// light.
Census compare(const Picture& shadowed, const Image& lit, const MeasuredSurface& mesh, const RenderOptions& options,
               const dvec3& light) {
    const Image dark = shadowed.image();
    const double diagonal = options.bounds.diagonal(), bias = 1.5 * diagonal / kShadowSide;
    Census census;
    for (const SeenPoint& seen : seenPoints(shadowed, options.camera)) {
        // Where light grazes the surface by less than six degrees its triangles' corners decide.
        if (lit.at(seen.x, seen.y)[3] < 1 || glm::dot(seen.normal, light) < 0.1) continue;
        const double tilt = glm::length(glm::cross(seen.normal, light));
        const bool isHidden = mesh.isBlocked(seen.at + bias * (0.5 + 2 * tilt) * seen.normal, light, 2 * diagonal);
        const bool isDark = dark.at(seen.x, seen.y)[1] < 0.5f * lit.at(seen.x, seen.y)[1];
        ++census.count, census.inShadow += isHidden, census.different += isHidden != isDark;
    }
    return census;
}

// The device displaces and draws; rays go through the reference's triangles of the same rate. By the key light and by
// one that is added, by both rasterizers. The last scene has shadows from so nearby, a fiftieth of its size, that
// depths must be compared as finely as they are; it has the most borders. Pixels differ along the borders of shadows,
// which a pixel of the picture and three texels of the shadow map blur.
TEST_F(ShadowsOnDevice, areThoseOfRays) {
    const ShadowScene scenes[] = {{torusWithSeams(), 0.05, 10, 20, 70, 14},
                                  {cubeOfIslands(), 0.25, 3, 48, -50, 25},
                                  {torusWithMirroredTexture(), 0.09, 6, 16, 105, 15},
                                  {texturedSquare(), 0.012, 16, 256, -50, 14, 45, 0.02}};
    Renderer renderer(device(), {.width = kShadowPixels, .height = kShadowPixels, .shadowSide = kShadowSide});
    for (const ShadowScene& scene : scenes) {
        const HeightMap map = sineMap(256, scene.height, scene.waves);
        const DenseMesh mesh = denseMesh(ReferenceSurface(scene.cage, {.isolation = 3}), &map, scene.rate);
        const MeasuredSurface measured({mesh.positions, mesh.indices}, 1000, TreeUse::lines);
        const Surface surface = buildSurface(scene.cage, {.isolation = 3});
        const SurfaceModel model(device(),
                                 {.surface = &surface, .cagePositions = scene.cage.positions, .height = &map});
        RenderOptions options;
        options.path = Path::dice;
        options.rate = std::uint32_t(scene.rate);
        options.filtersHeights = false;
        options.bounds = computeBounds(mesh.positions);
        const std::vector<dvec3> points(mesh.positions.begin(), mesh.positions.end());
        options.camera = frameCamera(points, {.elevation = scene.eyeElevation}, 1);
        options.shading = Shading::phong; // no light but that of the lamps
        options.phong = {.ambient = 0, .diffuse = 1, .specular = 0, .exponent = 1};
        options.layers = {Layer::depth, Layer::normal};
        const dvec3 light = directionAt(scene.azimuth, scene.elevation);
        for (const bool isAdded : {false, true}) {
            const bool isCompute = isAdded && device().traits().hasLongAtomics;
            options.raster = isCompute ? relief::Raster::compute : relief::Raster::hardware;
            const auto draw = [&](bool castsShadows) {
                options.lighting = {
                    .keyAzimuth = scene.azimuth, .keyElevation = scene.elevation, .castsShadows = castsShadows};
                if (isAdded) {
                    options.lighting.others = {{.azimuth = scene.azimuth, .elevation = scene.elevation}};
                    options.lighting.keyStrength = 0, options.lighting.keyAzimuth += 120; // its shadows are others
                }
                return renderer.render(Instance(model), options);
            };
            const Picture shadowed = draw(true);
            const Census census = compare(shadowed, draw(false).image(), measured, options, light);
            EXPECT_GT(census.count, 1500);
            EXPECT_GT(census.inShadow, census.count / 80) << scene.azimuth;
            EXPECT_LE(census.different, scene.mostDifferent * census.count)
                << scene.azimuth << ' ' << isAdded << ": " << census.count << " pixels, " << census.inShadow
                << " in shadow";
        }
    }
}

} // namespace
} // namespace relief::test
