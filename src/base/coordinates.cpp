#include <algorithm>
#include <cmath>
#include <limits>

#include "base/base.h"

namespace relief {
namespace {

/// Sides from 2^-20 up to 2^21 keep their unit: squares and areas of such objects are far from the ends of floats.
constexpr int kMostUsualExponent = 20;

double largestOf(const dvec3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

bool isInRange(const dvec3& p) { return largestOf(p) <= kFarthestCoordinate; } // false for NaN

} // namespace

dvec3 Coordinates::toWorld(const dvec3& local) const { return isIdentity() ? local : origin + unit * local; }

dvec3 Coordinates::toLocal(const dvec3& world) const { return isIdentity() ? world : (world - origin) / unit; }

Bounds Coordinates::toWorld(const Bounds& local) const {
    if (isIdentity() || local.isEmpty()) return local;
    return {.lower = toWorld(local.lower), .upper = toWorld(local.upper)};
}

Coordinates coordinatesFor(const Bounds& bounds) {
    if (bounds.isEmpty() || !isInRange(bounds.lower) || !isInRange(bounds.upper)) return {};
    const double side = bounds.longestSide(), size = side > 0 ? side : largestOf(bounds.center());
    if (!(size >= kSmallestSide)) return {};
    const int exponent = std::ilogb(size);
    Coordinates coordinates;
    if (std::abs(exponent) > kMostUsualExponent) coordinates.unit = std::ldexp(1.0, exponent);
    // A multiple of a power of two above the size: what is subtracted has no bit below the last ones of the positions.
    const double step = std::ldexp(1.0, exponent + 1);
    const bool isFar = glm::length(bounds.center() / size) > glm::length((bounds.upper - bounds.lower) / size);
    if (isFar && side > 0) coordinates.origin = glm::round(bounds.center() / step) * step;
    return coordinates;
}

double floatSpacing(const dvec3& p) {
    const auto largest = float(std::min(largestOf(p), double(std::numeric_limits<float>::max())));
    return double(std::nextafter(largest, std::numeric_limits<float>::infinity())) - double(largest);
}

} // namespace relief
