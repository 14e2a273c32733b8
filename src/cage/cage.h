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

/// Consecutive faces with a name and a material.
struct CagePart {
    std::string name;     ///< OBJ: the latest `o` or `g`; may be empty
    std::string material; ///< OBJ: `usemtl`; may be empty
    std::uint32_t firstFace = 0, faceCount = 0;
};

/// Plain arrays; all indices count from 0 and are valid once a loader returns it.
struct Cage {
    std::vector<vec3> positions;          ///< in `coordinates`
    std::vector<std::uint32_t> faceSizes; ///< corners per face, each >= 3
    std::vector<std::uint32_t> corners;   ///< position index, all faces in a row: sum(faceSizes) entries

    std::vector<vec2> texCoords;           ///< face-varying values (s,t), t up; empty when the cage has none
    std::vector<std::uint32_t> texCorners; ///< texCoords index for each corner, or empty
    std::string missingTexCoords; ///< why there are none although some faces name them, for maps that need them; or ""
    std::vector<vec3> normals;    ///< only for dense meshes; subdivision ignores them
    std::vector<std::uint32_t> normalCorners; ///< normals index for each corner, or empty

    std::vector<std::uint32_t> creaseEdges;   ///< pairs of position indices; every pair is an edge of some face
    std::vector<float> creaseSharpness;       ///< per edge of creaseEdges; >= 10 is infinitely sharp
    std::vector<std::uint32_t> sharpVertices; ///< position indices
    std::vector<float> vertexSharpness;       ///< per vertex of sharpVertices
    std::vector<std::uint32_t> holes;         ///< face indices that are not drawn

    BoundaryRule boundaryRule = BoundaryRule::edgeOnly;
    TexBoundaryRule texBoundaryRule = TexBoundaryRule::cornersPlus1;
    CreaseMethod creaseMethod = CreaseMethod::uniform;

    std::vector<CagePart> parts; ///< empty, or parts that cover all faces in order

    Coordinates coordinates; ///< of the positions; loaders choose them for the vertices that faces use

    [[nodiscard]] std::size_t faceCount() const { return faceSizes.size(); }
    [[nodiscard]] bool hasTexCoords() const { return !texCorners.empty(); }
    [[nodiscard]] bool isAllTriangles() const;

    /// Bytes that the cage takes as flat arrays: positions, face sizes, corners, texture coordinates, tags.
    [[nodiscard]] std::uint64_t byteCount() const;
};

/// Reads a cage by the extension of `path`: .obj, or .gltf and .glb.
///
/// From glTF 2.0 it takes the triangles of all meshes in the file's scene, in world coordinates and unanimated.
/// Vertices of one node whose positions have the same bits are merged, so that seams and hard edges are no boundaries;
/// texture coordinates and normals stay separate. Triangles of meshes without normals get a face normal each. A part is
/// a primitive, named after its node (or its mesh) and its material.
///
/// Things that have one sensible reading (hierarchical edits, unknown tags) are reported to `warn`.
/// Throws Failure::file when the file cannot be read and Failure::input, naming file and line or element, for anything
/// that is not a valid cage.
Cage readCage(const std::string& path, const Warn& warn = warnOnStderr);

/// Parses the text of an OBJ file; `name` stands for the file in messages. Positions are read in double precision, and
/// stored in `coordinates` where those are given.
///
/// Tags count vertices and faces from 0 through the whole file, whatever object they belong to. Degenerate faces (fewer
/// than 3 corners, a vertex used twice), corners that repeat the one before and normals that only some faces have are
/// dropped with a warning; texture coordinates that only some faces have are dropped without one
/// (Cage::missingTexCoords).
/// Throws as readCage does.
Cage parseObj(const std::string& text, const std::string& name, const Warn& warn = warnOnStderr,
              const std::optional<Coordinates>& coordinates = {});

/// Writes positions in world coordinates, texture coordinates, faces, tags and parts as OBJ, whole or not at all.
/// Throws Failure::file when writing fails.
void writeObj(const std::string& path, const Cage& cage);

/// Checks a cage. Loaders call it; code that builds cages may. `name` stands for the file in messages.
/// Throws Failure::input when an index is out of range, a face has fewer than 3 corners, a number is not finite, a
/// crease names no edge, a sharpness is negative or array sizes disagree.
void validateCage(const Cage& cage, const std::string& name);

/// A cage whose coincident vertices are joined.
struct WeldedCage {
    Cage cage;
    std::vector<std::uint32_t> sources; ///< per vertex: its index in the original cage
};

/// Merges boundary vertices (ends of edges that only one face has) that are at most `distance` cage units apart; the
/// lowest index among them stays. 0 merges only equal positions. Other vertices are not merged: solids that meet stay
/// separate.
/// Face-varying values and tags follow: equal texture coordinates there are merged, and of creases and sharp vertices
/// that are merged the sharpest is kept. Corners that would repeat a vertex, faces that degenerate, and the holes and
/// creases of these are removed.
/// Throws Failure::usage for a distance below 0.
WeldedCage weld(Cage cage, double distance);

/// Counts the vertices that weld(cage, 0) removes.
std::uint64_t countCoincidentVertices(const Cage& cage);

/// Chooses a nearer origin for a cage that has moved away from its own; world positions do not change.
void recenter(Cage& cage);

/// Counts and sizes of a cage, as `relief info` prints them.
struct CageSummary {
    std::uint64_t vertexCount = 0, faceCount = 0, edgeCount = 0, cornerCount = 0;
    std::uint64_t triangleCount = 0, quadCount = 0, otherFaceCount = 0;
    std::uint64_t boundaryEdgeCount = 0;
    std::uint64_t nonManifoldEdgeCount = 0; ///< with two faces in one direction, or more than two faces
    std::uint64_t irregularVertexCount = 0; ///< interior vertices of valence != 4 (quads) or != 6 (all triangles)
    std::uint64_t maxValence = 0, unusedVertexCount = 0;
    std::uint64_t creasedEdgeCount = 0, sharpVertexCount = 0, holeCount = 0;
    std::uint64_t texCoordCount = 0, seamEdgeCount = 0; ///< edges whose two faces disagree about texture coordinates
    Bounds bounds;                                      ///< of the vertices that faces use, in world coordinates
};
CageSummary summarize(const Cage& cage);

/// Splits polygons into fans of triangles, without subdivision. Vertices repeat only where normals or texture
/// coordinates differ. Without normals in the file, those of a vertex are the area-weighted sum over its faces.
DenseMesh denseMesh(const Cage& cage);

} // namespace relief
