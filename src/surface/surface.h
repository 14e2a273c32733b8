// OpenSubdiv's smooth limit surface as flat arrays, and a double-precision reference evaluator of it.
#pragma once

#include <memory>
#include <span>

#include "cage/cage.h"
#include "shared/surface.h"

namespace relief {

enum class Scheme { catmark, loop, bilinear };

struct SurfaceOptions {
    Scheme scheme = Scheme::catmark;
    int isolation = 6; ///< levels of adaptive refinement around features, 0..10
};

/// point[controlPointCount + row] = sum of weights[k] * point[indices[k]], k in [offsets[row], offsets[row+1]).
struct Stencils {
    std::vector<std::uint32_t> offsets; ///< rowCount + 1 entries
    std::vector<std::uint32_t> indices; ///< of points: of the cage, or of shared rows in rows that are not shared
    std::vector<float> weights;
    std::uint32_t sharedRowCount = 0; ///< the first rows; around a vertex of many faces all others need what they sum

    [[nodiscard]] std::size_t rowCount() const { return offsets.empty() ? 0 : offsets.size() - 1; }
};

/// What the device draws: built once for a cage's topology, valid for every pose of it.
struct Surface {
    Scheme scheme = Scheme::catmark;
    int sideCount = 4; ///< sides a face: 4, or 3 for Loop
    std::uint32_t controlPointCount = 0;

    std::vector<Face> faces;         ///< ptex faces in OpenSubdiv's order; holes have root kNoPatch
    std::vector<std::uint32_t> tree; ///< entries; children of one node are four in a row
    std::vector<Patch> patches;
    std::vector<std::uint32_t> patchPoints; ///< point indices: cage points, then stencil rows
    Stencils stencils;                      ///< refined and local points

    std::vector<vec2> texPoints; ///< face-varying points, refined and local; empty without texture coordinates
    std::vector<std::uint32_t> texPatchPoints;

    std::vector<Edge> edges;
    std::vector<Corner> corners;
    std::vector<Incidence> incidences;
    /// Per incidence: drawn faces of its smooth sector, the faces around a corner between two sharp edges. Each sector
    /// counts once in the direction that the faces share, however many faces it has. 1 along edges.
    std::vector<std::uint32_t> sectorFaces;

    bool isClosed = false;   ///< no boundary edges and no holes
    double tableSeconds = 0; ///< time that building took, most of it inside OpenSubdiv

    [[nodiscard]] bool hasTexCoords() const { return !texPoints.empty(); }
    [[nodiscard]] std::uint64_t byteCount() const;
};

/// Refines adaptively, builds patches, stencils, trees and owners. Throws Failure::input for cages that the scheme
/// cannot take (Loop wants triangles) and Failure::usage for an isolation out of range.
Surface buildSurface(const Cage& cage, const SurfaceOptions& options);

/// A leaf of a face's tree. In four-sided faces it covers ([u, u+1], [v, v+1]) / 2^depth.
struct TreeLeaf {
    std::uint32_t patchIndex = 0, depth = 0, u = 0, v = 0;
};
/// The leaves below a tree entry (Face::root); none of a hole.
std::vector<TreeLeaf> leavesOf(std::span<const std::uint32_t> tree, std::uint32_t root);

/// Cage points, then every stencil row: what Surface::patchPoints index. Sums run in double and round once.
std::vector<vec3> refinePoints(const Surface& surface, std::span<const vec3> cagePositions);

/// (u,v) of the point at x in [0,1] along side `side`.
dvec2 sidePoint(int sideCount, int side, double x);

/// All faces along every edge, of smooth edges too (Surface::incidences lists only where normals must be agreed).
struct EdgeIncidences {
    std::vector<std::uint32_t> firsts; ///< edgeCount + 1 entries into incidences
    std::vector<Incidence> incidences; ///< of each edge in index order of the faces: the owner comes first

    [[nodiscard]] std::span<const Incidence> of(std::size_t edge) const {
        return std::span(incidences).subspan(firsts[edge], firsts[edge + 1] - firsts[edge]);
    }
};
EdgeIncidences edgeIncidences(const Surface& surface);
EdgeIncidences edgeIncidences(std::span<const Face> faces, int sideCount, std::size_t edgeCount);

/// True when front and back faces cancel along every line of sight: every edge is run by as many drawn faces one way as
/// the other.
bool enclosesVolume(const Surface& surface);

/// Limit position and its derivatives by face coordinates (u,v).
struct LimitFrame {
    dvec3 p{0}, pu{0}, pv{0}, puu{0}, puv{0}, pvv{0};

    /// False where p_u and p_v are parallel or vanish: at cusps and at straight corners (shared/surface.h).
    [[nodiscard]] bool hasTangentPlane() const;
};

/// Texture coordinates and their Jacobian: columns d(s,t)/du and d(s,t)/dv.
struct TexFrame {
    dvec2 st{0};
    dmat2 jacobian{1};
};

/// The oracle: Far patches in double precision with the library's known traps corrected (n-gon derivative scale, sign
/// of turned triangles, true derivatives of Gregory patches). Shares no code with the shaders.
class ReferenceSurface {
public:
    ReferenceSurface(const Cage& cage, const SurfaceOptions& options);
    ~ReferenceSurface();
    ReferenceSurface(ReferenceSurface&&) noexcept;
    ReferenceSurface& operator=(ReferenceSurface&&) noexcept;

    /// Poses the cage: same count as the cage's positions.
    void pose(std::span<const vec3> cagePositions);

    [[nodiscard]] int faceCount() const; ///< ptex faces, holes included
    [[nodiscard]] int sideCount() const;
    [[nodiscard]] bool isHole(int face) const;
    /// True when (u,v) falls in an end cap at an extraordinary vertex, where the patch only approximates the surface.
    [[nodiscard]] bool isApproximate(int face, const dvec2& uv) const;
    [[nodiscard]] LimitFrame limit(int face, const dvec2& uv) const;
    /// (u,v) itself with the unit Jacobian where the cage has no texture coordinates.
    [[nodiscard]] TexFrame texture(int face, const dvec2& uv) const;
    /// p_u x p_v, which is as long as the area per unit of (u,v). At a corner where p_u and p_v are parallel or vanish:
    /// its derivative along the diagonal from the corner into the face, by differences of points of the patch.
    [[nodiscard]] dvec3 areaNormal(int face, const dvec2& uv) const;
    /// Unit normal: the direction of areaNormal, or where that vanishes as well, of a point slightly towards the face's
    /// centre.
    [[nodiscard]] dvec3 normal(int face, const dvec2& uv) const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace relief
