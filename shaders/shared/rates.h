// Segments of edges: one definition for the plans of draws and for the shaders.
#ifndef RELIEF_SHARED_RATES_H
#define RELIEF_SHARED_RATES_H

#include "shared/types.h"

#ifdef __cplusplus
#include <cmath>
namespace relief::formulas {
using std::ceil;
#endif

// Segments of an edge by its rate. With --spacing fractional a rate need not be whole: the edge has the next even number of
// segments, all of length 1/rate but the two in its middle, which are what is left. Nothing pops while the rate grows.
RELIEF_SHARED_FUNCTION uint segmentsOf(float rate, uint isFractional) {
    return isFractional != 0u ? 2u * uint(ceil(0.5f * rate)) : uint(rate);
}

#ifdef __cplusplus
} // namespace relief::formulas
#endif
#endif
