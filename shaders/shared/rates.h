// Segments of edges: one definition for the plans of draws and for the shaders.
#ifndef RELIEF_SHARED_RATES_H
#define RELIEF_SHARED_RATES_H

#include "shared/types.h"

#ifdef __cplusplus
#include <algorithm>
#include <cmath>
#define RELIEF_PRECISE
namespace relief::formulas {
using std::ceil;
using std::min;
#else
#define RELIEF_PRECISE precise
#endif

// Segments of an edge by its rate. With --spacing fractional a rate need not be whole: the edge has the next even
// number of segments, all of length 1/rate but the two in its middle, which are what is left. Nothing pops while the
// rate grows.
RELIEF_SHARED_FUNCTION uint segmentsOf(float rate, uint isFractional) {
    return isFractional != 0u ? 2u * uint(ceil(0.5f * rate)) : uint(rate);
}

// Parameter of sample k of n along an edge (see segmentsOf); seen from the other end it is 1 minus this, to the bit.
RELIEF_SHARED_FUNCTION float sampleParameter(uint k, uint n, float rate) {
    uint near = min(k, n - k);
    RELIEF_PRECISE float t = min(float(near) / rate, 0.5f);
    RELIEF_PRECISE float mirrored = 1.0f - t;
    return k == near ? t : mirrored;
}

#ifdef __cplusplus
} // namespace relief::formulas
#endif
#endif
