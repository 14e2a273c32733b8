#pragma once

#include "cage/cage.h"

namespace relief {

/// One side of one face. Uses of the same edge have the same key.
struct EdgeUse {
    std::uint64_t key = 0;    ///< lower position index in the high half, higher in the low half
    std::uint32_t corner = 0; ///< where the side starts in Cage::corners
    std::uint32_t next = 0;   ///< where it ends
    bool runsUp = false;      ///< from the lower to the higher position index
};

inline std::uint64_t edgeKey(std::uint32_t a, std::uint32_t b) {
    return a < b ? std::uint64_t(a) << 32 | b : std::uint64_t(b) << 32 | a;
}

/// All sides of all faces, sorted so that uses of one edge are neighbours.
std::vector<EdgeUse> sortedEdgeUses(const Cage& cage);

/// True when some face has an edge between a and b; `uses` as sortedEdgeUses gives them.
bool hasEdge(const std::vector<EdgeUse>& uses, std::uint32_t a, std::uint32_t b);

} // namespace relief
