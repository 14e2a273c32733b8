// OpenSubdiv's smooth limit surface as flat arrays, and a double-precision reference evaluator of it.
#pragma once

#include <cmath>
#include <memory>
#include <span>

#include "cage/cage.h"
#include "shared/surface.h"

namespace relief {

/// Rules of subdivision: Catmull-Clark, Loop (triangles only), bilinear.
enum class Scheme { catmark, loop, bilinear };

/// What stands for the surface in faces at extraordinary vertices.
enum class EndCapKind {
    exact,  ///< the limit surface; Gregory patches where rules stay semi-sharp
    gregory ///< OpenSubdiv's patches, which approximate it
};

/// Levels of adaptive refinement that separate extraordinary vertices from each other.
inline constexpr int kSeparation = 2;

/// Levels of adaptive refinement that a cage needs: kSeparation, or as many as semi-sharp creases and vertices are
/// sharp; where tables would grow past 100 MB for these, 6 at most. 6 with Gregory patches, which only get nearer to
/// the surface with each level.
int neededIsolation(const Cage& cage, EndCapKind endCaps);

struct SurfaceOptions {
    Scheme scheme = Scheme::catmark;
    int isolation = 6; ///< levels of adaptive refinement around features, 0..10
    EndCapKind endCaps = EndCapKind::exact;
    /// Of these levels, those around extraordinary vertices, 0..isolation: exact end caps need no more than
    /// kSeparation. With Gregory patches it is not read: all levels are around extraordinary vertices.
    int separation = kSeparation;
};

/// Weights of one pattern of rules around an extraordinary vertex (surface/caps.h).
struct CapTable {
    std::uint32_t firstWeight = 0; ///< into Surface::capWeights
    std::uint32_t pointCount =
        0; ///< that a patch has: the limit point, those around the cap, then the limit point again until 4 divides it
};

/// A sparse matrix that makes refined points of control points:
/// point[controlPointCount + row] = sum of weight(row, k) * point[indices[k]], k in [offsets[row], offsets[row+1]).
struct Stencils {
    std::vector<std::uint32_t> offsets; ///< rowCount + 1 entries
    std::vector<std::uint32_t> indices; ///< points of the cage; rows that are not shared may also name shared rows
    std::vector<std::int32_t> weights;  ///< finer than floats where weights are large
    std::vector<std::int8_t> scales; ///< per row: weights are those numbers times 2^scale, and add up to less than 2^31
    std::uint32_t sharedRowCount = 0; ///< the first rows: partial sums that all rows around a vertex of many faces need

    [[nodiscard]] std::size_t rowCount() const { return offsets.empty() ? 0 : offsets.size() - 1; }
    [[nodiscard]] double weight(std::size_t row, std::size_t k) const { return std::ldexp(weights[k], scales[row]); }
};

/// The limit surface as arrays that the device draws. Built once for a cage's topology, valid for every pose of it.
struct Surface {
    Scheme scheme = Scheme::catmark;
    int sideCount = 4; ///< sides per face: 4, or 3 for Loop
    std::uint32_t controlPointCount = 0;

    std::vector<Face> faces;         ///< ptex faces in OpenSubdiv's order; holes have root kNoPatch
    std::vector<std::uint32_t> tree; ///< entries; children of one node are four in a row
    std::vector<Patch> patches;
    std::vector<std::uint32_t> patchPoints; ///< point indices: cage points, then stencil rows
    Stencils stencils;                      ///< refined and local points
    std::vector<CapTable> capTables;        ///< of patches of the kinds kPatchExactQuad and kPatchExactTriangle
    std::vector<float> capWeights;          ///< as shared/surface.h says

    std::vector<vec2> texPoints; ///< face-varying points, refined and local; empty without texture coordinates
    std::vector<std::uint32_t> texPatchPoints;
    std::vector<std::uint32_t> texCaps; ///< per patch: Patch::cap of its texture coordinates; empty without these

    std::vector<Edge> edges;
    std::vector<Corner> corners;
    std::vector<Incidence> incidences;
    /// Per incidence: number of drawn faces in its smooth sector, which are the faces around a corner between two sharp
    /// edges. Each sector counts once in the shared direction of displacement, however many faces it has. 1 along
    /// edges.
    std::vector<std::uint32_t> sectorFaces;

    bool isClosed = false;   ///< no boundary edges and no holes
    double tableSeconds = 0; ///< duration of building, most of it inside OpenSubdiv

