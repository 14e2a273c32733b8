#include <algorithm>
#include <cmath>
#include <numbers>

#include "frame/frame.h"

namespace relief {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kStudioHeight = 64;
constexpr int kLargestHeight = 512; // of a user's environment; sharper reflections do not show on a dielectric
constexpr float kMostRadiance = 1e12f;
constexpr int kFilteredHeight = 16; // levels of this size and below are convolved, larger ones averaged

/// Direction of the centre of texel (x,y); the inverse of equirectangular() in light.comp.
dvec3 texelDirection(const Image& image, int x, int y) {
    const double phi = ((x + 0.5) / image.width - 0.5) * 2 * kPi, theta = (y + 0.5) / image.height * kPi;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

double texelSolidAngle(const Image& image, int y) {
    return 2 * kPi / image.width * (std::cos(y * kPi / image.height) - std::cos((y + 1) * kPi / image.height));
}

vec3 rgb(const Image& image, int x, int y) {
    const float* c = image.at(x, y);
    return {c[0], c[1], c[2]};
}

Image blank(int width, int height) { return {width, height, 3, std::vector<float>(std::size_t(width) * height * 3)}; }

void set(Image& image, int x, int y, const dvec3& c) {
    for (int i = 0; i < 3; ++i) image.at(x, y)[i] = float(c[i]);
}

Image halved(const Image& from) {
    Image to = blank(std::max(1, from.width / 2), std::max(1, from.height / 2));
    for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x) {
            dvec3 sum(0);
            for (int k = 0; k < 4; ++k)
                sum +=
                    dvec3(rgb(from, std::min(2 * x + k % 2, from.width - 1), std::min(2 * y + k / 2, from.height - 1)));
            set(to, x, y, sum / 4.0);
        }
    return to;
}

/// `source` seen by a GGX lobe of this roughness around every direction of a picture of the given size.
Image convolved(const Image& source, int width, int height, double roughness) {
    const double a2 = std::pow(roughness, 4);
    std::vector<dvec3> directions; // of all texels of the source
    for (int j = 0; j < source.height; ++j)
        for (int i = 0; i < source.width; ++i) directions.push_back(texelDirection(source, i, j));
    // Every texel is the mean of the source, weighted by the lobe around its direction with view and normal along it.
    Image to = blank(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const dvec3 n = texelDirection(to, x, y);
            dvec3 sum(0);
            double weights = 0;
            for (int j = 0; j < source.height; ++j) {
                const double solidAngle = texelSolidAngle(source, j);
                for (int i = 0; i < source.width; ++i) {
                    const double nl =
                        glm::dot(n, directions[std::size_t(j) * std::size_t(source.width) + std::size_t(i)]);
                    if (nl <= 0) continue;
                    const double nh2 = 0.5 + 0.5 * nl; // h is half way between n = v and l
                    const double d = nh2 * (a2 - 1) + 1;
                    const double weight = a2 / (d * d) * nl * solidAngle;
                    sum += weight * dvec3(rgb(source, i, j));
                    weights += weight;
                }
            }
            set(to, x, y, sum / weights);
        }
    return to;
}

/// Ramamoorthi and Hanrahan (2001): coefficients of the real spherical harmonics to order 2, times the cosine lobe's
/// (pi, 2 pi/3, pi/4), times the basis constants, so that light.comp adds plain polynomials of the normal.
void project(const Image& image, vec3 irradiance[9]) {
    dvec3 sums[9] = {};
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const dvec3 d = texelDirection(image, x, y);
            const dvec3 light = dvec3(rgb(image, x, y)) * texelSolidAngle(image, y);
            const double basis[9] = {
                1, d.y, d.z, d.x, d.x * d.y, d.y * d.z, 3 * d.z * d.z - 1, d.x * d.z, d.x * d.x - d.y * d.y};
            for (int k = 0; k < 9; ++k) sums[k] += basis[k] * light;
        }
    constexpr double kBasis[9] = {0.282095, 0.488603, 0.488603, 0.488603, 1.092548,
                                  1.092548, 0.315392, 1.092548, 0.546274};
    for (int k = 0; k < 9; ++k) {
        const double lobe = k == 0 ? kPi : k < 4 ? 2 * kPi / 3 : kPi / 4;
        irradiance[k] = vec3(sums[k] * (kBasis[k] * kBasis[k] * lobe));
    }
}

