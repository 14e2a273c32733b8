// Water over a floor against rays that are traced, reflected and refracted in double precision.
#include <algorithm>
#include <numbers>

#include "light/pictures.h"
#include "seen.h"

namespace relief::test {
namespace {

class WaterOnDevice : public OnDevice {};

constexpr int kWaterPixels = 128;
constexpr double kIndexOfWater = 1.333, kPi = std::numbers::pi;

// Waves over the square from (-1, -1) to (1, 1) in the plane y = 0, up to 20 degrees steep.
const char* const kRipples = "0.04 * sin(5.0 * p.x + 2.0 * p.z) + 0.02 * cos(3.0 * p.x - 7.0 * p.z)";

double rippleAt(double x, double z) { return 0.04 * std::sin(5 * x + 2 * z) + 0.02 * std::cos(3 * x - 7 * z); }

dvec3 rippleNormalAt(double x, double z) {
    const double a = 0.04 * std::cos(5 * x + 2 * z), b = -0.02 * std::sin(3 * x - 7 * z);
    return glm::normalize(dvec3(-(5 * a + 3 * b), 1, -(2 * a - 7 * b)));
}

Cage levelSquare() {
    Cage plane;
    plane.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}};
    addFace(plane, {0, 1, 2, 3}, {});
    return plane;
}

struct WaterScene {
    Cage cage = levelSquare();
    Surface surface = buildSurface(cage, {.scheme = Scheme::bilinear});
    FunctionHeights heights;
    SurfaceModel model;
    GpuEnvironment environment;
    Renderer renderer{device(), {.width = kWaterPixels, .height = kWaterPixels, .shadowSide = 64}};
    RenderOptions options;
    Material material{.albedo = {0.3f, 0.7f, 0.8f}, .roughness = 0}; // the albedo is stored in codes: see albedoSeen()

    WaterScene(const char* waves, const Light& light)
        : heights(heightsByFunction(waves, ByFunction::moves)),
          model(device(), {.surface = &surface, .cagePositions = cage.positions, .function = &heights}),
          environment(
              uploadEnvironment(device(), makeEnvironment(drawPicture(EnvironmentShape::equirect, 256, light), true))) {
        options.path = Path::dice;
        options.rate = 128;
        options.shading = Shading::water;
        options.bounds.add(dvec3(-1.1));
        options.bounds.add(dvec3(1.1));
        const dvec3 target(0.05, 0, 0.1);
        options.camera = {.eye = target + 3.0 * directionAt(20, 38), .target = target, .fieldOfView = 28};
        fitDepth(options.camera, options.bounds);
        options.lighting.environment = &environment;
        options.lighting.castsShadows = false;
        options.waterFloor = {.height = -0.3, .depth = 0.3, .color = {0.7f, 0.6f, 0.4f}, .tile = 0.25};
    }
    Image draw() { return renderer.render(Instance(model, material), options).image(); }
};

/// The share that water reflects at an angle to its normal in radians, from outside (Fresnel's own form, by sines and
/// tangents of the two angles).
double reflectance(double outside) {
    const double inside = std::asin(std::sin(outside) / kIndexOfWater);
    if (outside < 1e-6) return std::pow((kIndexOfWater - 1) / (kIndexOfWater + 1), 2);
    const double s = std::sin(outside - inside) / std::sin(outside + inside);
    const double p = std::tan(outside - inside) / std::tan(outside + inside);
    return 0.5 * (s * s + p * p);
}

/// Means over the half space around +Y, weighted by the cosine.
dvec3 hemisphereMean(const std::function<dvec3(const dvec3&)>& of) {
    constexpr int kRings = 200, kParts = 400;
    dvec3 sum(0);
    for (int i = 0; i < kRings; ++i)
        for (int k = 0; k < kParts; ++k) { // rings of equal cosine-weighted parts
            const double y = std::sqrt((i + 0.5) / kRings), phi = 2 * kPi * (k + 0.5) / kParts,
                         r = std::sqrt(1 - y * y);
            sum += of({r * std::cos(phi), y, r * std::sin(phi)});
        }
    return sum / double(kRings * kParts);
}

