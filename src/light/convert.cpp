// Pictures of other shapes and sizes, and blurred ones.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

#include "light/light.h"

namespace relief {
namespace {

Image blank(int width, int height) {
    return {width, height, 3, std::vector<float>(std::size_t(width) * std::size_t(height) * 3)};
}

void set(Image& image, int x, int y, const dvec3& c) {
    for (int i = 0; i < 3; ++i) image.at(x, y)[i] = float(c[i]);
}

/// Most texels per radian that a picture has anywhere but near poles and edges.
double texelsPerRadian(const EnvironmentPicture& picture) {
    switch (picture.shape) {
    case EnvironmentShape::equirect: return picture.side() / std::numbers::pi;
    case EnvironmentShape::cube: return picture.side() / 2.0;
    case EnvironmentShape::sphere: break;
    }
    return picture.side() / 4.0;
}

bool isInBall(const dvec2& at) { return glm::length(2.0 * at - 1.0) < 1; }

/// One texel: the mean of lookups spread evenly over it.
dvec3 sample(const EnvironmentPicture& source, EnvironmentShape shape, int image, const dvec2& low,
             const dvec2& extent) {
    // As many lookups each way as texels of the source lie along the texel, and half as many again.
    const dvec3 origin = directionOf(shape, {image, low});
    const double width = glm::length(directionOf(shape, {image, low + dvec2(extent.x, 0)}) - origin);
    const double height = glm::length(directionOf(shape, {image, low + dvec2(0, extent.y)}) - origin);
    const double diagonal = glm::length(directionOf(shape, {image, low + extent}) - origin);
    const double texels = std::max({width, height, diagonal}) * texelsPerRadian(source);
    const int count = std::clamp(int(std::ceil(1.5 * texels)), 2, 24);
    dvec3 sum(0);
    int inside = 0;
    for (int j = 0; j < count; ++j)
        for (int i = 0; i < count; ++i) {
            const dvec2 at = low + extent * (dvec2(i, j) + 0.5) / double(count);
            if (shape == EnvironmentShape::sphere && !isInBall(at)) continue;
            sum += lookUp(source, directionOf(shape, {image, at}));
            ++inside;
        }
    return inside > 0 ? sum / double(inside) : dvec3(0);
}

/// Calls `row(y)` for all rows, on all cores where there are many.
template <typename Row>
void forRows(int count, const Row& row) {
    constexpr int kFew = 32;
    const int threads = std::clamp(int(std::thread::hardware_concurrency()), 1, 16);
    if (threads == 1 || count <= kFew) {
        for (int y = 0; y < count; ++y) row(y);
        return;
    }
    std::vector<std::jthread> all;
    for (int t = 0; t < threads; ++t)
        all.emplace_back([&, t] {
            for (int y = t; y < count; y += threads) row(y);
        });
}

} // namespace

int sideOf(const EnvironmentPicture& picture, EnvironmentShape shape) {
    constexpr auto sideOfCube = [](EnvironmentShape s) {
        return s == EnvironmentShape::cube ? 1 : s == EnvironmentShape::equirect ? 2 : 4;
    };
    return std::max(4, picture.side() * sideOfCube(shape) / sideOfCube(picture.shape));
}

EnvironmentPicture convert(const EnvironmentPicture& picture, EnvironmentShape shape, int side) {
    EnvironmentPicture to{.shape = shape, .images = {}};
    const int width = shape == EnvironmentShape::equirect ? 2 * side : side;
    for (int i = 0; i < countImages(shape); ++i) to.images.push_back(blank(width, side));

    // A source of much more texels is made smaller first: lookups would miss some of them.
    EnvironmentPicture source = picture;
    if (source.shape == EnvironmentShape::sphere) fillRing(source.images.front());
    while (texelsPerRadian(source) > 8 * texelsPerRadian(to) && source.side() % 2 == 0 && source.side() > 8)
        for (Image& image : source.images) image = halved(image);

    const dvec2 extent(1.0 / width, 1.0 / side);
    for (int number = 0; number < countImages(shape); ++number) {
        Image& image = to.images[std::size_t(number)];
        forRows(side, [&](int y) {
            for (int x = 0; x < width; ++x)
                set(image, x, y, sample(source, shape, number, dvec2(x, y) * extent, extent));
        });
    }
    return to;
}

EnvironmentPicture blur(const EnvironmentPicture& picture, double roughness) {
    // The lobe is about roughness^2 wide. Texels of an eighth of that show it; more than 128 rows take minutes.
    const double lobe = std::max(roughness * roughness, 1e-3);
    const int height = std::clamp(int(8 * std::numbers::pi / lobe), 16, 128);
    const int source = std::min(height, sideOf(picture, EnvironmentShape::equirect));
    const Image light = convert(picture, EnvironmentShape::equirect, source).images.front();
    EnvironmentPicture blurred{.shape = EnvironmentShape::equirect, .images = {blank(2 * source, source)}};
    blurred.images.front() = convolved(light, 2 * source, source, roughness);
    return convert(blurred, picture.shape, picture.side());
}

// --- equirectangular pictures, texel by texel ---------------------------------------------------------------------

dvec3 texelDirection(const Image& image, int x, int y) {
    const double phi = ((x + 0.5) / image.width - 0.5) * 2 * std::numbers::pi,
                 theta = (y + 0.5) / image.height * std::numbers::pi;
    return {std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
}

double texelSolidAngle(const Image& image, int y) {
    return 2 * std::numbers::pi / image.width *
           (std::cos(y * std::numbers::pi / image.height) - std::cos((y + 1) * std::numbers::pi / image.height));
}

Image halved(const Image& from) {
    Image to = blank(std::max(1, from.width / 2), std::max(1, from.height / 2));
    for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x) {
            dvec3 sum(0);
            for (int k = 0; k < 4; ++k) {
                const float* c =
                    from.at(std::min(2 * x + k % 2, from.width - 1), std::min(2 * y + k / 2, from.height - 1));
                sum += dvec3(vec3(c[0], c[1], c[2]));
            }
            set(to, x, y, sum / 4.0);
        }
    return to;
}

Image convolved(const Image& source, int width, int height, double roughness) {
    const double a2 = std::pow(roughness, 4);
    std::vector<dvec3> directions; // of all texels of the source
    for (int j = 0; j < source.height; ++j)
        for (int i = 0; i < source.width; ++i) directions.push_back(texelDirection(source, i, j));
    // Every texel is the mean of the source, weighted by the lobe around its direction with view and normal along it.
    Image to = blank(width, height);
    forRows(height, [&](int y) {
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
                    const float* c = source.at(i, j);
                    sum += weight * dvec3(vec3(c[0], c[1], c[2]));
                    weights += weight;
                }
            }
            set(to, x, y, sum / weights);
        }
    });
    return to;
}

} // namespace relief
