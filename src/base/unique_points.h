// Which points are equal.
#pragma once

#include <span>

#include "base/base.h"

namespace relief {

/// Distinct points, numbered from 0 in the order of their first occurrence. Points are equal when their coordinates are
/// (0 equals -0).
struct UniquePoints {
    std::vector<std::uint32_t> indices; ///< per point: the number of the distinct point that it is
    std::vector<std::uint32_t> firsts;  ///< per distinct point: its first occurrence

    [[nodiscard]] std::size_t count() const { return firsts.size(); }
};
UniquePoints findUniquePoints(std::span<const vec3> points);

} // namespace relief
