#include "mesh/mesh.h"

namespace relief {

std::uint64_t DenseMesh::byteCount() const {
    return positions.size() * sizeof(vec3) + normals.size() * sizeof(vec3) + texCoords.size() * sizeof(vec2) +
           indices.size() * sizeof(std::uint32_t);
}

} // namespace relief
