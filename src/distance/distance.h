// How far two surfaces are apart, closest points, and where lines meet a surface (Embree).
#pragma once

#include <limits>
#include <memory>
#include <optional>
#include <span>

#include "mesh/mesh.h"

namespace relief {

/// Triangles whose arrays belong to somebody else.
struct TriangleView {
    std::span<const vec3> positions;
    std::span<const std::uint32_t> indices; ///< three per triangle
};

/// What the tree of a surface is built for: few points, or many lines.
enum class TreeUse { distances, lines };

/// Which sides of triangles a line may meet.
enum class Facing {
    front, ///< triangles whose counterclockwise side looks along the line's direction
    back,  ///< the others
    any,
};

/// How far a line reaches along its direction and against it.
struct LineReach {
    double front = 0, back = 0;
};

/// Where a line meets a surface.
struct LineHit {
    double height = 0; ///< along the direction; below 0 against it
    std::uint32_t triangle = 0;
    bool isBehindBack = false; ///< the line passes a triangle that may not be met before it comes there
};

/// The point of a surface that is nearest to another one.
struct NearestPoint {
    dvec3 point{0};
    std::uint32_t triangle = 0;
};

/// The normal of a mesh at such a point, between those of the triangle's corners; not of unit length.
dvec3 normalAt(const DenseMesh& mesh, const NearestPoint& nearest);

class MeasuredSurface;
/// Moves a point and its normal to the nearest point of a mesh, which `measured` was made of. Both stay where the mesh
/// looks the other way there: beyond a thin sheet.
void moveToNearest(const DenseMesh& mesh, const MeasuredSurface& measured, dvec3& position, dvec3& normal);

/// A surface prepared for measuring: a tree for closest points and lines, and samples that cover it.
///
/// Samples are the same in every run. A surface of fewer triangles than `sampleCount` has each triangle cut into n * n
/// equal parts, with n chosen so that all parts are about as long. A surface of more triangles is cut into
/// `sampleCount` groups of triangles that are consecutive in index order. Each part or group has one sample, at a point
/// of a low-discrepancy sequence, weighted by its area.
class MeasuredSurface {
public:
    /// Throws Failure::input for indices out of range, numbers that are not finite and surfaces without area.
    explicit MeasuredSurface(const TriangleView& triangles, std::size_t sampleCount = 200'000,
                             TreeUse use = TreeUse::distances);
    /// Prepares a surface without a copy of its triangles. Throws as the constructor does.
    static MeasuredSurface ofMesh(TriangleMesh mesh, std::size_t sampleCount, TreeUse use);
    ~MeasuredSurface();
    MeasuredSurface(MeasuredSurface&&) noexcept;
    MeasuredSurface& operator=(MeasuredSurface&&) noexcept;

    /// Distance from `p` to the nearest point of the surface, in units of the positions. It is off by up to 2^-24 of
    /// the largest coordinate, because closest points are searched with floats.
    /// `limit`: a distance within which there is a point; the closer the quicker.
    [[nodiscard]] double distance(const dvec3& p, double limit = std::numeric_limits<double>::infinity()) const;
    /// The nearest point itself, as exact as its distance.
    [[nodiscard]] NearestPoint nearest(const dvec3& p) const;
    /// The hit nearest to `p` on the line through it along a unit `direction`; empty where there is none within reach.
    /// The triangle is found with floats, its height is computed in double precision. Several threads may ask.
    [[nodiscard]] std::optional<LineHit> nearestOnLine(const dvec3& p, const dvec3& direction, const LineReach& reach,
                                                       Facing facing = Facing::front) const;
    /// True where a line from a point of the surface, or near it, meets a triangle within `reach`.
    [[nodiscard]] bool isBlocked(const dvec3& p, const dvec3& direction, double reach) const;
    /// The surface's own copy of its triangles.
    [[nodiscard]] TriangleView triangles() const;
    [[nodiscard]] std::size_t sampleCount() const;
    /// Largest distance from a point of the surface to the sample that represents it.
    [[nodiscard]] double coverage() const;

private:
    friend struct SampledDistance measureOneWay(const MeasuredSurface& from, const MeasuredSurface& to);
    struct Parts;
    explicit MeasuredSurface(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> parts_;
};

/// Distances from samples of one surface to the nearest points of another.
struct SampledDistance {
    double rms = 0, max = 0, mean = 0; ///< weighted by area; the true maximum is between `max` and `max + coverage`
    double share95 = 0;                ///< 95 % of the area are not farther away
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
