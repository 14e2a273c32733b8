#include "app/empty.h"

#include <algorithm>
#include <cmath>

namespace relief::app {
namespace {

/// Squares and products of larger numbers pass the end of 32-bit floats.
constexpr double kFarthestDrawn = 1e18;

/// Points that miss a line by less than this share of their extent have no area that floats can show.
constexpr double kNoWidth = 1e-7;

/// The box of points in the picture: pixels right and down of its top left corner, and depths along the view.
struct Extent {
    dvec2 lower{1e300}, upper{-1e300};
    double nearest = 1e300, farthest = -1e300;

    [[nodiscard]] bool isInFront() const { return farthest > 0; }
    [[nodiscard]] dvec2 size() const { return upper - lower; }
};

/// Computes the extent of the points; only those in front of the camera count for the box.
Extent extentOf(const EmptyView& view) {
    const Camera& camera = view.camera;
    const dvec3 forward = glm::normalize(camera.target - camera.eye);
    const dvec3 helper = std::abs(forward.y) > 0.9999 ? dvec3(0, 0, 1) : dvec3(0, 1, 0);
    const dvec3 right = glm::normalize(glm::cross(forward, helper)), down = glm::cross(forward, right);
    const double pixels = view.size.y / (2 * std::tan(glm::radians(camera.fieldOfView) / 2));
    Extent extent;
    for (const dvec3& p : view.points) {
        const dvec3 d = p - camera.eye;
        const double depth = glm::dot(d, forward);
        extent.nearest = std::min(extent.nearest, depth), extent.farthest = std::max(extent.farthest, depth);
        if (depth <= 0) continue;
        const dvec2 at = dvec2(glm::dot(d, right), glm::dot(d, down)) * (pixels / depth) + 0.5 * dvec2(view.size);
        extent.lower = glm::min(extent.lower, at), extent.upper = glm::max(extent.upper, at);
    }
    return extent;
}

/// The largest distance from the line through the first point and the one farthest from it, over that distance.
double relativeWidth(std::span<const dvec3> points, double size) {
    const auto fromFirst = [&](const dvec3& p) { return glm::length((p - points[0]) / size); };
    const dvec3 far = *std::ranges::max_element(points, {}, fromFirst);
    const dvec3 along = glm::normalize((far - points[0]) / size);
    double width = 0;
    for (const dvec3& p : points) width = std::max(width, glm::length(glm::cross((p - points[0]) / size, along)));
    return width / fromFirst(far);
}

/// What is wrong with the object whoever looks at it; "" for nothing.
std::string faultOf(const EmptyView& view) {
    Bounds bounds;
    for (const dvec3& p : view.points) {
        if (!std::isfinite(p.x + p.y + p.z)) return "its heights move it to numbers that are not finite";
        bounds.add(p);
    }
    const double size = bounds.longestSide();
    const double rounding = kNoWidth * std::max(glm::length(bounds.lower), glm::length(bounds.upper));
    if (size <= rounding) {
        const dvec3 at = view.coordinates.toWorld(bounds.center());
        return fmt::format("all of its points coincide at ({:.9g}, {:.9g}, {:.9g})", at.x, at.y, at.z);
    }
    if (relativeWidth(view.points, size) < kNoWidth) return "all of its points lie on one line, so it has no area";
    if (size > kFarthestDrawn)
        return fmt::format("it extends over {:.3g} cage units, too far for 32-bit floats; make its heights smaller",
                           size * view.coordinates.unit);
    return "";
}

/// What is wrong with the camera; "" for nothing.
std::string faultOfCamera(const EmptyView& view) {
    const Extent extent = extentOf(view);
    if (!extent.isInFront()) return "it lies behind the camera; see --look-at and --distance";
    const dvec2 size = extent.size();
    const bool isOutside =
        extent.upper.x < 0 || extent.upper.y < 0 || extent.lower.x > view.size.x || extent.lower.y > view.size.y;
    if (isOutside) return "it lies outside of the picture; see --look-at and --distance";
    if (std::max(size.x, size.y) < 2)
        return fmt::format("it is {:.2g} by {:.2g} pixels large from there; see --distance", size.x, size.y);
    if (std::min(size.x, size.y) < 1)
        return fmt::format("it is seen from its edge, {:.3g} by {:.3g} pixels large", size.x, size.y);
    if (extent.nearest <= 0) return "the camera is inside of it or too near; see --look-at and --distance";
    return "none of its triangles covers the middle of a pixel";
}

std::size_t coveredPixels(const Picture& picture, std::size_t most) {
    std::size_t count = 0;
    for (std::size_t alpha = 3; alpha < picture.halves.size() && count < most; alpha += 4)
        count += picture.halves[alpha] != 0 ? 1 : 0;
    return count;
}

} // namespace

bool isSparse(const Picture& picture) {
    constexpr std::size_t kShare = 500; // of all pixels: what rounding makes visible of lines and points is less
    const std::size_t most = picture.halves.size() / 4 / kShare + 1;
    return coveredPixels(picture, most) < most;
}

std::string complaintOf(const Picture& picture, const EmptyView& view) {
    if (!isSparse(picture)) return "";
    std::string reason = faultOf(view);
    if (reason.empty() && coveredPixels(picture, 1) == 0) reason = faultOfCamera(view);
    return reason.empty() ? "" : "there is nothing to see: " + reason;
}

} // namespace relief::app
