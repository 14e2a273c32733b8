// Points that cover a surface.
#include <algorithm>
#include <cmath>

#include "check/check.h"

namespace relief {
namespace {

/// Weights of the trapezoidal rule in both directions.
void addQuad(SurfaceSamples& samples, std::uint32_t face, int side) {
    const auto share = [&](int i) { return (i == 0 || i == side - 1 ? 0.5 : 1.0) / (side - 1); };
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            samples.queries.push_back({face, vec2(i, j) / float(side - 1)});
            samples.weights.push_back(share(i) * share(j));
        }
}

/// Each of the small triangles gives a third of its area to its corners: 6 meet inside, 3 on sides, 1 in corners.
void addTriangle(SurfaceSamples& samples, std::uint32_t face, int side) {
    const int last = side - 1;
    const double third = 1.0 / (6.0 * last * last);
    for (int j = 0; j <= last; ++j)
        for (int i = 0; i <= last - j; ++i) {
            const int sidesHere = int(i == 0) + int(j == 0) + int(i + j == last);
            samples.queries.push_back({face, vec2(i, j) / float(last)});
            samples.weights.push_back(third * (sidesHere == 0 ? 6 : sidesHere == 1 ? 3 : 1));
        }
}

} // namespace

SurfaceSamples sampleEverywhere(const Surface& surface, std::size_t budget) {
    const auto isDrawn = [](const Face& face) { return face.root != kNoPatch; };
    const auto drawnCount = std::max<std::ptrdiff_t>(std::ranges::count_if(surface.faces, isDrawn), 1);
    const double perFace = double(budget) / double(drawnCount);
    const bool isTriangles = surface.sideCount == 3;
    // n (n + 1) / 2 <= perFace, or n^2 <= perFace; fewer would leave faces without a point inside.
    const int side =
        isTriangles ? std::max(int((std::sqrt(1 + 8 * perFace) - 1) / 2), 4) : std::max(int(std::sqrt(perFace)), 3);
    SurfaceSamples samples;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        if (!isDrawn(surface.faces[face])) continue;
        if (isTriangles)
            addTriangle(samples, face, side);
        else
            addQuad(samples, face, side);
    }
    return samples;
}

} // namespace relief
