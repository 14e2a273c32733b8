#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_KHR_shader_subgroup_shuffle : require
#include "stencils.glsl"

// What pose_points.comp makes, where a subgroup is 8 lanes and a workgroup is one: its lanes fetch eight points of a block
// together and hand them to each other. Straight code: Mesa's CPU driver runs loads and stores of shared memory, and whatever a
// loop holds, lane by lane.
layout(local_size_x_id = kIdGroupSize) in;

layout(constant_id = kIdEntries) const uint kEntries = 8u; // of every block of the dispatch

const uint kLanes = 8u;

void main() {
    uint lane = gl_LocalInvocationID.x, block = push.firstBlock + gl_WorkGroupID.x;
    uint first = push.firstBlockEntry + kEntries * gl_WorkGroupID.x;
    vec3 point = entryPoint(first + lane), origin = subgroupShuffle(point, 0u);
    SplitOffset own = offsetBetween(point, origin);
    RowSum low = kNoSum, high = kNoSum;
    [[unroll]] for (uint e = 0u; e < kEntries; e += 4u) {
        if (e > 0u && e % kLanes == 0u) own = offsetBetween(entryPoint(first + e + lane), origin);
        ivec4 v = weightsOf(first + e, lane), w = weightsOf(first + e, lane + kLanes);
        [[unroll]] for (uint j = 0u; j < 4u; ++j) {
            uint from = e % kLanes + j;
            SplitOffset offset = SplitOffset(subgroupShuffle(own.coarse, from), subgroupShuffle(own.rest, from));
            add(low, v[j], offset);
            add(high, w[j], offset);
        }
    }
    storeRow(block, lane, origin, low);
    storeRow(block, lane + kLanes, origin, high);
}
