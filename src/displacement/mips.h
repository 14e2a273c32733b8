// Internal: the mip levels of a map.
#pragma once

#include <span>
#include <vector>

namespace relief {

struct MapLevel {
    int width = 0, height = 0;
    std::span<const float> texels;
};

/// The texels of the level after this one, half as large: each is the mean of four, or of what there is.
std::vector<float> halved(const MapLevel& fine);

} // namespace relief
