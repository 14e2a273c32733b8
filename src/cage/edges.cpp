#include "cage/edges.h"

#include <algorithm>

namespace relief {

std::vector<EdgeUse> sortedEdgeUses(const Cage& cage) {
    std::vector<EdgeUse> uses;
    uses.reserve(cage.corners.size());
    std::uint32_t first = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        for (std::uint32_t k = 0; k < size; ++k) {
            const std::uint32_t corner = first + k, next = first + (k + 1) % size;
            const std::uint32_t a = cage.corners[corner], b = cage.corners[next];
            uses.push_back({.key = edgeKey(a, b), .corner = corner, .next = next, .runsUp = a < b});
        }
        first += size;
    }
    std::sort(uses.begin(), uses.end(),
              [](const EdgeUse& a, const EdgeUse& b) { return a.key != b.key ? a.key < b.key : a.corner < b.corner; });
    return uses;
}

bool hasEdge(const std::vector<EdgeUse>& uses, std::uint32_t a, std::uint32_t b) {
    const std::uint64_t key = edgeKey(a, b);
    const auto found = std::lower_bound(uses.begin(), uses.end(), key,
                                        [](const EdgeUse& use, std::uint64_t sought) { return use.key < sought; });
    return found != uses.end() && found->key == key;
}

} // namespace relief
