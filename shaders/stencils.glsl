// The stencil matrix, block by block (see shared/pose.h).
#ifndef RELIEF_STENCILS_GLSL
#define RELIEF_STENCILS_GLSL

#include "pose.glsl"
#include "points.glsl"

RELIEF_TABLE(kPosePoints, vec4, pointAt)
RELIEF_TABLE(kPoseWords, uint, word)
RELIEF_TABLE(kPoseWeights, uvec4, weightsAt)

// Weights add up to 1: points are taken as offsets from a block's first one, so that rounding scales with the rows' extent and
// not with their distance from the origin.
vec3 entryPoint(uint i) { return pointAt(push.firstPoint + word(push.firstEntry + i)).xyz; }

// Weights of four entries, e a multiple of 4, in one row of their block.
ivec4 weightsOf(uint e, uint row) { return ivec4(weightsAt(4u * e + row)); }

// Where patches of deep levels need it (src/README.md, "Rounding"): else all of a sum is coarse, and is rounded as floats are.
layout(constant_id = kIdIsFine) const bool kIsFine = false;

struct RowSum {
    vec3 coarse, fine; // the exact part, and the rest
};
const RowSum kNoSum = RowSum(vec3(0), vec3(0));

// p - origin: whole units, and the rest with what a float leaves of the difference (Knuth 1969, section 4.2.2).
struct SplitOffset {
    vec3 coarse, rest;
};

SplitOffset offsetBetween(vec3 p, vec3 origin) {
    precise vec3 offset = p - origin;
    if (!kIsFine) return SplitOffset(offset, vec3(0));
    precise vec3 taken = offset - p, left = (p - (offset - taken)) - (origin + taken);
    precise vec3 coarse = push.offsetUnit * round(offset / push.offsetUnit), rest = (offset - coarse) + left;
    return SplitOffset(coarse, rest);
}

void add(inout RowSum sum, int weight, SplitOffset offset) {
    if (!kIsFine) {
        sum.coarse += float(weight) * offset.coarse;
        return;
    }
    int fineBits = weight & ((1 << kFineWeightBits) - 1);
    float coarse = float(weight - fineBits), fine = float(fineBits);
    sum.coarse += coarse * offset.coarse;
    sum.fine += coarse * offset.rest + fine * (offset.coarse + offset.rest);
}

void storeRow(uint block, uint lane, vec3 origin, RowSum sum) {
    uint target = word(push.firstTarget + kBlockRows * block + lane);
    if (target == kNoPatch) return;
    uint row = target & ((1u << kTargetRowBits) - 1u);
    float unit = uintBitsToFloat((target >> kTargetRowBits) + (127u - 31u) << 23);
    push.target.at[push.firstPoint + push.pointCount + row] = finePoint(origin, unit * sum.coarse, unit * sum.fine);
}
#endif
