#include <algorithm>
#include <limits>

#include "scene/loading.h"
#include "scene/scene.h"

namespace relief {
namespace {

double aspectOf(const ivec2& size) { return double(size.x) / size.y; }

} // namespace

CameraOptions toLocal(const Coordinates& coordinates, const CameraOptions& world) {
    CameraOptions local = world;
    if (local.distance) *local.distance /= coordinates.unit;
    if (local.lookAt) local.lookAt = coordinates.toLocal(*local.lookAt);
    return local;
}

Camera makeCamera(const SceneDesc& scene, const Coordinates& coordinates, std::span<const dvec3> points) {
    return frameCamera(points, toLocal(coordinates, scene.camera), aspectOf(scene.size));
}

CameraOptions holdAllPoints(const CameraOptions& options, std::span<const dvec3> points, double aspect, bool isTurn) {
    constexpr int kSides = 24;
    // A turn goes around one point. From one side, the target is wherever it centres the picture.
    CameraOptions side = options;
    if (isTurn && !side.lookAt) side.lookAt = computeBounds(points).center();
    // The distance that suffices from the side that needs the largest one.
    double farthest = 0;
    Camera camera;
    for (int i = 0; i < (isTurn ? kSides : 1); ++i) {
        side.azimuth = options.azimuth + 360.0 * i / kSides;
        camera = frameCamera(points, side, aspect);
        farthest = std::max(farthest, glm::length(camera.eye - camera.target));
    }
    CameraOptions held = options;
    held.lookAt = camera.target;
    held.distance = farthest;
    return held;
}

Camera placeCamera(const CameraOptions& options, const Bounds& bounds) {
    RELIEF_CHECK(options.lookAt.has_value() == true);
    RELIEF_CHECK(options.distance.has_value() == true);
    Camera camera;
    camera.target = *options.lookAt;
    camera.eye = camera.target + directionAt(options.azimuth, options.elevation) * *options.distance;
    camera.fieldOfView = options.fieldOfView;
    fitDepth(camera, bounds);
    return camera;
}

Lighting makeLighting(const LightingDesc& desc, double azimuth, const GpuEnvironment* environment) {
    // The defaults are those of the library's camera and light: so far apart they stay, wherever the camera is.
    Lighting lighting;
    lighting.keyAzimuth = azimuth + (Lighting().keyAzimuth - CameraOptions().azimuth);
    if (desc.key) lighting.keyAzimuth = desc.key->x, lighting.keyElevation = desc.key->y;
    lighting.keyStrength = desc.keyStrength.value_or(lighting.keyStrength);
    lighting.keyColor = desc.keyColor.value_or(lighting.keyColor);
    lighting.others = desc.others;
    lighting.occlusionRadius = desc.occlusionRadius;
    lighting.castsShadows = desc.castsShadows;
    lighting.environmentAzimuth = desc.environmentAzimuth;
    lighting.environment = environment;
    return lighting;
}

std::optional<GpuEnvironment> makeEnvironment(Device& device, const LoadedScene& loaded) {
    if (!loaded.environment) return {};
    return uploadEnvironment(device, *loaded.environment);
}

std::optional<GpuMatcap> makeMatcap(Device& device, const LoadedScene& loaded) {
    if (!loaded.matcap) return {};
    return uploadMatcap(device, *loaded.matcap);
}

WaterFloor makeWaterFloor(const WaterFloor& desc, const LoadedObject& object) {
    const double unit = object.coordinates().unit;
    double lowest = std::numeric_limits<double>::max();
    for (const vec3& p : object.cage.positions) lowest = std::min(lowest, double(p.y));
    WaterFloor floor = desc;
    floor.depth /= unit;
    floor.tile /= unit;
    // What the device computes with single precision.
    const auto isUsable = [](double length) { return length > 1e-6 && length < 1e6; };
    if (!isUsable(floor.depth) || (floor.tile != 0 && !isUsable(floor.tile)))
        fail(Failure::usage,
             "--water-floor: {} and tiles of {} are not between a millionth and a million times the object's size",
             desc.depth, desc.tile);
    floor.height = lowest - floor.depth;
    return floor;
}

Material makeMaterial(const MaterialDesc& desc, const std::optional<vec3>& textureColor) {
    Material material;
    if (!desc.albedo.empty()) material.albedo = vec3(1);
    if (textureColor) material.albedo = *textureColor;
    if (desc.color) material.albedo = *desc.color;
    material.roughness = desc.roughness;
    if (desc.conservesEnergy()) material.metallic = desc.metallic.value_or(0);
    return material;
}

} // namespace relief
