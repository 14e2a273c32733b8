#include "view/pacing.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

constexpr double kSecondsToRest = 0.2; ///< without a change before a coarse picture is refined
constexpr int kLargestDivisor = 8;

} // namespace

void Pacing::change(double now) {
    changedAt_ = now;
    isFull_ = isShown_ = false;
}

Quality Pacing::next(double now) const {
    if (isFull_) return Quality::none;
    const bool isQuick = fullSeconds_ <= budget_; // also where it is not known: the first picture is a full one
    if (isQuick || now - changedAt_ >= kSecondsToRest) return Quality::full;
    return isShown_ ? Quality::none : Quality::coarse;
}

double Pacing::secondsOfRest(double now) const {
    return isFull_ ? -1 : std::max(0.0, changedAt_ + kSecondsToRest - now);
}

void Pacing::drew(Quality quality, double seconds) {
    isShown_ = true;
    if (quality == Quality::full) {
        isFull_ = true;
        // The first picture compiles shaders: what it took says nothing about the next one.
        fullSeconds_ = fullSeconds_ < 0 ? 2 * budget_ : seconds;
        return;
    }
    // Most of the time goes with the pixels; small steps, because not all of it does.
    if (seconds > budget_ && divisor_ < kLargestDivisor) ++divisor_;
    if (seconds < 0.5 * budget_ && divisor_ > 2) --divisor_;
}

} // namespace relief
