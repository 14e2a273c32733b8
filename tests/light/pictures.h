// Environments for tests: an analytic one, and one whose faces are labelled. Directions are written here a second time,
// from the tables of Vulkan and Hart, not by the module's own code.
#pragma once

#include <cmath>
#include <functional>
#include <random>

#include "light/light.h"

namespace relief::test {

using Light = std::function<dvec3(const dvec3&)>;

/// Smooth light without symmetries, at least 0.
inline dvec3 smoothLight(const dvec3& d) {
    return {1 + 0.5 * d.x + 0.3 * d.y * d.z, 1.2 + 0.4 * d.y - 0.5 * d.x * d.z, 0.9 - 0.6 * d.z * d.z + 0.2 * d.y};
}

/// Vulkan 1.3, "Cube Map Face Selection": s_c, t_c and m_a of (x, y, z), which is the world's (x, y, -z).
inline dvec3 cubeDirection(int face, double s, double t) {
    const double sc = 2 * s - 1, tc = 2 * t - 1;
    dvec3 r;
    switch (face) {
    case 0: r = {1, -tc, -sc}; break;
    case 1: r = {-1, -tc, sc}; break;
    case 2: r = {sc, 1, tc}; break;
    case 3: r = {sc, -1, -tc}; break;
    case 4: r = {sc, -tc, 1}; break;
    default: r = {-sc, -tc, -1}; break;
    }
    return glm::normalize(dvec3(r.x, r.y, -r.z));
}

inline dvec3 equirectDirection(double s, double t) {
    const double longitude = 2 * M_PI * (s - 0.5), latitude = M_PI * (0.5 - t);
    return {std::cos(latitude) * std::sin(longitude), std::sin(latitude), -std::cos(latitude) * std::cos(longitude)};
}

/// Hart, eq. 16.14 to 16.18, with t upwards.
inline dvec3 sphereDirection(double s, double t) {
    const double x = 2 * s - 1, y = 2 * (1 - t) - 1, z = std::sqrt(std::max(0.0, 1 - x * x - y * y));
    return {2 * x * z, 2 * y * z, 2 * z * z - 1};
}

inline Image drawImage(int width, int height, const std::function<dvec3(double, double)>& color) {
    Image image{width, height, 3, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const dvec3 c = color((x + 0.5) / width, (y + 0.5) / height);
            image.texels.insert(image.texels.end(), {float(c.x), float(c.y), float(c.z)});
        }
    return image;
}

/// The light as a picture of one texel per centre.
inline EnvironmentPicture drawPicture(EnvironmentShape shape, int side, const Light& light) {
    EnvironmentPicture picture{.shape = shape, .images = {}};
    if (shape == EnvironmentShape::equirect)
        picture.images = {
            drawImage(2 * side, side, [&](double s, double t) { return light(equirectDirection(s, t)); })};
    if (shape == EnvironmentShape::sphere)
        picture.images = {drawImage(side, side, [&](double s, double t) {
            return std::hypot(2 * s - 1, 2 * t - 1) < 1 ? light(sphereDirection(s, t)) : dvec3(0);
        })};
    if (shape == EnvironmentShape::cube)
        for (int face = 0; face < 6; ++face)
            picture.images.push_back(
                drawImage(side, side, [&](double s, double t) { return light(cubeDirection(face, s, t)); }));
    return picture;
}

/// Colors of the faces px nx py ny pz nz: red, cyan, green, magenta, blue, yellow.
inline constexpr float kFaceColors[6][3] = {{0.8f, 0.1f, 0.1f}, {0.1f, 0.7f, 0.7f}, {0.1f, 0.7f, 0.1f},
                                            {0.7f, 0.1f, 0.7f}, {0.1f, 0.1f, 0.8f}, {0.8f, 0.7f, 0.1f}};

/// A cube of six colors, each with a black arrow to the top of the face and a white square at its right edge.
inline EnvironmentPicture labelledCube(int side) {
    EnvironmentPicture cube{.shape = EnvironmentShape::cube, .images = {}};
    for (const auto& color : kFaceColors)
        cube.images.push_back(drawImage(side, side, [&](double s, double t) {
            const bool isShaft = std::abs(s - 0.5) < 0.06 && t > 0.35 && t < 0.8;
            const bool isHead = t > 0.12 && t < 0.38 && std::abs(s - 0.5) < 0.8 * (t - 0.12);
            if (isShaft || isHead) return dvec3(0);
            if (s > 0.8 && s < 0.94 && std::abs(t - 0.5) < 0.07) return dvec3(1);
            return dvec3(color[0], color[1], color[2]);
        }));
    return cube;
}

inline std::vector<dvec3> randomDirections(int count) {
    std::mt19937 random(7);
    std::normal_distribution<double> normal;
    std::vector<dvec3> all;
    for (int i = 0; i < count; ++i)
        all.push_back(glm::normalize(dvec3(normal(random), normal(random), normal(random))));
    return all;
}

} // namespace relief::test
