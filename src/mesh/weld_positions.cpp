// One vertex a position: what programs that print or simulate a solid want, which know neither seams nor hard edges.
#include "base/unique_points.h"
#include "mesh/mesh.h"

namespace relief {

DenseMesh weldPositions(const DenseMesh& mesh) {
    const UniquePoints places = findUniquePoints(mesh.positions);
    DenseMesh welded;
    welded.coordinates = mesh.coordinates;
    for (const std::uint32_t first : places.firsts) welded.positions.push_back(mesh.positions[first]);

    std::vector<dvec3> sums(places.count(), dvec3(0));
    for (std::size_t i = 0; i < mesh.normals.size(); ++i) sums[places.indices[i]] += dvec3(mesh.normals[i]);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        const bool isNormal = glm::dot(sums[i], sums[i]) > 1e-12; // those of a thin sheet's two sides cancel
        welded.normals.push_back(isNormal ? vec3(glm::normalize(sums[i])) : mesh.normals[places.firsts[i]]);
    }
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto place = [&](std::size_t k) { return places.indices[mesh.indices[i + k]]; };
        if (place(0) != place(1) && place(1) != place(2) && place(2) != place(0))
            welded.indices.insert(welded.indices.end(), {place(0), place(1), place(2)});
    }
    return welded;
}

} // namespace relief
