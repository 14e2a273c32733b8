#include "base/unique_points.h"

#include <bit>

namespace relief {

namespace {

std::uint64_t hashOf(const vec3& p) {
    std::uint64_t hash = 0;
    for (int k = 0; k < 3; ++k) // + 0: both zeros are one
        hash = (hash ^ std::bit_cast<std::uint32_t>(p[k] + 0.0f)) * 0x9e3779b97f4a7c15u;
    return hash ^ (hash >> 32);
}

} // namespace

// A table with open addresses: a node of its own for each of ten million points would take more than the mesh.
UniquePoints findUniquePoints(std::span<const vec3> points) {
    constexpr std::uint32_t kFree = ~0u;
    UniquePoints unique;
    unique.indices.reserve(points.size());
    std::vector<std::uint32_t> table(std::bit_ceil(2 * points.size() + 1), kFree);
    for (std::uint32_t i = 0; i < points.size(); ++i) {
        std::size_t at = hashOf(points[i]) & (table.size() - 1);
        while (table[at] != kFree && points[unique.firsts[table[at]]] != points[i]) at = (at + 1) & (table.size() - 1);
        if (table[at] == kFree) {
            table[at] = std::uint32_t(unique.count());
            unique.firsts.push_back(i);
        }
        unique.indices.push_back(table[at]);
    }
    return unique;
}

} // namespace relief
