// What is wrong at the edges that only one triangle has.
#pragma once

#include <span>

#include "check/check.h"

namespace relief {

struct LoneEdge {
    vec3 ends[2];
};

/// Fills tJunctions, largestGapUlps and worstLocation for the first kMostDiagnosedEdges of `open`, which are inside the
/// cage; `boundary` are on its boundary.
void diagnoseGaps(std::span<const LoneEdge> open, std::span<const LoneEdge> boundary, Watertightness& result);

} // namespace relief
