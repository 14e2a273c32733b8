#include <algorithm>
#include <cmath>

#include <glm/trigonometric.hpp>

#include "frame/passes.h"

namespace relief {

View viewOf(const Camera& camera, int height) {
    return {.eye = vec3(camera.eye),
            .nearDistance = float(camera.nearDistance),
            .pixelsAtUnitDistance = float(height / (2 * std::tan(glm::radians(camera.fieldOfView) / 2)))};
}

dvec3 directionAt(double azimuth, double elevation) {
    const double a = glm::radians(azimuth), e = glm::radians(elevation);
    return {std::cos(e) * std::sin(a), std::sin(e), std::cos(e) * std::cos(a)};
}

ReferenceSurface makeCoarseSurface(const Cage& cage, Scheme scheme) {
    // Patches that only approximate the surface are near enough, and cost less to evaluate.
    return {cage, {.scheme = scheme, .isolation = 2, .endCaps = EndCapKind::gregory}};
}

std::vector<dvec3> outline(const ReferenceSurface& surface, const HeightMap* map, double bound) {
    // A triangle's far half lies outside its domain: fold it back.
    const auto inDomain = [&](dvec2 uv) {
        return surface.sideCount() == 3 && uv.x + uv.y > 1 ? dvec2(1 - uv.x, 1 - uv.y) : uv;
    };
    constexpr int kSteps = 4;
    std::vector<dvec3> points;
    for (int face = 0; face < surface.faceCount(); ++face) {
        if (surface.isHole(face)) continue;
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; j <= kSteps; ++j) {
                const DisplacedFrame frame = displacedFrame(surface, map, face, inDomain(dvec2(i, j) / double(kSteps)));
                points.push_back(bound > 0 ? frame.q + bound * frame.normal : frame.q);
                if (bound > 0) points.push_back(frame.q - bound * frame.normal);
            }
    }
    return points;
}

Camera frameCamera(std::span<const dvec3> points, const CameraOptions& options, double aspect) {
    Bounds bounds = computeBounds(points);
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
    fitDepth(camera, bounds);
    return camera;
}

void fitDepth(Camera& camera, const Bounds& bounds) {
    const double size = std::max(bounds.diagonal(), 1e-6), toCenter = glm::length(camera.eye - bounds.center());
    camera.nearDistance = std::max(toCenter - 1.25 * size, 1e-3 * size); // room for boxes around it
    camera.farDistance = toCenter + size;
}

mat4 perspectiveMatrix(const Camera& camera, double aspect) {
    const dvec3 back = glm::normalize(camera.eye - camera.target);
    const dvec3 helper = std::abs(back.y) > 0.9999 ? dvec3(0, 0, back.y > 0 ? -1 : 1) : dvec3(0, 1, 0);
    const dvec3 right = glm::normalize(glm::cross(helper, back)), up = glm::cross(back, right);
    const double f = 1 / std::tan(glm::radians(camera.fieldOfView) / 2);
    const double n = camera.nearDistance, k = n / (camera.farDistance - n);
    const dvec3 rows[4] = {right * (f / aspect), up * -f, back * k, -back};
    const double offsets[4] = {0, 0, n * (k + 1), 0};
    mat4 m;
    for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 3; ++c) m[c][r] = float(rows[r][c]);
        m[3][r] = float(offsets[r] - glm::dot(rows[r], camera.eye));
    }
    return m;
}

mat4 shadowMatrix(const dvec3& towardsLight, const Bounds& bounds) {
    const dvec3 helper = std::abs(towardsLight.y) > 0.99 ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 right = glm::normalize(glm::cross(helper, towardsLight)), up = glm::cross(towardsLight, right);
    const double radius = std::max(0.52 * bounds.diagonal(), 1e-9);
    const dvec3 rows[3] = {right / radius, up / radius, towardsLight * (0.5 / radius)};
    mat4 m(1);
    for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 3; ++c) m[c][r] = float(rows[r][c]);
        m[3][r] = float((r == 2 ? 0.5 : 0.0) - glm::dot(rows[r], bounds.center()));
    }
    return m;
}

} // namespace relief
