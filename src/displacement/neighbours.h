// For other modules: texels beside others, and central differences.
#pragma once

#include <algorithm>
#include <span>

#include "displacement/displacement.h"

namespace relief {

/// The index `step` (-1 or 1) beside another one, as the map continues at its border.
inline int beside(int index, int step, int size, Wrap wrap) {
    const int at = index + step;
    return wrap == Wrap::clamp ? std::clamp(at, 0, size - 1) : (at + size) % size;
}

/// Calls `take` with the central difference of two texels at each texel of a map, row after row from the top: to the
/// right along x, upwards along y.
template <typename Take>
void eachDifference(int width, int height, std::span<const float> texels, Wrap wrap, const Take& take) {
    const auto rowOf = [&](int y) { return &texels[std::size_t(y) * std::size_t(width)]; };
    for (int y = 0; y < height; ++y) {
        const float *row = rowOf(y), *above = rowOf(beside(y, -1, height, wrap)),
                    *below = rowOf(beside(y, 1, height, wrap));
        for (int x = 0; x < width; ++x)
            take(dvec2(double(row[beside(x, 1, width, wrap)]) - row[beside(x, -1, width, wrap)],
                       double(above[x]) - below[x]));
    }
}

} // namespace relief
