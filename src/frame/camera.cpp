#include <algorithm>
#include <cmath>

#include <glm/trigonometric.hpp>

#include "frame/frame.h"

namespace relief {

dvec3 directionAt(double azimuth, double elevation) {
    const double a = glm::radians(azimuth), e = glm::radians(elevation);
    return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

std::vector<dvec3> outline(const ReferenceSurface& surface, const HeightMap* map) {
    // A triangle's far half lies outside its domain: fold it back.
    const auto inDomain = [&](dvec2 uv) {
        return surface.sideCount() == 3 && uv.x + uv.y > 1 ? dvec2(1 - uv.x, 1 - uv.y) : uv;
    };
    constexpr int kSteps = 4;
    std::vector<dvec3> points;
    for (int face = 0; face < surface.faceCount(); ++face) {
        if (surface.isHole(face)) continue;
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; j <= kSteps; ++j)
                points.push_back(displacedFrame(surface, map, face, inDomain(dvec2(i, j) / double(kSteps))).q);
    }
    return points;
}

Camera frameCamera(std::span<const dvec3> points, const CameraOptions& options, double aspect) {
    Bounds bounds;
    for (const dvec3& p : points) bounds.add(p);
    if (bounds.isEmpty()) bounds.add(dvec3(0));
    const double size = std::max(bounds.diagonal(), 1e-6);

    const dvec3 back = directionAt(options.azimuth, options.elevation);
    const dvec3 right = directionAt(options.azimuth + 90, 0);
    const dvec3 up = glm::cross(back, right);
    constexpr double kMargin = 1.06;
    const double tanY = std::tan(glm::radians(options.fieldOfView) / 2) / kMargin, tanX = tanY * aspect;

    // Each point p at height y over the axis is inside the frame when distance >= |y| / tan + depth towards the camera;
    // sliding the target to the middle of both constraints centres the picture.
    dvec3 target = options.lookAt.value_or(bounds.center());
    double distance = 0;
    for (int round = 0; round < (options.lookAt ? 1 : 3); ++round) {
        double left = -1e300, rightmost = -1e300, below = -1e300, above = -1e300;
        for (const dvec3& p : points) {
            const dvec3 d = p - target;
            const double x = glm::dot(d, right), y = glm::dot(d, up), z = glm::dot(d, back);
            left = std::max(left, -x / tanX + z), rightmost = std::max(rightmost, x / tanX + z);
            below = std::max(below, -y / tanY + z), above = std::max(above, y / tanY + z);
        }
        distance = std::max({left, rightmost, below, above, 1e-3 * size});
        if (!options.lookAt) target += right * (0.5 * (rightmost - left) * tanX) + up * (0.5 * (above - below) * tanY);
    }
    distance = options.distance.value_or(distance);

    Camera camera;
    camera.target = target;
    camera.eye = target + back * distance;
    camera.fieldOfView = options.fieldOfView;
    const double toCenter = glm::length(camera.eye - bounds.center());
    camera.nearDistance = std::max(toCenter - size, 1e-3 * size);
    camera.farDistance = toCenter + size;
    return camera;
}

} // namespace relief
