// From dense surfaces to maps, and how far two surfaces are apart. Today: the points under a map's texels, distances.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "displacement/displacement.h"

namespace relief {

// --- the points under a map's texels ------------------------------------------------------------------------------

/// What a texel covers. Beyond an island's border everything continues linearly.
struct SurfacePoint {
    int face = 0;     ///< of the cage, which has quads only
    dvec2 uv{0};      ///< face coordinates
    dvec2 st{0};      ///< texture coordinates
    dvec3 p{0}, n{0}; ///< limit position and normal
};

/// Painting by points of the limit surface: every texel learns which one it covers, texels just outside an island
/// included, so that both sides of a seam agree whatever is painted. For cages of quads with texture coordinates.
class Atlas {
public:
    using Painter = std::function<void(int x, int y, const SurfacePoint&)>;
    Atlas(const Cage& cage, int width, int height);

    /// Calls `paint` once for every texel inside an island or within a few texels of its border.
    void forEachTexel(const Painter& paint);
    /// Spreads values from painted texels over the rest of the image, nearest first, so that coarse mips stay clean.
    void spread(Image& image) const;
    [[nodiscard]] const ReferenceSurface& surface() const { return surface_; }

private:
    static constexpr int kSteps = 8;       ///< samples along a face's side
    static constexpr double kMargin = 3.5; ///< texels painted beyond a border
    static constexpr int kSpan = kSteps + 3;
    using Samples = std::array<SurfacePoint, kSpan * kSpan>; ///< with one row beyond each side

    void findSeams(const Cage& cage);
    [[nodiscard]] Samples sampleFace(int face) const;
    [[nodiscard]] SurfacePoint beyond(const SurfacePoint& border, const SurfacePoint& inner) const;
    void paintCell(const Samples& samples, int i, int j, const Painter& paint);
    void paintTriangle(const std::array<SurfacePoint, 3>& corners, const Painter& paint);

    ReferenceSurface surface_;
    int width_, height_;
    std::vector<std::array<bool, 4>> hasSeam_; ///< by face and side
    std::vector<bool> isPainted_;
};

// --- distances between surfaces -----------------------------------------------------------------------------------

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
