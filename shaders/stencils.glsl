// The stencil matrix, block by block (see shared/pose.h).
#ifndef RELIEF_STENCILS_GLSL
#define RELIEF_STENCILS_GLSL

#include "pose.glsl"

RELIEF_TABLE(kPosePoints, vec4, pointAt)
RELIEF_TABLE(kPoseWords, uint, word)
RELIEF_TABLE(kPoseWeights, vec4, weightsAt)

// Weights add up to 1: points are taken as offsets from a block's first one, so that rounding scales with the rows' extent and
// not with their distance from the origin.
vec3 entryPoint(uint i) { return pointAt(push.firstPoint + word(push.firstEntry + i)).xyz; }

// Weights of four entries, e a multiple of 4, in one row of their block.
vec4 weightsOf(uint e, uint row) { return weightsAt(4u * e + row); }

void storeRow(uint block, uint lane, vec3 p) {
    uint row = word(push.firstTarget + kBlockRows * block + lane);
    if (row != kNoPatch) push.target.at[push.firstPoint + push.pointCount + row].xyz = p; // nothing reads the fourth number
}
#endif
