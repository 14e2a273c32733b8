// How far two surfaces are apart, and closest points (Embree).
#pragma once

#include <memory>
#include <span>

#include "mesh/mesh.h"

namespace relief {

/// Triangles whose arrays belong to somebody else.
struct TriangleView {
    std::span<const vec3> positions;
    std::span<const std::uint32_t> indices; ///< three per triangle
};

/// A surface prepared for measuring: a tree for closest points, and samples that cover it.
///
/// Samples are the same in every run. A surface of fewer triangles than `sampleCount` has each triangle cut into n * n
/// equal parts, with n chosen so that all parts are about as long. A surface of more triangles is cut into
/// `sampleCount` groups of triangles that are consecutive in index order. Each part or group has one sample, at a point
/// of a low-discrepancy sequence, weighted by its area.
class MeasuredSurface {
public:
    /// Throws Failure::input for indices out of range, numbers that are not finite and surfaces without area.
    explicit MeasuredSurface(const TriangleView& triangles, std::size_t sampleCount = 200'000);
    ~MeasuredSurface();
    MeasuredSurface(MeasuredSurface&&) noexcept;
    MeasuredSurface& operator=(MeasuredSurface&&) noexcept;

    /// Distance from `p` to the nearest point of the surface, in units of the positions. It is off by up to 2^-24 of
    /// the largest coordinate, because closest points are searched with floats.
    [[nodiscard]] double distance(const dvec3& p) const;
    [[nodiscard]] std::size_t sampleCount() const;
    /// Largest distance from a point of the surface to the sample that represents it.
    [[nodiscard]] double coverage() const;

private:
    friend struct SampledDistance measureOneWay(const MeasuredSurface& from, const MeasuredSurface& to);
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// Distances from samples of one surface to the nearest points of another.
struct SampledDistance {
    double rms = 0, max = 0, mean = 0; ///< weighted by area; the true maximum is between `max` and `max + coverage`
    double rmsError = 0;               ///< estimate from the difference between the two halves of the samples
    double coverage = 0;               ///< MeasuredSurface::coverage of the sampled surface
    std::size_t sampleCount = 0;
};

/// Measures from the samples of `from` to the surface `to`, on all cores.
SampledDistance measureOneWay(const MeasuredSurface& from, const MeasuredSurface& to);

/// Distances from the first surface to the second, and back.
struct SurfaceDistance {
    SampledDistance forth, back;

    [[nodiscard]] double rms() const;       ///< root of the mean of both mean squares
    [[nodiscard]] double rmsError() const;  ///< the larger of the two
    [[nodiscard]] double hausdorff() const; ///< the larger of the two maxima
};

/// Measures in both directions, on all cores.
SurfaceDistance measureDistance(const MeasuredSurface& a, const MeasuredSurface& b);

} // namespace relief
