// Maps of surfaces: painted by the points of the limit surface under their texels, or baked from sculpts with a
// certificate.
#pragma once

#include <array>

#include "bake/certificate.h"
#include "bake/face_texels.h"
#include "bake/heights.h"
#include "bake/layers.h"
#include "bake/lines.h"
#include "bake/sculpt.h"
#include "bake/texels.h"
#include "displacement/displacement.h"

namespace relief {

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

} // namespace relief
