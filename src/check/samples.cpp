// Points that cover a surface.
#include <algorithm>
#include <cmath>

#include "check/check.h"

namespace relief {
namespace {

struct Leaf {
    const Patch* patch = nullptr;
    vec2 uv{0}; ///< in the patch
};

/// Descends the face's tree as shared/surface.h draws it.
Leaf leafAt(const Surface& surface, const SampleQuery& query) {
    vec2 uv = query.uv;
    std::uint32_t entry = surface.faces[query.face].root;
    while ((entry & kLeafBit) == 0) {
        std::uint32_t child = 0;
        if (surface.sideCount == 4) {
            child = (uv.x >= 0.5f ? 1u : 0u) + (uv.y >= 0.5f ? 2u : 0u);
            uv = 2.0f * uv - vec2(child & 1, child >> 1);
        } else {
            child = uv.x >= 0.5f ? 1 : uv.y >= 0.5f ? 2 : uv.x + uv.y > 0.5f ? 3 : 0;
            uv = 2.0f * (child == 3 ? 0.5f - uv : uv - vec2(child == 1 ? 0.5f : 0.0f, child == 2 ? 0.5f : 0.0f));
        }
        entry = surface.tree[entry + child];
    }
    return {&surface.patches[entry & ~kLeafBit], uv};
}

/// The second derivatives of a Gregory patch have no value in its corners, nor have those of the surface at an
/// extraordinary vertex.
bool hasCurvature(const Surface& surface, const SampleQuery& query) {
    const Leaf leaf = leafAt(surface, query);
    const auto isEnd = [](float x) { return x <= 0 || x >= 1; };
    const std::uint32_t type = leaf.patch->type;
    if (type == kPatchExactQuad || type == kPatchExactTriangle)
        return dvec2(leaf.uv) != sidePoint(surface.sideCount, int(leaf.patch->cap % 4), 0);
    const bool isGregory = type == kPatchGregory || type == kPatchGregoryTriangle;
    return !(isGregory && isEnd(leaf.uv.x) && isEnd(leaf.uv.y));
}

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
    for (const SampleQuery& query : samples.queries) samples.hasCurvature.push_back(hasCurvature(surface, query));
    return samples;
}

} // namespace relief