/// What a line of sight shows, but for the sun's own picture on the waves.
class WaterReference {
public:
    WaterReference(const WaterScene& scene, const Light& light)
        : floor_(scene.options.waterFloor), albedo_(scene.material.albedo), light_(light),
          lighting_(scene.options.lighting) {
        const double outer = hemisphereMean([](const dvec3& d) { return dvec3(reflectance(std::acos(d.y))); }).x;
        innerReflectance_ = 1 - (1 - outer) / (kIndexOfWater * kIndexOfWater);
        const auto through = [&](double reach) { return glm::pow(albedo_, dvec3(reach / floor_.depth)); };
        irradiance_ = kPi * hemisphereMean(light) * (1 - outer) * through(floor_.depth);
        const dvec3 sun = directionAt(lighting_.keyAzimuth, lighting_.keyElevation);
        const double down = std::cos(std::asin(std::sin(std::acos(sun.y)) / kIndexOfWater));
        irradiance_ += lighting_.keyStrength * dvec3(lighting_.keyColor) * sun.y * (1 - reflectance(std::acos(sun.y))) *
                       through(floor_.depth / down);
    }

    struct Hit {
        bool isOnWater = false;
        dvec3 normal{0}, incoming{0}, inside{0}; ///< unit
        dvec2 floorAt{0};
        double reach = 0;
    };
    /// Where a ray meets the waves, and goes on to the floor.
    [[nodiscard]] Hit trace(const dvec3& eye, const dvec3& ray) const {
        const auto over = [&](double t) {
            const dvec3 p = eye + t * ray;
            return p.y - rippleAt(p.x, p.z);
        };
        double low = (0.07 - eye.y) / ray.y, high = low;
        for (int step = 0; step < 400 && over(high) > 0; ++step) low = high, high += 0.15 / 400 / -ray.y;
        for (int i = 0; i < 60; ++i) (over(0.5 * (low + high)) > 0 ? low : high) = 0.5 * (low + high);
        const dvec3 p = eye + low * ray;
        Hit hit{.isOnWater = std::max(std::abs(p.x), std::abs(p.z)) < 0.98,
                .normal = rippleNormalAt(p.x, p.z),
                .incoming = ray};
        // Snell: what of the ray is along the surface shrinks by the index.
        const dvec3 along = (ray - glm::dot(ray, hit.normal) * hit.normal) / kIndexOfWater;
        hit.inside = along - std::sqrt(1 - glm::dot(along, along)) * hit.normal;
        hit.reach = (p.y - floor_.height) / -hit.inside.y;
        hit.floorAt = {p.x + hit.reach * hit.inside.x, p.z + hit.reach * hit.inside.z};
        return hit;
    }
    [[nodiscard]] bool isOnDarkTile(const dvec2& at) const {
        return (int(std::floor(at.x / floor_.tile)) + int(std::floor(at.y / floor_.tile))) % 2 != 0;
    }
    [[nodiscard]] dvec3 shade(const Hit& hit, bool isDark) const {
        dvec3 mirrored = hit.incoming - 2 * glm::dot(hit.incoming, hit.normal) * hit.normal;
        mirrored.y = std::abs(mirrored.y);
        const double reflected = reflectance(std::acos(-glm::dot(hit.incoming, hit.normal)));
        // The floor sees its own light again in the surface: a geometric series.
        const dvec3 color = dvec3(floor_.color) * (isDark ? 0.5 : 1.0);
        dvec3 radiance(0), share = color / kPi;
        for (int bounce = 0; bounce < 40; ++bounce)
            radiance += share * irradiance_, share *= innerReflectance_ * color * albedo_ * albedo_;
        const dvec3 transmitted =
            radiance * glm::pow(albedo_, dvec3(hit.reach / floor_.depth)) / (kIndexOfWater * kIndexOfWater);
        return reflected * light_(mirrored) + (1 - reflected) * transmitted;
    }

private:
    WaterFloor floor_;
    dvec3 albedo_;
    Light light_;
    Lighting lighting_;
    double innerReflectance_ = 0;
    dvec3 irradiance_{0};
};

dvec3 rayThrough(const Camera& camera, double x, double y) {
    const dvec3 back = glm::normalize(camera.eye - camera.target),
                right = glm::normalize(glm::cross(dvec3(0, 1, 0), back)), up = glm::cross(back, right);
    const double tangent = std::tan(glm::radians(camera.fieldOfView) / 2);
    return glm::normalize((2 * x / kWaterPixels - 1) * tangent * right - (2 * y / kWaterPixels - 1) * tangent * up -
                          back);
}

