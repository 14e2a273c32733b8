// How far two surfaces are apart, and closest points (Embree).
#pragma once

#include <memory>
#include <span>

#include "mesh/mesh.h"

namespace relief {

/// Triangles that something else holds.
struct TriangleView {
    std::span<const vec3> positions;
    std::span<const std::uint32_t> indices; ///< three a triangle
};

/// Triangles ready to be measured from: in a tree for closest points, and covered with samples.
///
/// Samples are the same in every run. A surface of fewer triangles than `sampleCount` has its triangles cut into n * n
/// equal parts, with n so that all parts are about as long; one of more is cut into as many runs of triangles in index
/// order. Each part or run has one sample at a place of a low-discrepancy sequence, weighted by its area.
class MeasuredSurface {
public:
    /// Throws Failure::input for indices out of range, numbers that are not finite and surfaces without area.
    explicit MeasuredSurface(const TriangleView& triangles, std::size_t sampleCount = 200'000);
    ~MeasuredSurface();
    MeasuredSurface(MeasuredSurface&&) noexcept;
    MeasuredSurface& operator=(MeasuredSurface&&) noexcept;

    /// From `p` to the nearest point of the surface, rounded as floats of its coordinates are (2^-24 of the largest).
    [[nodiscard]] double distance(const dvec3& p) const;
    [[nodiscard]] std::size_t sampleCount() const;
    /// No point of the surface is farther from the sample that stands for it.
    [[nodiscard]] double coverage() const;

private:
    friend struct SampledDistance measureOneWay(const MeasuredSurface& from, const MeasuredSurface& to);
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// From the points of one surface to the nearest of another. What sampling costs: distance changes by no more than one
/// moves, so the true maximum is between `max` and `max + coverage`. `rms` is a mean over `sampleCount` places;
/// `rmsError` estimates how far it is off from how far the two halves of the samples disagree.
struct SampledDistance {
    double rms = 0, max = 0, mean = 0;
    double rmsError = 0, coverage = 0;
    std::size_t sampleCount = 0;
};
SampledDistance measureOneWay(const MeasuredSurface& from, const MeasuredSurface& to);

/// Both ways, on all cores.
struct SurfaceDistance {
    SampledDistance forth, back;

    [[nodiscard]] double rms() const;       ///< root of the mean of both mean squares
    [[nodiscard]] double rmsError() const;  ///< the larger
    [[nodiscard]] double hausdorff() const; ///< the larger maximum
};
SurfaceDistance measureDistance(const MeasuredSurface& a, const MeasuredSurface& b);

} // namespace relief
