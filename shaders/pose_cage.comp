#version 460
#extension GL_GOOGLE_include_directive : require
#include "pose.glsl"
#include "shared/points.h"
#include "rig.glsl"

// The points of a cage: as they were uploaded, or from its rig.
layout(local_size_x = 64) in;

// sum_i w_i J_i (rest + sum_k m_k offset_k)  (glTF 2.0, sections 3.7.2.2 and 3.7.3.3).
vec3 rigged(uint point) {
    vec3 p = restAt(point).xyz;
    for (uint k = 0u; k < push.morphCount; ++k)
        p += uploaded(k) * restAt((k + 1u) * push.pointCount + point).xyz;
    return push.influenceCount == 0u ? p : vec4(p, 1.0) * blendedJoints(point);
}

void main() {
    uint point = gl_GlobalInvocationID.x;
    if (point >= push.pointCount) return;
    vec3 p = push.isRigged != 0u ? rigged(point)
                                 : vec3(uploaded(3u * point), uploaded(3u * point + 1u), uploaded(3u * point + 2u));
    push.target.at[push.firstPoint + point] = vec4(p, uintBitsToFloat(kNoRemainder));
}
