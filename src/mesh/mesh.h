// Dense triangle meshes: what displaced surfaces are compared with and exported as.
#pragma once

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

/// Triangles with one normal and one texture coordinate a vertex.
struct DenseMesh {
    std::vector<vec3> positions, normals;
    std::vector<vec2> texCoords;        ///< empty, or one a vertex
    std::vector<std::uint32_t> indices; ///< three a triangle
    std::vector<float> heights;         ///< empty, or one a vertex from -1 to 1: to be seen, never written to a file
    Coordinates coordinates;            ///< of the positions

    [[nodiscard]] std::uint64_t byteCount() const;
};

/// Vertices at one position become one, with the sum of their normals and without texture coordinates, which differ
/// there. Triangles that lose a corner so are removed: a closed surface stays closed.
DenseMesh weldPositions(const DenseMesh& mesh);

/// Throws Failure::usage unless the extension of `path` is one that writeMesh knows: .ply, .obj or .glb.
void checkMeshPath(const std::string& path);

/// Throws Failure::input when the format that `path` asks for cannot hold so much: 32-bit indices in .ply, 31 bits in
/// .obj, 4 GiB in .glb. Cheap: to be asked before the triangles are made.
void checkMeshSize(const std::string& path, std::uint64_t vertexCount, std::uint64_t triangleCount, bool hasTexCoords);

/// Writes by the extension of `path`, whole or not at all, through a buffer of 1 MiB: binary .ply, .obj that reads back
/// to the same bits and has each position once, or .glb (glTF 2.0: t turned to run down). .obj and .glb omit triangles
/// that name a vertex (.obj: a position) twice, which their readers refuse. A mesh with coordinates of its own is
/// written in the world: as doubles in .obj and .ply (`property double x`), and in .glb, which has floats only, by the
/// translation and scale of its node. Throws as the two checks above, Failure::input for a mesh without triangles,
/// arrays that disagree, indices out of range and numbers that are not finite, Failure::file when writing fails.
void writeMesh(const std::string& path, const DenseMesh& mesh, ShowProgress show = ShowProgress::never);

} // namespace relief
