// What tests of posed cages share.
#pragma once

#include "animation/animation.h"

namespace relief::test {

inline Pose poseOf(std::vector<vec3> positions) {
    return {.positions = std::move(positions), .joints = {}, .morphWeights = {}};
}

} // namespace relief::test
