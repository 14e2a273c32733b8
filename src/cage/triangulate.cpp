#include <unordered_map>

#include "cage/cage.h"

namespace relief {
namespace {

/// A vertex of the dense mesh: the same position may serve several texture coordinates and normals.
struct VertexKey {
    std::uint32_t position, texCoord, normal;
    bool operator==(const VertexKey&) const = default;
};

struct VertexHash {
    std::size_t operator()(const VertexKey& k) const {
        return (std::size_t(k.position) * 0x9e3779b97f4a7c15u) ^ (std::size_t(k.texCoord) << 21) ^
               (std::size_t(k.normal) << 42);
    }
};

/// Sum of the area-weighted normals (Newell's for polygons) of the faces around each position, unit.
std::vector<vec3> smoothNormals(const Cage& cage) {
    std::vector<dvec3> sums(cage.positions.size(), dvec3(0));
    std::size_t first = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        dvec3 area(0);
        for (std::uint32_t i = 0; i < size; ++i)
            area += glm::cross(dvec3(cage.positions[cage.corners[first + i]]),
                               dvec3(cage.positions[cage.corners[first + (i + 1) % size]]));
        for (std::uint32_t i = 0; i < size; ++i) sums[cage.corners[first + i]] += area;
        first += size;
    }
    std::vector<vec3> normals(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        normals[i] = glm::dot(sums[i], sums[i]) > 0 ? vec3(glm::normalize(sums[i])) : vec3(0, 1, 0);
    return normals;
}

} // namespace

DenseMesh denseMesh(const Cage& cage) {
    const bool hasNormals = !cage.normalCorners.empty();
    const std::vector<vec3> smooth = hasNormals ? std::vector<vec3>() : smoothNormals(cage);
    DenseMesh mesh;
    mesh.coordinates = cage.coordinates;

    // Corners with the same position, texture coordinates and normal share a vertex.
    std::unordered_map<VertexKey, std::uint32_t, VertexHash> vertices;
    const auto vertexOf = [&](std::size_t corner) {
        const VertexKey key{cage.corners[corner], cage.hasTexCoords() ? cage.texCorners[corner] : 0,
                            hasNormals ? cage.normalCorners[corner] : 0};
        const auto [entry, isNew] = vertices.try_emplace(key, std::uint32_t(mesh.positions.size()));
        if (isNew) {
            mesh.positions.push_back(cage.positions[key.position]);
            mesh.normals.push_back(hasNormals ? cage.normals[key.normal] : smooth[key.position]);
            if (cage.hasTexCoords()) mesh.texCoords.push_back(cage.texCoords[key.texCoord]);
        }
        return entry->second;
    };

    // Each polygon becomes a fan around its first corner.
    std::size_t first = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        for (std::uint32_t i = 2; i < size; ++i)
            for (const std::size_t corner : {first, first + i - 1, first + i}) mesh.indices.push_back(vertexOf(corner));
        first += size;
    }
    return mesh;
}

} // namespace relief
