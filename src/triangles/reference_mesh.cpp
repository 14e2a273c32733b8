#include "triangles/stages.h"

namespace relief {

DenseMesh denseMesh(const ReferenceSurface& surface, const HeightMap* map, int rate) {
    if (surface.sideCount() != 4) fail(Failure::usage, "a grid of four-sided faces is not to be had of triangles");
    const std::vector<std::uint32_t> grid = gridIndices(std::uint32_t(rate), std::uint32_t(rate));
    DenseMesh mesh;
    for (int face = 0; face < surface.faceCount(); ++face) {
        if (surface.isHole(face)) continue;
        const auto first = std::uint32_t(mesh.positions.size());
        for (int j = 0; j <= rate; ++j)
            for (int i = 0; i <= rate; ++i) {
                const DisplacedFrame f = displacedFrame(surface, map, face, dvec2(i, j) / double(rate));
                mesh.positions.emplace_back(f.q);
                mesh.normals.emplace_back(f.full);
                mesh.texCoords.emplace_back(f.tex.st);
            }
        for (const std::uint32_t index : grid) mesh.indices.push_back(first + index);
    }
    return mesh;
}

} // namespace relief
