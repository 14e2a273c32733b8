// Internal: OpenSubdiv's objects as this module builds them, and the numbers that its refinement primitives need.
#pragma once

#include <memory>
#include <string>

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include "surface/surface.h"

namespace relief {

namespace Far = OpenSubdiv::Far;

/// A value that OpenSubdiv can blend: what its templates call a primvar.
template <typename V>
struct Blend {
    V value{0};

    void Clear() { value = V(0); }                                                        // NOLINT(*-identifier-naming)
    void AddWithWeight(const Blend& other, double w) { value = value + w * other.value; } // NOLINT(*-identifier-naming)
};
using Point = Blend<dvec3>;
using TexPoint = Blend<dvec2>;

/// The refined topology of a cage and the patches on it.
struct FarTables {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    std::unique_ptr<const Far::PatchTable> patches;
    bool hasTexCoords = false;
    int isolation = 0; ///< levels used: at least 1 where there are n-gons
};

/// Cage, refined and local points.
inline std::size_t pointCount(const FarTables& tables) {
    return std::size_t(tables.refiner->GetNumVerticesTotal()) + tables.patches->GetNumLocalPoints();
}

/// The cage's topology, not refined. Throws Failure::input when the scheme or OpenSubdiv cannot take it.
std::unique_ptr<Far::TopologyRefiner> makeRefiner(const Cage& cage, Scheme scheme);

/// Refines adaptively and builds patches with double-precision local points. Throws as buildSurface does.
FarTables makeFarTables(const Cage& cage, const SurfaceOptions& options);

/// Cage, refined and local points of a pose, as the patch table indexes them.
std::vector<Point> refineAll(const FarTables& tables, std::span<const vec3> cagePositions);

/// Face-varying values, refined and local, as the patch table indexes them; empty without texture coordinates.
std::vector<TexPoint> refineAllTex(const FarTables& tables, const std::vector<vec2>& texCoords);

/// Blends refined points from the cage's, level by level, then local points from all of these, as the patch table
/// indexes them. `from(first)` is what holds the points from index `first` on: a pointer, or something that indexes
/// alike.
template <typename From>
void blendPoints(const FarTables& tables, const From& from) {
    const Far::PrimvarRefinerReal<double> blender(*tables.refiner);
    int first = 0;
    for (int level = 1; level < tables.refiner->GetNumLevels(); ++level) {
        const auto coarse = from(first);
        first += tables.refiner->GetLevel(level - 1).GetNumVertices();
        auto fine = from(first);
        blender.Interpolate(level, coarse, fine);
    }
    const auto* local = tables.patches->GetLocalPointStencilTable<double>();
    if (!local || local->GetNumStencils() == 0) return;
    const auto refined = from(0);
    auto locals = from(tables.refiner->GetNumVerticesTotal());
    local->UpdateValues(refined, locals);
}

/// Levels below its ptex face: a corner quad of an n-gon starts at depth 1.
inline int depthInFace(const Far::PatchParam& param) { return param.GetDepth() - (param.NonQuadRoot() ? 1 : 0); }

// The steps of buildSurface, each fills its own part of the surface; the last one uses the tables up.
void fillPatches(Surface& surface, const FarTables& tables);
void fillOwners(Surface& surface, const FarTables& tables, const Cage& cage);
void fillTexPoints(Surface& surface, const FarTables& tables, const std::vector<vec2>& texCoords);
void fillStencils(Surface& surface, FarTables tables);

} // namespace relief
