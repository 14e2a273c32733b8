// Internal: vector maps while they are read.
#pragma once

#include "displacement/displacement.h"

namespace relief {

/// Throws Failure::usage for an order that is no permutation of "xyz", and for flips of other axes.
void checkAxes(const VectorOptions& options);

/// Three channels of a picture as the components along x, y and z: by the order and the signs of the options, and by
/// their mid, which is 0 where it is not given.
std::array<HeightMap, 3> takeComponents(const Image& image, std::size_t firstChannel, const VectorOptions& options);

} // namespace relief
