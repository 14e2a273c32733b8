// Binary PLY: a header of lines, then the vertices with all their attributes, then the triangles.
#include <bit>

#include "mesh/write.h"

namespace relief {

static_assert(std::endian::native == std::endian::little, "PLY and glTF are written as the bytes lie in memory");

namespace {

std::string headerOf(const DenseMesh& mesh) {
    std::string properties;
    const char* type = mesh.coordinates.isIdentity() ? "float" : "double"; // far away, floats cannot hold the world's
    for (const char* name : {"x", "y", "z"}) properties += fmt::format("property {} {}\n", type, name);
    for (const char* name : {"nx", "ny", "nz"}) properties += fmt::format("property float {}\n", name);
    if (!mesh.texCoords.empty()) properties += "property float s\nproperty float t\n";
    return fmt::format("ply\nformat binary_little_endian 1.0\ncomment written by relief\nelement vertex {}\n{}"
                       "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                       mesh.positions.size(), properties, mesh.indices.size() / 3);
}

} // namespace

void writePly(MeshFile& file, const DenseMesh& mesh, ShowProgress show) {
    const std::size_t triangleCount = mesh.indices.size() / 3;
    Progress progress("writing", mesh.positions.size() + triangleCount, show);
    file.put(headerOf(mesh));
    putEach(mesh.positions.size(), progress, [&](std::size_t i) {
        if (mesh.coordinates.isIdentity())
            file.putValue(mesh.positions[i]);
        else
            file.putValue(mesh.coordinates.toWorld(mesh.positions[i]));
        file.putValue(mesh.normals[i]);
        if (!mesh.texCoords.empty()) file.putValue(mesh.texCoords[i]);
    });
    putEach(triangleCount, progress, [&](std::size_t i) {
        file.putValue(std::uint8_t(3));
        for (std::size_t k = 0; k < 3; ++k) file.putValue(mesh.indices[3 * i + k]);
    });
}

} // namespace relief
