// What a sculpt looks like where lines from the surface meet it, besides its height.
#pragma once

#include "bake/texels.h"
#include "distance/distance.h"

namespace relief {

enum class SculptLayer {
    tangentNormal, ///< of the sculpt, along s, along t and along the limit normal
    objectNormal,
    position,  ///< of the sculpt, in the unit of the surface
    vector,    ///< from the limit surface to the sculpt, along x, y and z
    occlusion, ///< the share of the sky that a point of the sculpt sees: 1 is open
    curvature, ///< mean curvature of the sculpt: above 0 on ridges
};

/// Channels of a layer's image.
constexpr int channelsOf(SculptLayer layer) {
    return layer == SculptLayer::occlusion || layer == SculptLayer::curvature ? 1 : 3;
}

/// The vertices of a sculpt. Vertices at equal positions have the same values.
struct SculptDetail {
    std::vector<vec3> normals;     ///< unit, weighted by area, outwards
    std::vector<float> curvatures; ///< mean of (n_j - n_i) (p_j - p_i) / |p_j - p_i|^2 over the edges of a vertex
};

/// `facing`: the side of the triangles that is outside.
SculptDetail computeSculptDetail(const TriangleView& triangles, Facing facing);

struct LayerOptions {
    std::vector<SculptLayer> layers;
    const SculptDetail* detail = nullptr; ///< of the sculpt; needed for all layers but position and vector
    int occlusionLines = 16;              ///< per sample
    double occlusionReach = 0;            ///< how far away something still covers the sky
};

/// Evaluates the layers at hits. Several threads may ask.
class LayerSampler {
public:
    /// All of them have to outlive it.
    LayerSampler(const ReferenceSurface& surface, const MeasuredSurface& sculpt, const LayerOptions& options)
        : surface_(surface), sculpt_(sculpt), options_(options) {}

    /// Writes one number per channel of all layers, in their order. `normal`: limit normal at the sample.
    void evaluate(const TexelSample& sample, const LimitFrame& frame, const dvec3& normal, const LineHit& hit,
                  std::span<double> channels) const;
    [[nodiscard]] int channelCount() const;

private:
    [[nodiscard]] double openShare(const dvec3& q, const dvec3& normal, std::uint32_t seed) const;

    const ReferenceSurface& surface_;
    const MeasuredSurface& sculpt_;
    const LayerOptions& options_;
};

} // namespace relief
