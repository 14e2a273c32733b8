// For other modules: texels of a map that are no heights.
#pragma once

#include <vector>

#include "displacement/displacement.h"

namespace relief {

/// Replaces voids by means of the heights around them: each texel of a pyramid is the mean of the heights below it, and
/// voids take the coarser level bilinearly, the finest that knows anything first (push-pull: Gortler et al. 1996, "The
/// Lumigraph", section 3.4). At least one texel must be a height.
void fillVoids(int width, int height, std::span<float> texels, const std::vector<bool>& isVoid);

/// Rounds texels in place to what the encoding holds of them (not for blocks).
void roundTo(const MapEncoding& encoding, std::span<float> texels);

} // namespace relief
