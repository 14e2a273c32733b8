// An environment to look at: which face of a cube is where, and which way it is turned.
#pragma once

#include "painting.h"

namespace relief::meshes {

/// A cube unfolded into a cross (px nx py ny pz nz are red, cyan, green, magenta, blue and yellow). Each face has a
/// dark arrow to its top and a white square at its right edge; around the cross it is black.
inline Painting paintLabels(const ivec2& size) {
    // Rows of the cross from the top: py over pz; nx pz px nz, as the eye turns to the right; ny.
    constexpr int kRows[3][4] = {{-1, 2, -1, -1}, {1, 4, 0, 5}, {-1, 3, -1, -1}};
    const dvec3 colors[6] = {{0.9, 0.25, 0.2}, {0.3, 0.8, 0.85}, {0.35, 0.8, 0.3},
                             {0.85, 0.4, 0.8}, {0.25, 0.4, 0.9}, {0.95, 0.8, 0.25}};
    Painting painting = paintSquare(size, [&](const dvec2& st) {
        const double column = st.x * 4, row = (1 - st.y) * 3, s = column - std::floor(column),
                     t = row - std::floor(row);
        const int face = kRows[int(row)][int(column)];
        if (face < 0) return Paint{0, dvec3(0)};
        const bool isShaft = std::abs(s - 0.5) < 0.06 && t > 0.35 && t < 0.8;
        const bool isHead = t > 0.12 && t < 0.38 && std::abs(s - 0.5) < 0.8 * (t - 0.12);
        if (isShaft || isHead) return Paint{0, dvec3(0.05)};
        if (s > 0.8 && s < 0.94 && std::abs(t - 0.5) < 0.07) return Paint{0, dvec3(1)};
        return Paint{0, colors[face]};
    });
    painting.height = {};
    return painting;
}

} // namespace relief::meshes
