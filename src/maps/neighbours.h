// Internal: texels beside others.
#pragma once

#include <algorithm>

#include "displacement/displacement.h"

namespace relief {

/// The index `step` (-1 or 1) beside another one, as the map continues at its border.
inline int beside(int index, int step, int size, Wrap wrap) {
    const int at = index + step;
    return wrap == Wrap::clamp ? std::clamp(at, 0, size - 1) : (at + size) % size;
}

inline const vec3& normalAt(const NormalMap& map, int i, int j) {
    return map.normals[std::size_t(j) * std::size_t(map.width) + std::size_t(i)];
}

} // namespace relief
