// Statistics of the times of rounds.
#pragma once

#include <algorithm>
#include <vector>

#include "base/checks.h"
#include "base/clock.h"

namespace relief::bench {

/// The upper median: of an even number of values the larger of the two in the middle.
inline double computeMedian(std::vector<double> values) {
    RELIEF_CHECK(!values.empty());
    std::ranges::sort(values);
    return values[values.size() / 2];
}

} // namespace relief::bench
