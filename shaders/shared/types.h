// Names that g++ and glslang both understand. Scalar block layout: C++ structs of these types match without padding.
#ifndef RELIEF_SHARED_TYPES_H
#define RELIEF_SHARED_TYPES_H

#ifdef __cplusplus

#include <cstdint>

#include "base/base.h"

namespace relief {
using uint = std::uint32_t;
} // namespace relief

// Formulas: in C++ the shared functions are double precision, on the device single.
#define RELIEF_SHARED_FUNCTION inline
#define RELIEF_CONSTANT inline constexpr
#define RELIEF_ADDRESS(array) std::uint64_t // of an array on the device
namespace relief::formulas {
using real = double;
using real2 = glm::dvec2;
using real3 = glm::dvec3;
using real2x2 = glm::dmat2;
} // namespace relief::formulas

#else

#define RELIEF_SHARED_FUNCTION
#define RELIEF_CONSTANT const
#define RELIEF_ARRAY(name, type)                                                                                       \
    layout(buffer_reference, scalar, buffer_reference_align = 4) buffer name { type at[]; };
#define RELIEF_ADDRESS(array) array
#define real float
#define real2 vec2
#define real3 vec3
#define real2x2 mat2

#endif
#endif
