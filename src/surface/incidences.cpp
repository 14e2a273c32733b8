// The faces along every edge, read back from the sides of the faces.
#include <numeric>

#include "surface/surface.h"

namespace relief {
namespace {

/// Calls `visit(edge, incidence)` for the one or two edges along a side, as Face::sides says.
template <typename Visit>
void visitSide(std::span<const Face> faces, std::uint32_t face, std::uint32_t side, const Visit& visit) {
    const std::uint32_t entry = faces[face].sides[side];
    const std::uint32_t edge = entry & kSideEdgeMask;
    const bool isReversed = entry & kSideReversed;
    const std::uint32_t pieceCount = entry & kSideSplit ? 2 : 1;
    for (std::uint32_t piece = 0; piece < pieceCount; ++piece) {
        const float first = float(piece) / float(pieceCount), last = float(piece + 1) / float(pieceCount);
        if (isReversed)
            visit(edge + piece, Incidence{face, side, 1 - first, 1 - last});
        else
            visit(edge + piece, Incidence{face, side, first, last});
    }
}

template <typename Visit>
void visitSides(std::span<const Face> faces, int sideCount, const Visit& visit) {
    for (std::uint32_t face = 0; face < faces.size(); ++face) {
        if (faces[face].root == kNoPatch) continue;
        for (int side = 0; side < sideCount; ++side) visitSide(faces, face, std::uint32_t(side), visit);
    }
}

} // namespace

EdgeIncidences edgeIncidences(std::span<const Face> faces, int sideCount, std::size_t edgeCount) {
    EdgeIncidences result;
    result.firsts.assign(edgeCount + 1, 0);
    visitSides(faces, sideCount, [&](std::uint32_t edge, const Incidence&) { ++result.firsts[edge + 1]; });
    std::partial_sum(result.firsts.begin(), result.firsts.end(), result.firsts.begin());
    result.incidences.resize(result.firsts.back());
    std::vector<std::uint32_t> next(result.firsts.begin(), result.firsts.end() - 1);
    visitSides(faces, sideCount,
               [&](std::uint32_t edge, const Incidence& incidence) { result.incidences[next[edge]++] = incidence; });
    return result;
}

EdgeIncidences edgeIncidences(const Surface& surface) {
    return edgeIncidences(surface.faces, surface.sideCount, surface.edges.size());
}

bool enclosesVolume(const Surface& surface) {
    const EdgeIncidences incidences = edgeIncidences(surface);
    for (std::size_t edge = 0; edge < surface.edges.size(); ++edge) {
        int balance = 0;
        for (const Incidence& incidence : incidences.of(edge)) balance += incidence.start < incidence.end ? 1 : -1;
        if (balance != 0) return false;
    }
    return true;
}

} // namespace relief
