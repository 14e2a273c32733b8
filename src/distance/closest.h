// Internal: the nearest point of a set of triangles, and where lines meet them, by Embree's tree.
#pragma once

#include <embree3/rtcore.h>

#include "distance/distance.h"

namespace relief {

/// The point of triangle abc that is nearest to p (Ericson, Real-Time Collision Detection, 2005, section 5.1.5).
dvec3 nearestInTriangle(const dvec3& p, const dvec3& a, const dvec3& b, const dvec3& c);

/// Keeps the triangles it was made of. Queries may run on several threads.
class ClosestPoints {
public:
    ClosestPoints(std::vector<vec3> positions, std::vector<std::uint32_t> indices, TreeUse use);
    ClosestPoints(const ClosestPoints&) = delete;
    ClosestPoints& operator=(const ClosestPoints&) = delete;

    /// Computes the distance from `p` to the nearest point. `limit`: a distance within which there is one; the closer
    /// the quicker.
    [[nodiscard]] double distance(const dvec3& p, double limit) const;
    /// Finds the nearest point itself.
    [[nodiscard]] NearestPoint nearest(const dvec3& p) const;
    /// Finds what MeasuredSurface::nearestOnLine does.
    [[nodiscard]] std::optional<LineHit> nearestOnLine(const dvec3& p, const dvec3& direction, const LineReach& reach,
                                                       Facing facing) const;
    /// Answers what MeasuredSurface::isBlocked does.
    [[nodiscard]] bool isBlocked(const dvec3& p, const dvec3& direction, double reach) const;
    [[nodiscard]] const std::vector<vec3>& positions() const { return positions_; }
    [[nodiscard]] const std::vector<std::uint32_t>& indices() const { return indices_; }

private:
    double overlap_ = 0;          ///< by which both halves of a line begin before its point: what floats may be off
    std::vector<vec3> positions_; ///< one more than there are: Embree reads 16 bytes per vertex
    std::vector<std::uint32_t> indices_;
    std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)> device_{rtcNewDevice(nullptr), rtcReleaseDevice};
    std::unique_ptr<RTCSceneTy, void (*)(RTCScene)> scene_{nullptr, rtcReleaseScene};
};

} // namespace relief
