#include <algorithm>
#include <cmath>
#include <numbers>

#include "frame/frame.h"

namespace relief {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kStudioHeight = 64;
constexpr int kLargestHeight = 512; // of a user's environment; sharper reflections do not show on a dielectric
constexpr int kSharpHeight = 2048;  // the same for mirrors
constexpr int kFilteredHeight = 16; // levels of this size and below are convolved, larger ones averaged

vec3 rgb(const Image& image, int x, int y) {
    const float* c = image.at(x, y);
    return {c[0], c[1], c[2]};
}

Image blank(int width, int height) { return {width, height, 3, std::vector<float>(std::size_t(width) * height * 3)}; }

void set(Image& image, int x, int y, const dvec3& c) {
    for (int i = 0; i < 3; ++i) image.at(x, y)[i] = float(c[i]);
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

/// The roughness that the level of so many rows of a sharp environment is for. The lobe of GGX around what is mirrored
/// has half its height at 1.3 r^2 radians to either side, which is 1.6 texels.
double roughnessOfRows(int rows) { return std::min(1.0, 2 / std::sqrt(rows)); }

Environment prepare(Image base, bool isSharp = false) {
    const int largest = isSharp ? kSharpHeight : kLargestHeight;
    while (base.height > largest) base = halved(base);
    Environment environment{.levels = {}, .irradiance = {}, .isSharp = isSharp};
    environment.levels.push_back(std::move(base));
    while (environment.levels.back().height > 4) environment.levels.push_back(halved(environment.levels.back()));
    // Level sizes halve, roughness grows evenly from 0 at the first to 1 at the last; of a sharp one as its texels do.
    const auto last = double(environment.levels.size() - 1);
    std::size_t source = 0;
    while (environment.levels[source].height > (isSharp ? 4 : 2) * kFilteredHeight) ++source;
    const Image light = environment.levels[source];
    // A sharp one of at most as many rows has its first level for mirrors.
    const std::size_t first = isSharp && source > 0 ? source : source + 1;
    for (std::size_t level = first; level < environment.levels.size(); ++level) {
        Image& image = environment.levels[level];
        const double roughness = isSharp ? roughnessOfRows(image.height) : double(level) / last;
        image = convolved(light, image.width, image.height, roughness);
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

EnvironmentPicture makeStudioPicture() {
    Image image = blank(2 * kStudioHeight, kStudioHeight);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) set(image, x, y, studioLight(texelDirection(image, x, y)));
    return {.shape = EnvironmentShape::equirect, .images = {std::move(image)}};
}

Environment studioEnvironment() { return prepare(makeStudioPicture().images.front()); }

Environment makeEnvironment(const EnvironmentPicture& picture, bool isSharp) {
    RELIEF_CHECK(picture.images.size() == std::size_t(countImages(picture.shape)));
    const int largest = isSharp ? kSharpHeight : kLargestHeight;
    if (picture.shape == EnvironmentShape::equirect) return prepare(picture.images.front(), isSharp);
    // Powers of two: levels halve down to four rows.
    int side = 16;
    while (side < std::min(largest, sideOf(picture, EnvironmentShape::equirect))) side *= 2;
    return prepare(convert(picture, EnvironmentShape::equirect, side).images.front(), isSharp);
}

Environment loadEnvironment(const std::string& path) { return makeEnvironment(readEnvironment(path).picture); }

std::array<vec3, 9> turnIrradiance(const vec3 (&irradiance)[9], double degrees) {
    std::array<vec3, 9> turned;
    std::ranges::copy(irradiance, turned.begin());
    if (degrees == 0) return turned;
    // What the turned environment has at (x, y, z) is what it had at (c x - s z, y, c z + s x).
    const auto c = float(std::cos(glm::radians(degrees))), s = float(std::sin(glm::radians(degrees)));
    const vec3(&l)[9] = irradiance;
    turned[2] = c * l[2] - s * l[3], turned[3] = s * l[2] + c * l[3];
    turned[4] = c * l[4] + s * l[5], turned[5] = c * l[5] - s * l[4];
    // The other quadratic terms a z^2 + b x^2 + d y^2 + e x z, less the part of x^2 + y^2 + z^2 = 1 in them.
    const vec3 a = 3 * c * c * l[6] - c * s * l[7] + s * s * l[8], b = 3 * s * s * l[6] + c * s * l[7] + c * c * l[8];
    const vec3 d = -l[8], e = 6 * c * s * l[6] + (c * c - s * s) * l[7] - 2 * c * s * l[8];
    turned[6] = (a - 0.5f * (b + d)) / 3.0f;
    turned[7] = e;
    turned[8] = 0.5f * (b - d);
    return turned;
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
    uploaded.isSharp = environment.isSharp;
    return uploaded;
}

float GpuEnvironment::levelOf(float roughness) const {
    const auto last = float(levels.desc.mipCount - 1);
    if (!isSharp) return roughness * last;
    const double rows = levels.desc.height, level = std::log2(rows * roughness * roughness / 4);
    return std::clamp(float(level), 0.0f, last); // of roughness 0 it is -infinity
}

} // namespace relief