Environment prepare(Image base) {
    while (base.height > kLargestHeight) base = halved(base);
    Environment environment;
    environment.levels.push_back(std::move(base));
    while (environment.levels.back().height > 4) environment.levels.push_back(halved(environment.levels.back()));
    // Level sizes halve, roughness grows evenly from 0 at the first to 1 at the last.
    const auto last = double(environment.levels.size() - 1);
    std::size_t source = 0;
    while (environment.levels[source].height > 2 * kFilteredHeight) ++source;
    const Image light = environment.levels[source];
    for (std::size_t level = source + 1; level < environment.levels.size(); ++level) {
        Image& image = environment.levels[level];
        image = convolved(light, image.width, image.height, double(level) / last);
    }
    project(light, environment.irradiance);
    return environment;
}

/// A soft-edged rectangle of light around a direction: 1 inside, 0 outside.
double softBox(const dvec3& d, double azimuth, double elevation, double halfWidth, double halfHeight) {
    const dvec3 axis = directionAt(azimuth, elevation), right = directionAt(azimuth + 90, 0);
    const double depth = glm::dot(d, axis);
    if (depth <= 0) return 0;
    const double x = std::abs(glm::dot(d, right)) / depth, y = std::abs(glm::dot(d, glm::cross(axis, right))) / depth;
    const auto edge = [](double v, double half) { return glm::smoothstep(1.25 * half, 0.75 * half, v); };
    return edge(x, halfWidth) * edge(y, halfHeight);
}

dvec3 studioLight(const dvec3& d) {
    const dvec3 sky = glm::mix(dvec3(0.50, 0.52, 0.55), dvec3(0.95, 1.0, 1.08), glm::smoothstep(-0.05, 0.9, d.y));
    const dvec3 floor = glm::mix(dvec3(0.50, 0.52, 0.55), dvec3(0.20, 0.18, 0.165), glm::smoothstep(0.05, -0.5, d.y));
    dvec3 light = 0.34 * (d.y > 0 ? sky : floor);
    light += dvec3(2.1, 2.05, 1.95) * softBox(d, -60, 35, 0.55, 0.45); // the large soft box, upper left
    light += dvec3(1.6, 1.75, 2.0) * softBox(d, 125, 25, 0.25, 0.7);   // a cool strip behind, for the rim
    light += dvec3(0.7, 0.7, 0.7) * softBox(d, 0, 88, 0.8, 0.5);       // overhead
    return light;
}

} // namespace

Environment studioEnvironment() {
    Image image = blank(2 * kStudioHeight, kStudioHeight);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) set(image, x, y, studioLight(texelDirection(image, x, y)));
    return prepare(std::move(image));
}

Environment loadEnvironment(const std::string& path) {
    Image file = readImage(path);
    if (file.channels < 3 || file.width < 8 || file.height < 4)
        fail(Failure::input,
             "{}: an environment is a color picture of at least 8 x 4 pixels; this one is {} x {} with {} channels",
             path, file.width, file.height, file.channels);
    if (file.width != 2 * file.height)
        fail(Failure::input, "{}: an equirectangular environment is twice as wide as high; this one is {} x {}", path,
             file.width, file.height);
    Image image = blank(file.width, file.height);
    for (int y = 0; y < file.height; ++y)
        for (int x = 0; x < file.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const float value = file.at(x, y)[c];
                // Sums over all pixels stay finite, and the sun has 1.6e9 candela per square metre.
                if (!std::isfinite(value) || value < 0 || value > kMostRadiance)
                    fail(Failure::input, "{}: pixel {},{} is {}; radiance is a number in 0..{:g}", path, x, y, value,
                         kMostRadiance);
                image.at(x, y)[c] = value;
            }
    return prepare(std::move(image));
}

GpuEnvironment uploadEnvironment(Device& device, const Environment& environment) {
    RELIEF_CHECK(!environment.levels.empty());
    std::vector<float> texels; // RGBA, level by level
    for (const Image& level : environment.levels)
        for (std::size_t i = 0; i < level.texels.size(); i += 3)
            texels.insert(texels.end(), {level.texels[i], level.texels[i + 1], level.texels[i + 2], 1.0f});
    const Image& base = environment.levels.front();
    GpuEnvironment uploaded;
    uploaded.levels = uploadTexture(device,
                                    {.name = "environment",
                                     .width = std::uint32_t(base.width),
                                     .height = std::uint32_t(base.height),
                                     .mipCount = std::uint32_t(environment.levels.size()),
                                     .format = VK_FORMAT_R32G32B32A32_SFLOAT},
                                    std::as_bytes(std::span(texels)), 4 * sizeof(float));
    std::ranges::copy(environment.irradiance, uploaded.irradiance);
    return uploaded;
}

} // namespace relief
