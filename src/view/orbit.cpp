#include "view/orbit.h"

#include <algorithm>
#include <cmath>

#include <glm/trigonometric.hpp>

namespace relief {
namespace {

constexpr double kDegreesPerPixel = 0.5;

struct Axes {
    dvec3 right, up, back;
};

Axes axesOf(const Orbit& orbit) {
    const dvec3 back = directionAt(orbit.azimuth, orbit.elevation), right = directionAt(orbit.azimuth + 90, 0);
    return {right, glm::cross(back, right), back};
}

/// Cage units per pixel in the plane of the target.
double pixelSide(const Orbit& orbit, int height) {
    return 2 * orbit.distance * std::tan(glm::radians(orbit.fieldOfView) / 2) / height;
}

} // namespace

Orbit makeOrbit(const CameraOptions& options, const Camera& placed, const Coordinates& coordinates) {
    Orbit orbit{.azimuth = options.azimuth, .elevation = options.elevation, .fieldOfView = options.fieldOfView};
    orbit.target = options.lookAt.value_or(coordinates.toWorld(placed.target));
    orbit.distance = options.distance.value_or(glm::length(placed.eye - placed.target) * coordinates.unit);
    return orbit;
}

CameraOptions toOptions(const Orbit& orbit) {
    return {.azimuth = orbit.azimuth,
            .elevation = orbit.elevation,
            .fieldOfView = orbit.fieldOfView,
            .distance = orbit.distance,
            .lookAt = orbit.target};
}

Orbit turn(Orbit orbit, const dvec2& pixels) {
    orbit.azimuth = std::remainder(orbit.azimuth - kDegreesPerPixel * pixels.x, 360);
    orbit.elevation = std::clamp(orbit.elevation + kDegreesPerPixel * pixels.y, -90.0, 90.0);
    return orbit;
}

Orbit pan(Orbit orbit, const dvec2& pixels, int height) {
    const Axes axes = axesOf(orbit);
    orbit.target += (axes.up * pixels.y - axes.right * pixels.x) * pixelSide(orbit, height);
    return orbit;
}

Orbit zoom(Orbit orbit, double factor, const dvec2& cursor, const ivec2& size) {
    const dvec2 fromCenter = cursor - 0.5 * dvec2(size);
    const double before = orbit.distance;
    orbit.distance = std::clamp(before * factor, kSmallestSide, kFarthestCoordinate);
    // What is below the cursor lies that many pixels aside before and after.
    return pan(orbit, fromCenter * (1 - before / orbit.distance), size.y);
}

Orbit widen(Orbit orbit, double fieldOfView) {
    const double before = std::tan(glm::radians(orbit.fieldOfView) / 2);
    orbit.distance *= before / std::tan(glm::radians(fieldOfView) / 2);
    orbit.fieldOfView = fieldOfView;
    return orbit;
}

std::optional<dvec2> toPixel(const Camera& camera, const dvec3& point, const ivec2& size) {
    const dvec3 back = glm::normalize(camera.eye - camera.target);
    const dvec3 helper = std::abs(back.y) > 0.9999 ? dvec3(0, 0, back.y > 0 ? -1 : 1) : dvec3(0, 1, 0);
    const dvec3 right = glm::normalize(glm::cross(helper, back)), up = glm::cross(back, right);
    const dvec3 from = point - camera.eye;
    const double depth = -glm::dot(from, back);
    if (!(depth > camera.nearDistance)) return {};
    const double scale = size.y / (2 * std::tan(glm::radians(camera.fieldOfView) / 2) * depth);
    return 0.5 * dvec2(size) + scale * dvec2(glm::dot(from, right), -glm::dot(from, up));
}

} // namespace relief