    [[nodiscard]] bool hasTexCoords() const { return !texPoints.empty(); }
    [[nodiscard]] std::uint64_t byteCount() const;
};

/// Refines a cage adaptively and builds patches, stencils, trees and owners.
/// Throws Failure::input for cages that the scheme does not allow (Loop needs triangles) and Failure::usage for an
/// isolation out of range.
Surface buildSurface(const Cage& cage, const SurfaceOptions& options);

/// Lists the faces of the cage that hold patches which only approximate the limit surface although exact end caps were
/// asked for, in rising order: beside semi-sharp creases and vertices that are sharper than the isolation, where the
/// isolation does not separate extraordinary vertices, and where texture coordinates end at linear boundaries.
/// `surface`: the one that was built of the cage with these options; it is built where there is none and need for it.
std::vector<std::uint32_t> listApproximateFaces(const Cage& cage, const SurfaceOptions& options,
                                                const Surface* surface = nullptr);

/// A leaf of a face's tree. In four-sided faces it covers ([u, u+1], [v, v+1]) / 2^depth.
struct TreeLeaf {
    std::uint32_t patchIndex = 0, depth = 0, u = 0, v = 0;
};
/// Lists the leaves below a tree entry (Face::root); a hole has none.
std::vector<TreeLeaf> leavesOf(std::span<const std::uint32_t> tree, std::uint32_t root);

/// Computes the points that Surface::patchPoints index, in double precision: cage points, then every stencil row.
std::vector<dvec3> refinePoints(const Surface& surface, std::span<const vec3> cagePositions);

/// Computes (u,v) of the point at x in [0,1] along a side of a face.
dvec2 sidePoint(int sideCount, int side, double x);

/// The faces along every edge, smooth edges included (Surface::incidences lists only edges and corners whose faces
/// share a direction of displacement).
struct EdgeIncidences {
    std::vector<std::uint32_t> firsts; ///< edgeCount + 1 entries into incidences
    std::vector<Incidence> incidences; ///< per edge in index order of the faces: the owner comes first

    [[nodiscard]] std::span<const Incidence> of(std::size_t edge) const {
        return std::span(incidences).subspan(firsts[edge], firsts[edge + 1] - firsts[edge]);
    }
};
EdgeIncidences edgeIncidences(const Surface& surface);
EdgeIncidences edgeIncidences(std::span<const Face> faces, int sideCount, std::size_t edgeCount);

/// True for closed and oriented surfaces: along every edge as many drawn faces run one way as the other, so that front
/// and back faces alternate along every line of sight.
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

/// Evaluates the limit surface in double precision: the reference that the shaders are compared with, and which shares
/// no code with them. It uses OpenSubdiv's Far patches and corrects their known faults (scale of derivatives in n-gons,
/// sign of rotated triangles, derivatives of Gregory patches).
class ReferenceSurface {
public:
    ReferenceSurface(const Cage& cage, const SurfaceOptions& options);
    ~ReferenceSurface();
    ReferenceSurface(ReferenceSurface&&) noexcept;
    ReferenceSurface& operator=(ReferenceSurface&&) noexcept;

    /// Moves the cage. Throws Failure::input unless there are as many positions as the cage has.
    void pose(std::span<const vec3> cagePositions);

    [[nodiscard]] int faceCount() const; ///< ptex faces, holes included
    [[nodiscard]] int sideCount() const;
    [[nodiscard]] bool hasTexCoords() const;
    [[nodiscard]] bool isHole(int face) const;
    /// True when (u,v) falls in an end cap at an extraordinary vertex, where the patch only approximates the surface.
    [[nodiscard]] bool isApproximate(int face, const dvec2& uv) const;
    /// In a corner of an exact end cap the faces that the slowest wave of normals around the vertex takes: all of the
    /// vertex, or twice as many as lie between two sharp edges or are at a dart; 0 elsewhere. The more they are, the
    /// nearer to the vertex normals are those of a cone.
    [[nodiscard]] int facesPerWave(int face, const dvec2& corner) const;
    /// Position and derivatives. Throws Failure::input for a face out of range and for holes, as all evaluations do.
    [[nodiscard]] LimitFrame limit(int face, const dvec2& uv) const;
    /// Texture coordinates; (u,v) itself with the unit Jacobian where the cage has none.
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
