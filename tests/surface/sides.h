// The sides of faces and the edges along them, read back from a Surface.
#pragma once

#include "surface/surface.h"

namespace relief {

inline bool isSame(const Incidence& a, const Incidence& b) {
    return a.face == b.face && a.side == b.side && a.start == b.start && a.end == b.end;
}

/// How one side of a face sees one edge: at x = start + t (end - start).
struct Piece {
    std::uint32_t edge;
    Incidence incidence;
};

/// Reads Face::sides as its comment says.
inline std::vector<Piece> piecesOf(const Surface& surface, std::uint32_t face, std::uint32_t side) {
    const std::uint32_t entry = surface.faces[face].sides[side];
    const std::uint32_t edge = entry & kSideEdgeMask;
    const bool isReversed = entry & kSideReversed;
    if (entry & kSideSplit) {
        if (isReversed) return {{edge + 1, {face, side, 0.5F, 0}}, {edge, {face, side, 1, 0.5F}}};
        return {{edge, {face, side, 0, 0.5F}}, {edge + 1, {face, side, 0.5F, 1}}};
    }
    if (isReversed) return {{edge, {face, side, 1, 0}}};
    return {{edge, {face, side, 0, 1}}};
}

/// Calls `test(piece)` for all sides of all faces that are drawn.
template <typename Test>
void atPieces(const Surface& surface, const Test& test) {
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        if (surface.faces[face].root == kNoPatch) continue;
        for (int side = 0; side < surface.sideCount; ++side)
            for (const Piece& piece : piecesOf(surface, face, side)) test(piece);
    }
}

inline dvec2 pointOf(const Surface& surface, const Incidence& incidence, double t) {
    return sidePoint(surface.sideCount, int(incidence.side), incidence.start + t * (incidence.end - incidence.start));
}

} // namespace relief
