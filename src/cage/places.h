// Which points are at the same place.
#pragma once

#include <span>

#include "base/base.h"

namespace relief {

/// Places numbered from 0 in order of their first point; points are at one place when their coordinates are equal.
struct Places {
    std::vector<std::uint32_t> ofPoints; ///< one per point
    std::vector<std::uint32_t> firsts;   ///< the first point at each place

    [[nodiscard]] std::size_t count() const { return firsts.size(); }
};
Places findPlaces(std::span<const vec3> points);

} // namespace relief
