#version 460
#extension GL_GOOGLE_include_directive : require
#include "stencils.glsl"

// Refined and local points from those of the cage: stencil blocks of any size, one lane per row, points from the texture
// caches. (pose_blocks.comp: for devices that run a subgroup of 8 lanes.)
layout(local_size_x_id = kIdGroupSize) in;

void main() {
    uint invocation = gl_WorkGroupID.x * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    uint block = push.firstBlock + invocation / kBlockRows, lane = invocation % kBlockRows;
    if (block >= push.endBlock) return;
    uint first = word(block), last = word(block + 1u);
    vec3 origin = entryPoint(first);
    RowSum sum = kNoSum;
    for (uint e = first; e < last; e += 4u) {
        ivec4 w = weightsOf(e, lane);
        for (uint j = 0u; j < 4u; ++j) add(sum, w[j], offsetBetween(entryPoint(e + j), origin));
    }
    storeRow(block, lane, origin, sum);
}
