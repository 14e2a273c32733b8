// One vertex per position: what programs that print or simulate a solid need, which support neither seams nor hard
// edges.
#include "base/unique_points.h"
#include "mesh/mesh.h"

namespace relief {

DenseMesh weldPositions(const DenseMesh& mesh) {
    const UniquePoints positions = findUniquePoints(mesh.positions);
    DenseMesh welded;
    welded.coordinates = mesh.coordinates;
    for (const std::uint32_t first : positions.firsts) welded.positions.push_back(mesh.positions[first]);

    std::vector<dvec3> sums(positions.count(), dvec3(0));
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) sums[positions.indices[i]] += dvec3(mesh.normals[i]);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const bool isNormal = glm::dot(sums[i], sums[i]) > 1e-12; // those of a thin sheet's two sides cancel
        welded.normals.push_back(isNormal ? vec3(glm::normalize(sums[i])) : mesh.normals[positions.firsts[i]]);
    }
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto positionOf = [&](std::size_t k) { return positions.indices[mesh.indices[i + k]]; };
        if (positionOf(0) != positionOf(1) && positionOf(1) != positionOf(2) && positionOf(2) != positionOf(0))
            welded.indices.insert(welded.indices.end(), {positionOf(0), positionOf(1), positionOf(2)});
    }
    return welded;
}

} // namespace relief
