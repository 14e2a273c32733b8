// Which direction a point of a picture shows, and what a picture shows in a direction.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "light/light.h"

namespace relief {
namespace {

constexpr double kPi = std::numbers::pi;

/// A face in the world: its middle, and where its picture goes to the right and down from there.
struct CubeFace {
    dvec3 forward, right, down;
};

/// Vulkan's table of (s_c, t_c, m_a) with z turned around (see EnvironmentPicture).
constexpr CubeFace kFaces[kCubeFaces] = {
    {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}, {{-1, 0, 0}, {0, 0, -1}, {0, -1, 0}}, {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}},
    {{0, -1, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 0, -1}, {1, 0, 0}, {0, -1, 0}},  {{0, 0, 1}, {-1, 0, 0}, {0, -1, 0}},
};

dvec3 directionInEquirect(const dvec2& at) {
    const double phi = (at.x - 0.5) * 2 * kPi, theta = at.y * kPi;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

dvec3 directionInCube(int face, const dvec2& at) {
    const CubeFace& f = kFaces[face];
    return glm::normalize(f.forward + (2 * at.x - 1) * f.right + (2 * at.y - 1) * f.down);
}

/// r = 2 (n.v) n - v of the ball's normal n = (x, y, z), with v = +Z (Hart, eq. 16.14 to 16.18).
dvec3 directionInSphere(const dvec2& at) {
    const double x = 2 * at.x - 1, y = 1 - 2 * at.y, z2 = 1 - x * x - y * y;
    if (z2 <= 0) return {0, 0, -1};
    const double z = std::sqrt(z2);
    return {2 * x * z, 2 * y * z, 2 * z2 - 1};
}

PicturePoint pointOfCube(const dvec3& d) {
    int best = 0;
    for (int face = 1; face < kCubeFaces; ++face)
        if (glm::dot(d, kFaces[face].forward) > glm::dot(d, kFaces[best].forward)) best = face;
    const CubeFace& f = kFaces[best];
    const double depth = glm::dot(d, f.forward);
    return {best, {0.5 + 0.5 * glm::dot(d, f.right) / depth, 0.5 + 0.5 * glm::dot(d, f.down) / depth}};
}

PicturePoint pointOfSphere(const dvec3& d) {
    const dvec3 n = d / glm::length(d) + dvec3(0, 0, 1);
    const double length = glm::length(n);
    if (length < 1e-12) return {0, {1, 0.5}}; // all of the rim shows -Z
    return {0, {0.5 + 0.5 * n.x / length, 0.5 - 0.5 * n.y / length}};
}

dvec3 texelAt(const Image& image, int x, int y) {
    const float* c = image.at(x, y);
    return {c[0], c[1], c[2]};
}

/// A texel of a picture, also one beside the image: the texel of the same picture that lies there.
dvec3 texelBeside(const EnvironmentPicture& picture, int number, int x, int y) {
    const Image& image = picture.images[std::size_t(number)];
    const int w = image.width, h = image.height;
    if (x >= 0 && y >= 0 && x < w && y < h) return texelAt(image, x, y);
    switch (picture.shape) {
    case EnvironmentShape::equirect: // over the pole, and around
        if (y < 0 || y >= h) y = y < 0 ? -1 - y : 2 * h - 1 - y, x += w / 2;
        return texelAt(image, (x % w + w) % w, y);
    case EnvironmentShape::cube: {
        const PicturePoint there =
            pointOf(picture.shape, directionOf(picture.shape, {number, {(x + 0.5) / w, (y + 0.5) / h}}));
        const auto nearest = [&](double at) { return std::clamp(int(at * w), 0, w - 1); };
        return texelAt(picture.images[std::size_t(there.image)], nearest(there.at.x), nearest(there.at.y));
    }
    case EnvironmentShape::sphere: break;
    }
    return texelAt(image, std::clamp(x, 0, w - 1), std::clamp(y, 0, h - 1));
}

} // namespace

dvec3 directionOf(EnvironmentShape shape, const PicturePoint& point) {
    switch (shape) {
    case EnvironmentShape::equirect: return directionInEquirect(point.at);
    case EnvironmentShape::cube: return directionInCube(point.image, point.at);
    case EnvironmentShape::sphere: break;
    }
    return directionInSphere(point.at);
}

PicturePoint pointOf(EnvironmentShape shape, const dvec3& d) {
    if (shape == EnvironmentShape::cube) return pointOfCube(d);
    if (shape == EnvironmentShape::sphere) return pointOfSphere(d);
    return {0, {std::atan2(d.x, -d.z) / (2 * kPi) + 0.5, std::acos(std::clamp(d.y / glm::length(d), -1.0, 1.0)) / kPi}};
}

dvec3 lookUp(const EnvironmentPicture& picture, const dvec3& direction) {
    const PicturePoint point = pointOf(picture.shape, direction);
    const Image& image = picture.images[std::size_t(point.image)];
    const dvec2 at = point.at * dvec2(image.width, image.height) - 0.5, low = glm::floor(at), part = at - low;
    const auto texel = [&](int i, int j) { return texelBeside(picture, point.image, int(low.x) + i, int(low.y) + j); };
    return glm::mix(glm::mix(texel(0, 0), texel(1, 0), part.x), glm::mix(texel(0, 1), texel(1, 1), part.x), part.y);
}

void fillRing(Image& sphere) {
    const int side = sphere.width;
    const Image source = sphere;
    // A texel reaches 1.42 / side from its centre, the radius of the ball being 1: those farther out than `outermost`
    // are not wholly in the ball. What replaces them lies between the nearest texels inside, on this side of the ball
    // and on the other one: past the rim, which shows -Z all around, directions go on there.
    const double outermost = 1 - 1.42 / side, inside = std::max(0.0, 1 - 3.0 / side);
    const auto texelAtRadius = [&](const dvec2& direction, double radius) {
        const dvec2 from = (direction * radius + 1.0) * 0.5 * double(side);
        return texelAt(source, std::clamp(int(from.x), 0, side - 1), std::clamp(int(from.y), 0, side - 1));
    };
    const auto angleTo = [](double radius) { return kPi - 2 * std::asin(std::min(radius, 1.0)); }; // from -Z
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const dvec2 at = (dvec2(x, y) + 0.5) * 2.0 / double(side) - 1.0;
            const double radius = glm::length(at);
            if (radius <= outermost) continue;
            const double angle = radius <= 1 ? angleTo(radius) : -angleTo(std::max(2 - radius, inside));
            const double other = 0.5 - 0.5 * angle / angleTo(inside);
            const dvec3 c = glm::mix(texelAtRadius(at / radius, inside), texelAtRadius(at / -radius, inside), other);
            for (int i = 0; i < 3; ++i) sphere.at(x, y)[i] = float(c[i]);
        }
}

} // namespace relief
