// A clock for durations.
#pragma once

#include <chrono>

namespace relief {

/// Seconds of a clock that never runs backwards; only differences have a meaning.
inline double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Runs `work` and returns how long it took, in milliseconds.
template <typename Work>
double measureMilliseconds(const Work& work) {
    const double start = secondsNow();
    work();
    return 1e3 * (secondsNow() - start);
}

} // namespace relief
