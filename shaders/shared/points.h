// Points of a pose: (x, y, z) are the nearest floats. The bits of w hold what these leave of each coordinate, in steps
// of 1/1000 of the last place of the largest one, plus 512: that of x in bits 0 to 9, of y in bits 10 to 19, of z in
// bits 20 to
// 29. Remainders are half of the last place at most, numbers from 12 to 1012: w is a float that every device keeps as
// it is, neither a NaN nor denormal.
#ifndef RELIEF_SHARED_POINTS_H
#define RELIEF_SHARED_POINTS_H

#include "shared/types.h"

#ifdef __cplusplus
namespace relief {
#endif

RELIEF_CONSTANT float kRemainderStep = 1.0f / (1000.0f * 8388608.0f); // where the largest coordinate is in [1, 2)
RELIEF_CONSTANT uint kNoRemainder = 0x20080200u;                      // the bits of w where nothing is left

#ifdef __cplusplus
} // namespace relief
#endif
#endif
