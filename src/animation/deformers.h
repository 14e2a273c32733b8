// The vocabulary of deform(): names, their values, and what they do to a point.
#pragma once

#include <limits>
#include <span>

#include "base/base.h"

namespace relief {

/// Maps a point to its deformed position. Empty: all points stay, to the bit.
using Move = std::function<dvec3(const dvec3&)>;

/// What a deformer is made of for one pose.
struct DeformerMoment {
    const Bounds& box;              ///< of the cage at rest
    std::span<const double> values; ///< in the order of DeformerKind::values, finite; axes as 0, 1, 2
    double seconds = 0;

    [[nodiscard]] int axis(std::size_t value) const { return int(values[value]); }
};

struct ValueKind {
    std::string name;
    std::string standard; ///< its text where it is not given
    bool isAxis = false;  ///< x, y, z, or `next`: the one after the deformer's first axis, in a circle
    /// Values at or below `above`, and at or above `below`, make no sense.
    double above = -std::numeric_limits<double>::infinity(), below = std::numeric_limits<double>::infinity();
};

struct DeformerKind {
    std::string name, help;
    std::vector<ValueKind> values;
    int speedValue = -1; ///< index of the value that makes it move with time; -1: none
    Move (*make)(const DeformerMoment& moment);
};

/// The table of all deformers, in the order in which help lists them.
const std::vector<DeformerKind>& deformerKinds();

} // namespace relief
