// Evaluates Surface's flat arrays as their comments say a device should.
#pragma once

#include <span>

#include "surface/far.h"

namespace relief {

/// A face's (u,v) inside the leaf patch that holds it.
struct Leaf {
    std::uint32_t patch = kNoPatch;
    dvec2 uv{0}; ///< the patch's own coordinates, 0..1
    int depth = 0;
};

/// Walks the face's tree.
Leaf findLeaf(const Surface& surface, std::uint32_t face, dvec2 uv);

class FlatSurface {
public:
    FlatSurface(const Cage& cage, const SurfaceOptions& options);

    [[nodiscard]] const Surface& surface() const { return surface_; }
    [[nodiscard]] dvec3 position(std::uint32_t face, const dvec2& uv) const;
    [[nodiscard]] dvec2 texCoord(std::uint32_t face, const dvec2& uv) const;

private:
    [[nodiscard]] std::vector<double> weights(std::uint32_t patch, const Leaf& leaf, const dvec2& uv) const;
    [[nodiscard]] std::vector<double> texWeights(std::uint32_t patch, const Leaf& leaf, const dvec2& uv) const;

    Surface surface_;
    std::vector<dvec3> points_;
    FarTables tables_;                                  ///< for the bases that are not written out here
    std::vector<Far::PatchTable::PatchHandle> handles_; ///< one per patch
};

} // namespace relief
