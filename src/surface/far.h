// Internal: OpenSubdiv's objects as this module builds them, and the numbers that its refinement primitives need.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include <opensubdiv/far/patchTableFactory.h>
#include <opensubdiv/far/primvarRefiner.h>
#include <opensubdiv/far/ptexIndices.h>
#include <opensubdiv/far/topologyDescriptor.h>

#include "surface/caps.h"
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

/// An end cap that is evaluated exactly: its rules and the points around it, as the patch table indexes points.
struct EndCap {
    std::uint32_t pattern = 0; ///< into EndCaps::patterns
    std::uint32_t corner = 0;  ///< of the patch: where the extraordinary vertex is
    std::uint32_t limit = 0;   ///< into EndCaps::limits: the vertex's limit point
    std::vector<int> points;   ///< in the order of CapPattern::pointCount
};

/// The caps of a patch table. Limit points follow the table's points, in order.
struct EndCaps {
    /// A limit point, or a point that stands for many around a vertex, as a sum of points of the table and of sums
    /// before it.
    struct Limit {
        std::vector<int> points;
        Eigen::RowVectorXd weights;
    };

    std::vector<std::shared_ptr<const CapMatrices>> patterns;
    std::vector<std::optional<EndCap>> surface,
        texture; ///< per patch; none has texture coordinates but not the surface
    std::vector<Limit> limits, texLimits;
};

/// The refined topology of a cage and the patches on it.
struct FarTables {
    std::unique_ptr<Far::TopologyRefiner> refiner;
    std::unique_ptr<const Far::PatchTable> patches;
    EndCaps caps;
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
/// `capLevels`: levels of the matrices of exact end caps.
FarTables makeFarTables(const Cage& cage, const SurfaceOptions& options, int capLevels = int(kCapLevels));

/// Face-varying values, refined and local; 0 without texture coordinates.
inline std::uint32_t texPointCount(const FarTables& tables) {
    if (!tables.hasTexCoords) return 0;
    return std::uint32_t(tables.refiner->GetNumFVarValuesTotal() + tables.patches->GetNumLocalPointsFaceVarying());
}

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

/// Walks from a face's (u,v) to the child that holds it; (u,v) become the child's own coordinates. Children are
/// numbered as in shared/surface.h.
int enterQuadChild(dvec2& uv);
int enterTriangleChild(dvec2& uv);
/// (u,v) of the middle of a patch in its face.
dvec2 patchCenter(const Far::PatchParam& param, int sideCount);

/// Fills in tables.caps: the end caps around which the rules of subdivision stay as they are at all further levels.
/// `levelCount`: of the matrices.
void findEndCaps(FarTables& tables, int levelCount);

/// Faces around a vertex at all.
inline constexpr int kMostRingFaces = 1000;

/// Some semi-sharp edge or vertex is sharper than there are levels.
bool hasFiniteSharpnessPast(const Cage& cage, int isolation);

// The steps of buildSurface, each fills its own part of the surface; the last one uses the tables up.
void fillPatches(Surface& surface, const FarTables& tables);
void fillOwners(Surface& surface, const FarTables& tables, const Cage& cage);
void fillTexPoints(Surface& surface, const FarTables& tables, const std::vector<vec2>& texCoords);
void fillStencils(Surface& surface, FarTables tables);

} // namespace relief
