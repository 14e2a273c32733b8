// Internal: how values become the integers that pictures store.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace relief {

/// The nearest code, halves upwards; what is below 0 or no number becomes 0, what is above 1 the largest code.
template <typename Code>
Code toCode(float value) {
    constexpr auto kLargest = float(std::numeric_limits<Code>::max());
    return value > 0 ? Code(std::floor(kLargest * std::min(value, 1.0f) + 0.5f)) : Code(0);
}

} // namespace relief
