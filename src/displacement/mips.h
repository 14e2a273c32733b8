// For other modules: the mip levels of a map.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace relief {

template <typename Texel>
struct MapLevel {
    int width = 0, height = 0;
    std::span<const Texel> texels;

    /// The size of the level after this one.
    [[nodiscard]] int halfWidth() const { return std::max(width / 2, 1); }
    [[nodiscard]] int halfHeight() const { return std::max(height / 2, 1); }
};

/// The texels of the level after this one, half as large: each is the mean of four, or of what there is.
template <typename Texel>
std::vector<Texel> halved(const MapLevel<Texel>& fine) {
    const auto at = [&](int x, int y) {
        return fine.texels[std::size_t(std::min(y, fine.height - 1)) * std::size_t(fine.width) +
                           std::size_t(std::min(x, fine.width - 1))];
    };
    std::vector<Texel> coarse;
    coarse.reserve(std::size_t(fine.halfWidth()) * std::size_t(fine.halfHeight()));
    for (int y = 0; y < fine.halfHeight(); ++y)
        for (int x = 0; x < fine.halfWidth(); ++x)
            coarse.push_back(
                0.25f * (at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) + at(2 * x, 2 * y + 1) + at(2 * x + 1, 2 * y + 1)));
    return coarse;
}

} // namespace relief
