// Vectors and matrices of GLM, boxes, and where an object's own coordinates lie in the world.
#pragma once

#include <functional>
#include <ranges>

#define GLM_FORCE_DEPTH_ZERO_TO_ONE
#include <glm/glm.hpp>

namespace relief {

using glm::dmat2;
using glm::dvec2;
using glm::dvec3;
using glm::ivec2;
using glm::mat3;
using glm::mat4;
using glm::uvec2;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// An axis-aligned box; empty (lower > upper) until something is added.
struct Bounds {
    dvec3 lower{1e300};
    dvec3 upper{-1e300};

    void add(const dvec3& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
    [[nodiscard]] bool isEmpty() const { return lower.x > upper.x; }
    [[nodiscard]] dvec3 center() const { return 0.5 * (lower + upper); }
    /// Length from `lower` to `upper`; 0 for an empty box.
    [[nodiscard]] double diagonal() const { return isEmpty() ? 0 : glm::length(upper - lower); }
    /// Length of the longest side; 0 for an empty box.
    [[nodiscard]] double longestSide() const;
    /// Distance from a point to the box, which is not empty; 0 inside.
    [[nodiscard]] double distanceTo(const dvec3& p) const {
        return glm::length(glm::max(glm::max(lower - p, p - upper), dvec3(0)));
    }
};

/// The box around points; empty when there are none. `toPoint` makes a vec3 or dvec3 of each element, for example of
/// an index.
template <std::ranges::input_range Elements, typename ToPoint = std::identity>
Bounds computeBounds(const Elements& elements, const ToPoint& toPoint = {}) {
    Bounds bounds;
    for (const auto& element : elements) bounds.add(dvec3(toPoint(element)));
    return bounds;
}

/// The largest absolute coordinate of a position that is accepted, and the smallest side of an object that gets
/// coordinates of its own; both in world units.
inline constexpr double kFarthestCoordinate = 1e100, kSmallestSide = 1e-100;

/// Maps an object's own coordinates, which are stored as floats, to the world's, which are doubles:
/// world = origin + unit * local. The unit is a power of two.
struct Coordinates {
    dvec3 origin{0};
    double unit = 1;

    bool operator==(const Coordinates&) const = default;
    /// True when local coordinates equal the world's to the bit.
    [[nodiscard]] bool isIdentity() const { return origin == dvec3(0) && unit == 1; }
    [[nodiscard]] dvec3 toWorld(const dvec3& local) const;
    [[nodiscard]] dvec3 toLocal(const dvec3& world) const;
    [[nodiscard]] Bounds toWorld(const Bounds& local) const;
};

/// Chooses coordinates for an object whose box in the world is `bounds`.
/// The identity unless the box's centre is farther from the origin than the box is large, or its longest side is below
/// 2^-20 or above 2^21. Origins are multiples of a power of two above the longest side, so that positions that are
/// floats stay exact, also after the object has been moved by such a multiple.
Coordinates coordinatesFor(const Bounds& bounds);

/// Distance from the largest absolute coordinate of `p` to the next larger float.
double floatSpacing(const dvec3& p);

} // namespace relief
