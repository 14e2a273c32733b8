#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "pose.glsl"

// Refined and local points from those of the cage: the stencil matrix block by block (see shared/pose.h).
layout(local_size_x_id = kIdGroupSize) in;

// Entries of every block of the dispatch, for devices that run a subgroup of 8 lanes: a workgroup is such a subgroup,
// its lanes fetch the points together, and the straight code that follows reads each of them once for all lanes. 0:
// blocks of any size, one lane per row, points from the texture caches.
layout(constant_id = kIdEntries) const uint kEntries = 0u;

RELIEF_TABLE(kPosePoints, vec4, pointAt)
RELIEF_TABLE(kPoseWords, uint, word)
RELIEF_TABLE(kPoseWeights, vec4, weightsAt)

vec3 entryPoint(uint i) { return pointAt(push.firstPoint + word(push.firstEntry + i)).xyz; }
// Weights of four entries, e a multiple of 4, in one row of their block.
vec4 weightsOf(uint e, uint row) { return weightsAt(4u * e + row); }

void storeRow(uint block, uint lane, vec3 p) {
    uint row = word(push.firstTarget + kBlockRows * block + lane);
    if (row != kNoPatch) push.target.at[push.firstPoint + push.pointCount + row] = vec4(p, 1.0);
}

// Weights add up to 1: points are taken as offsets from one of them, so that rounding scales with the row's extent and not with
// its distance from the origin.

void blendLooped() {
    uint invocation = gl_WorkGroupID.x * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    uint block = push.firstBlock + invocation / kBlockRows, lane = invocation % kBlockRows;
    if (block >= push.endBlock) return;
    uint first = word(block), last = word(block + 1u);
    vec3 origin = entryPoint(first), sum = vec3(0);
    for (uint e = first; e < last; e += 4u) {
        vec4 w = weightsOf(e, lane);
        for (uint j = 0u; j < 4u; ++j) sum += w[j] * (entryPoint(e + j) - origin);
    }
    storeRow(block, lane, origin + sum);
}

const uint kLanes = 8u, kMostEntries = 32u;
shared vec3 points[kMostEntries];

void blendStraight() {
    uint lane = gl_LocalInvocationID.x, block = push.firstBlock + gl_WorkGroupID.x;
    uint first = push.firstBlockEntry + kEntries * gl_WorkGroupID.x;
    [[unroll]] for (uint e = 0u; e < kEntries; e += kLanes) points[e + lane] = entryPoint(first + e + lane);
    barrier();
    vec3 origin = points[0], low = vec3(0), high = vec3(0);
    [[unroll]] for (uint e = 0u; e < kEntries; e += 4u) {
        vec4 v = weightsOf(first + e, lane), w = weightsOf(first + e, lane + kLanes);
        [[unroll]] for (uint j = 0u; j < 4u; ++j) {
            vec3 offset = points[e + j] - origin;
            low += v[j] * offset;
            high += w[j] * offset;
        }
    }
    storeRow(block, lane, origin + low);
    storeRow(block, lane + kLanes, origin + high);
}

void main() {
    if (kEntries == 0u) blendLooped();
    else blendStraight();
}