// The floor through waves, with its tiles, the mirrored sky and both of their weights, pixel by pixel. The sun is
// behind the eye: no wave mirrors it.
TEST_F(WaterOnDevice, isWhatRaysInDoubleSee) {
    WaterScene scene(kRipples, smoothLight);
    scene.options.lighting.keyAzimuth = 20, scene.options.lighting.keyElevation = 62;
    const WaterReference reference(scene, smoothLight);
    const Camera& camera = scene.options.camera;
    for (const relief::Raster raster : {relief::Raster::hardware, relief::Raster::compute}) {
        if (raster == relief::Raster::compute && !device().traits().hasLongAtomics) break;
        scene.options.raster = raster;
        const Image image = scene.draw();
        int count = 0, darkCount = 0, borderCount = 0, wrong = 0, wrongAtBorders = 0;
        double sum = 0;
        for (int y = 1; y < kWaterPixels - 1; ++y)
            for (int x = 1; x < kWaterPixels - 1; ++x) {
                const auto hit = reference.trace(camera.eye, rayThrough(camera, x + 0.5, y + 0.5));
                if (!hit.isOnWater || image.at(x, y)[3] < 1) continue;
                // Where a pixel sees a border between tiles its light lies between theirs.
                const bool isDark = reference.isOnDarkTile(hit.floorAt);
                bool isBorder = false;
                for (int k = 0; k < 9; ++k) {
                    const auto beside =
                        reference.trace(camera.eye, rayThrough(camera, x + k % 3 - 0.5, y + k / 3 - 0.5));
                    isBorder = isBorder || reference.isOnDarkTile(beside.floorAt) != isDark;
                }
                const dvec3 expected = reference.shade(hit, isDark), other = reference.shade(hit, !isDark);
                double error = 0, outside = 0;
                for (int c = 0; c < 3; ++c) {
                    const double seen = image.at(x, y)[c], low = std::min(expected[c], other[c]),
                                 high = std::max(expected[c], other[c]);
                    error = std::max(error, std::abs(seen / expected[c] - 1));
                    outside = std::max({outside, low / seen - 1, seen / high - 1});
                }
                if (isBorder) {
                    ++borderCount, wrongAtBorders += outside > 0.02;
                } else {
                    ++count, darkCount += isDark, wrong += error > 0.02, sum += error;
                }
            }
        EXPECT_GT(count, 4000);
        EXPECT_GT(std::min(darkCount, count - darkCount), count / 4);
        EXPECT_GT(borderCount, 500);
        EXPECT_LE(wrong, count / 100) << int(raster);
        EXPECT_LE(wrongAtBorders, borderCount / 50) << int(raster);
        EXPECT_LT(sum / count, 0.006) << int(raster); // albedos are codes of 10 bits, normals of 16
    }
}

// With a floor that absorbs nothing, level water in even light cannot be seen: what it does not mirror comes back from
// below.
TEST_F(WaterOnDevice, losesNoLight) {
    WaterScene scene("0.0", [](const dvec3&) { return dvec3(1); });
    scene.options.lighting.keyStrength = 0;
    scene.material.albedo = vec3(1);
    scene.options.waterFloor.color = vec3(1);
    scene.options.waterFloor.tile = 0;
    for (const double elevation : {80.0, 38.0, 8.0}) {
        scene.options.camera.eye = scene.options.camera.target + 3.0 * directionAt(20, elevation);
        const Image image = scene.draw();
        int count = 0;
        for (std::size_t i = 0; i < image.texels.size(); i += 4)
            for (std::size_t c = 0; c < 3 && image.texels[i + 3] == 1; ++c, ++count)
                ASSERT_NEAR(image.texels[i + c], 1, 0.02) << elevation;
        EXPECT_GT(count, 3000) << elevation;
    }
}

// A further light adds what it adds as the key light: its light on the floor, and its picture on the waves.
TEST_F(WaterOnDevice, isLitByAllLights) {
    WaterScene scene(kRipples, smoothLight);
    Lighting& lighting = scene.options.lighting;
    const DistantLight lamp{.azimuth = 195, .elevation = 45, .strength = 1.5, .color = {1, 0.5f, 0.2f}};
    const Image key = scene.draw();
    lighting.others = {lamp};
    const Image both = scene.draw();
    lighting.others.clear();
    lighting.keyStrength = 0;
    const Image dark = scene.draw();
    lighting.keyAzimuth = lamp.azimuth, lighting.keyElevation = lamp.elevation;
    lighting.keyStrength = lamp.strength, lighting.keyColor = lamp.color;
    const Image lampAlone = scene.draw();
    float most = 0, added = 0;
    for (std::size_t i = 0; i < both.texels.size(); ++i) {
        if (i % 4 == 3) continue;
        const float expected = key.texels[i] + lampAlone.texels[i] - dark.texels[i];
        most = std::max(most, std::abs(both.texels[i] - expected) / std::max(expected, 0.1f));
        added = std::max(added, lampAlone.texels[i] - dark.texels[i]);
    }
    EXPECT_LT(most, 0.004f); // four halves, 2^-11 each
    EXPECT_GT(added, 5.0f) << "the lamp is seen in the waves";
}

} // namespace
} // namespace relief::test
