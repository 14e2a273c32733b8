// Dense triangle meshes: what displaced surfaces are compared with and exported as.
#pragma once

#include <optional>

#include "base/base.h"

namespace relief {

/// Bytes of each part of a triangle mesh in memory.
struct DenseLayout {
    std::uint32_t positionBytes, normalBytes, texCoordBytes; ///< per vertex; 0 where the layout has no such part
    std::uint32_t indexBytes;                                ///< per index; three indices per triangle

    [[nodiscard]] constexpr std::uint32_t vertexBytes() const { return positionBytes + normalBytes + texCoordBytes; }
};
/// Positions, normals and texture coordinates as 32-bit floats, 32-bit indices.
inline constexpr DenseLayout kRawLayout{12, 12, 8, 4};

/// Bytes of a mesh of that many vertices and triangles in a layout.
constexpr std::uint64_t denseBytes(std::uint64_t vertexCount, std::uint64_t triangleCount,
                                   const DenseLayout& layout = kRawLayout) {
    return layout.vertexBytes() * vertexCount + 3 * layout.indexBytes * triangleCount;
}

/// Triangles with one normal and one pair of texture coordinates per vertex.
struct DenseMesh {
    std::vector<vec3> positions, normals;
    std::vector<vec2> texCoords;        ///< empty, or per vertex
    std::vector<std::uint32_t> indices; ///< three per triangle
    std::vector<float> heights;         ///< empty, or per vertex, -1..1: only for pictures, files do not hold them
    Coordinates coordinates;            ///< of the positions

    [[nodiscard]] std::uint64_t byteCount() const;
};

/// Triangles alone: what a sculpt's file says.
struct TriangleMesh {
    std::vector<vec3> positions;
    std::vector<std::uint32_t> indices; ///< three per triangle
    Coordinates coordinates;            ///< of the positions
};

/// True for files that readTriangles reads, by their extension: .ply and .stl.
bool isTriangleFile(const std::string& path);

/// Reads the triangles of a .ply (text, or binary in both orders of bytes; polygons become fans) or an .stl (binary or
/// text; equal positions become one vertex), in a single pass through a buffer of 1 MiB. Positions are stored in
/// `coordinates`, or in coordinates chosen for them.
/// Throws Failure::usage for another extension, Failure::file when reading fails, and Failure::input for a file that is
/// cut off or claims more than it holds (before memory is taken), indices out of range, numbers that are not finite,
/// and no triangles.
TriangleMesh readTriangles(const std::string& path, const std::optional<Coordinates>& coordinates = {});

/// Merges vertices at equal positions. The result has the unit sum of their normals and no texture coordinates, which
/// may differ there. Triangles that lose a corner are removed: a closed surface stays closed.
DenseMesh weldPositions(const DenseMesh& mesh);

/// Derivatives of a mesh's points by its texture coordinates, one of each per vertex, in units of the mesh per unit of
/// s and t. They are as long as the surface stretches the texture, and need not be perpendicular to each other or to
/// the vertex normal.
struct Tangents {
    std::vector<vec3> ps, pt;
};

/// Averages p_s and p_t of the triangles around each vertex, weighted by their angles there. With edges e_i = v_i - v_0
/// and their texture coordinates (Ds_i, Dt_i), a triangle has A = Ds_1 Dt_2 - Ds_2 Dt_1,
///   p_s = (Dt_2 e_1 - Dt_1 e_2) / A,  p_t = (Ds_1 e_2 - Ds_2 e_1) / A.
/// Triangles without area, in space or in the texture, are ignored. Vertices that have no others, or whose average has
/// no plane, get unit vectors perpendicular to the vertex normal and to each other, with p_s x p_t along it.
/// The mesh must have texture coordinates. Call splitMirrored first: where mirrored halves of a texture meet in one
/// vertex, their tangents cancel.
Tangents computeTangents(const DenseMesh& mesh);

/// Splits the vertices that are used by triangles of both orientations in the texture (signs of A): the mirrored ones
/// get copies behind the other vertices. Positions, normals and the order of the triangles do not change. Depends on
/// texture coordinates alone, so that all poses of a mesh are split in the same way.
DenseMesh splitMirrored(DenseMesh mesh);

/// Throws Failure::usage unless the extension of `path` is one that writeMesh supports: .ply, .obj or .glb.
void checkMeshPath(const std::string& path);

/// Throws Failure::input when the format that `path` asks for cannot hold that many: 32-bit indices in .ply, 31 bits in
/// .obj, 4 GiB in .glb. Call it before the triangles are made.
void checkMeshSize(const std::string& path, std::uint64_t vertexCount, std::uint64_t triangleCount, bool hasTexCoords);

/// Writes a mesh by the extension of `path`, whole or not at all, through a buffer of 1 MiB.
///   .ply  binary
///   .obj  reads back to the same bits; each position is written once
///   .glb  glTF 2.0, where t runs down
/// .obj and .glb omit triangles that name a vertex (.obj: a position) twice, because their readers refuse them.
/// Positions are written in world coordinates: as doubles in .obj and .ply (`property double x`), and in .glb, which
/// has floats only, by the translation and scale of its node. Throws as the two checks above, Failure::input for a mesh
/// without triangles, arrays that disagree, indices out of range and numbers that are not finite, Failure::file when
/// writing fails.
void writeMesh(const std::string& path, const DenseMesh& mesh, ShowProgress show = ShowProgress::never);

} // namespace relief
