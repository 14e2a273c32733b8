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

} // namespace relief
