// Which tiles of a set the faces of a surface lie in.
#include <algorithm>
#include <cmath>

#include "bake/texels.h"

namespace relief {

std::vector<ivec2> findTilesOfFaces(const ReferenceSurface& reference) {
    constexpr int kSteps = 8;
    constexpr double kFarthest = 1e6;
    std::vector<ivec2> tiles;
    const auto isBefore = [](const ivec2& a, const ivec2& b) { return a.y != b.y ? a.y < b.y : a.x < b.x; };
    for (int face = 0; face < reference.faceCount(); ++face)
        for (int i = 0; i < kSteps * kSteps && !reference.isHole(face); ++i) {
            // Inside of the face: on a border of tiles lies no texel.
            const dvec2 uv = (dvec2(i % kSteps, i / kSteps) + 0.5) / double(kSteps);
            if (reference.sideCount() == 3 && uv.x + uv.y >= 1) continue;
            const dvec2 st = reference.texture(face, uv).st;
            const ivec2 place(glm::floor(glm::clamp(st, dvec2(-kFarthest), dvec2(kFarthest))));
            const auto at = std::lower_bound(tiles.begin(), tiles.end(), place, isBefore);
            if (at == tiles.end() || *at != place) tiles.insert(at, place);
        }
    return tiles;
}

} // namespace relief
