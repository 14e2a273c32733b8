// Internal: what stands in the texels that have no height.
#pragma once

#include "bake/heights.h"

namespace relief {

/// Fills all texels that are not hit. At least one must be.
void fillMissed(BakedHeights& map, const TexelSource& texels);

} // namespace relief
