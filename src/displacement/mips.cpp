#include "displacement/mips.h"

#include <algorithm>
#include <cstddef>

namespace relief {

std::vector<float> halved(const MapLevel& fine) {
    const int width = std::max(fine.width / 2, 1), height = std::max(fine.height / 2, 1);
    const auto at = [&](int x, int y) {
        return fine.texels[std::size_t(std::min(y, fine.height - 1)) * std::size_t(fine.width) +
                           std::size_t(std::min(x, fine.width - 1))];
    };
    std::vector<float> coarse;
    coarse.reserve(std::size_t(width) * std::size_t(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            coarse.push_back(
                0.25f * (at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) + at(2 * x, 2 * y + 1) + at(2 * x + 1, 2 * y + 1)));
    return coarse;
}

} // namespace relief
