// Control cages: polygons with subdivision tags, in files and in memory.
#pragma once

#include <optional>

#include "base/base.h"
#include "mesh/mesh.h"

namespace relief {

/// How OpenSubdiv treats a boundary of the cage (t interpolateboundary).
enum class BoundaryRule { none = 0, edgeAndCorner = 1, edgeOnly = 2 };

/// How texture coordinates are smoothed (t facevaryinginterpolateboundary): which parts stay linear.
enum class TexBoundaryRule { none = 0, cornersOnly = 1, cornersPlus1 = 2, cornersPlus2 = 3, boundaries = 4, all = 5 };

enum class CreaseMethod { uniform, chaikin };

/// A named run of faces.
struct CagePart {
    std::string name;     ///< OBJ: the latest `o` or `g`; may be empty
    std::string material; ///< OBJ: `usemtl`; may be empty
    std::uint32_t firstFace = 0, faceCount = 0;
};

/// Plain arrays; all indices count from 0 and are valid once a loader returns it.
struct Cage {
    std::vector<vec3> positions;          ///< in `coordinates`
    std::vector<std::uint32_t> faceSizes; ///< corners a face, each >= 3
    std::vector<std::uint32_t> corners;   ///< position index, all faces in a row: sum(faceSizes) entries

    std::vector<vec2> texCoords;           ///< face-varying values (s,t), t up; empty when the cage has none
    std::vector<std::uint32_t> texCorners; ///< texCoords index for each corner, or empty
    std::string missingTexCoords; ///< why there are none although some faces name them, for maps that need them; or ""
    std::vector<vec3> normals;    ///< only for dense meshes; subdivision ignores them
    std::vector<std::uint32_t> normalCorners; ///< normals index for each corner, or empty

    std::vector<std::uint32_t> creaseEdges;   ///< pairs of position indices; every pair is an edge of some face
    std::vector<float> creaseSharpness;       ///< one an edge; >= 10 is infinitely sharp
    std::vector<std::uint32_t> sharpVertices; ///< position indices
    std::vector<float> vertexSharpness;       ///< one a sharp vertex
    std::vector<std::uint32_t> holes;         ///< face indices that are not drawn

    BoundaryRule boundaryRule = BoundaryRule::edgeOnly;
    TexBoundaryRule texBoundaryRule = TexBoundaryRule::cornersPlus1;
    CreaseMethod creaseMethod = CreaseMethod::uniform;

    std::vector<CagePart> parts; ///< empty, or runs that cover all faces in order

    Coordinates coordinates; ///< of the positions; loaders choose them for the vertices that faces use

    [[nodiscard]] std::size_t faceCount() const { return faceSizes.size(); }
    [[nodiscard]] bool hasTexCoords() const { return !texCorners.empty(); }
    [[nodiscard]] bool isAllTriangles() const;

    /// Bytes that the cage takes as flat arrays: positions, face sizes, corners, texture coordinates, tags.
    [[nodiscard]] std::uint64_t byteCount() const;
};

/// Reads a cage by the extension of `path`: .obj, or .gltf and .glb. Throws Failure::file when it cannot be read and
/// Failure::input, naming file and line or element, for anything that is not a valid cage. Oddities that have one
/// sensible reading (hierarchical edits, unknown tags) go to `warn`.
///
/// From glTF 2.0 it takes the triangles of all meshes in the file's scene, where they stand in the world when no
/// animation moves them. Vertices of one node with the same bits of position become one, so that seams and hard edges
/// are no boundaries; a vertex's texture coordinates and normals stay its own. Triangles of meshes without
/// normals are flat: each has one of its own. A part is a primitive, named after its node (or its mesh) and its
/// material.
Cage readCage(const std::string& path, const Warn& warn = warnOnStderr);

/// The same from text in memory; `name` stands for the file in messages.
/// Tags count vertices and faces from 0 through the whole file, whatever object they stand in. Degenerate faces (fewer
/// than 3 corners, a vertex used twice), corners that repeat the one before and normals that some faces lack are
/// dropped with a warning, texture coordinates that some faces lack without one (Cage::missingTexCoords). Positions are
/// read in double precision, and stored in `coordinates` where those are given.
Cage parseObj(const std::string& text, const std::string& name, const Warn& warn = warnOnStderr,
              const std::optional<Coordinates>& coordinates = {});

/// Writes positions in the world, texture coordinates, faces, tags and parts as OBJ, whole or not at all.
void writeObj(const std::string& path, const Cage& cage);

/// Throws Failure::input when an index is out of range, a face has fewer than 3 corners, a number is not finite, a
/// crease names no edge, a sharpness is negative or array sizes disagree. Every loader calls it; code that builds cages
/// may.
void validateCage(const Cage& cage, const std::string& name);

/// A cage whose coincident vertices are joined.
struct WeldedCage {
    Cage cage;
    std::vector<std::uint32_t> sources; ///< for each of its vertices the one of the original cage that it was
};

/// Joins vertices on boundaries (ends of edges that one face has alone) that are at most `distance` cage units apart
/// with the one of the lowest index among them; 0 joins what is at the very same place. Others are not joined: solids
/// that meet stay separate. Face-varying values and tags follow: texture coordinates that are equal there become one,
/// of creases and sharp vertices that come together the sharpest holds. Corners that would repeat a vertex and faces
/// that degenerate are removed, and so are holes and creases of those. Throws Failure::usage for a distance below 0.
WeldedCage weld(Cage cage, double distance);

/// How many vertices weld(cage, 0) removes.
std::uint64_t countCoincidentVertices(const Cage& cage);

/// Takes an origin nearer to the cage where it has moved away from its own; its positions in the world stay the same.
void recenter(Cage& cage);

/// What `relief info` prints of a cage.
struct CageSummary {
    std::uint64_t vertexCount = 0, faceCount = 0, edgeCount = 0, cornerCount = 0;
    std::uint64_t triangleCount = 0, quadCount = 0, otherFaceCount = 0;
    std::uint64_t boundaryEdgeCount = 0, nonManifoldEdgeCount = 0; ///< two faces in one direction, or more than two
    std::uint64_t irregularVertexCount = 0; ///< interior vertices of valence != 4 (quads) or != 6 (all triangles)
    std::uint64_t maxValence = 0, unusedVertexCount = 0;
    std::uint64_t creasedEdgeCount = 0, sharpVertexCount = 0, holeCount = 0;
    std::uint64_t texCoordCount = 0, seamEdgeCount = 0; ///< edges whose two faces disagree about texture coordinates
    Bounds bounds;                                      ///< of the vertices that faces use, in the world
};
CageSummary summarize(const Cage& cage);

/// Polygons as fans of triangles, without subdivision. Vertices repeat only where normals or texture coordinates
/// differ; normals that the file lacks are the area-weighted sum of the faces around a vertex.
DenseMesh denseMesh(const Cage& cage);

} // namespace relief
