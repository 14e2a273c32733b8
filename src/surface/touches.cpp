// The faces along every edge, read back from the sides of the faces.
#include <numeric>

#include "surface/surface.h"

namespace relief {
namespace {

/// Calls `visit(edge, touch)` for the one or two edges along a side, as Face::sides says.
template <typename Visit>
void visitSide(const Surface& surface, std::uint32_t face, std::uint32_t side, const Visit& visit) {
    const std::uint32_t entry = surface.faces[face].sides[side];
    const std::uint32_t edge = entry & kSideEdgeMask;
    const bool isReversed = entry & kSideReversed;
    const std::uint32_t pieceCount = entry & kSideSplit ? 2 : 1;
    for (std::uint32_t piece = 0; piece < pieceCount; ++piece) {
        const float first = float(piece) / float(pieceCount), last = float(piece + 1) / float(pieceCount);
        if (isReversed)
            visit(edge + piece, Touch{face, side, 1 - first, 1 - last});
        else
            visit(edge + piece, Touch{face, side, first, last});
    }
}

template <typename Visit>
void visitSides(const Surface& surface, const Visit& visit) {
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        if (surface.faces[face].root == kNoPatch) continue;
        for (int side = 0; side < surface.sideCount; ++side) visitSide(surface, face, std::uint32_t(side), visit);
    }
}

} // namespace

EdgeTouches incidentTouches(const Surface& surface) {
    EdgeTouches result;
    result.firsts.assign(surface.edges.size() + 1, 0);
    visitSides(surface, [&](std::uint32_t edge, const Touch&) { ++result.firsts[edge + 1]; });
    std::partial_sum(result.firsts.begin(), result.firsts.end(), result.firsts.begin());
    result.touches.resize(result.firsts.back());
    std::vector<std::uint32_t> next(result.firsts.begin(), result.firsts.end() - 1);
    visitSides(surface, [&](std::uint32_t edge, const Touch& touch) { result.touches[next[edge]++] = touch; });
    return result;
}

} // namespace relief
