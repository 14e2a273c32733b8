// Internal: angles between directions.
#pragma once

#include <cmath>

#include "base/base.h"

namespace relief {

/// NaN where a direction is; exact for small angles, where an arc cosine is not.
inline double degreesBetween(const dvec3& a, const dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

} // namespace relief
