#version 460
#extension GL_GOOGLE_include_directive : require
#include "pose.glsl"

// The points of a cage: as they were uploaded, or from its rig.
layout(local_size_x = 64) in;

layout(set = 0, binding = kPoseUpload) uniform samplerBuffer uploadTexels;
layout(set = 0, binding = kPoseRest) uniform samplerBuffer restTexels;
layout(set = 0, binding = kPoseJoints) uniform usamplerBuffer jointTexels;
layout(set = 0, binding = kPoseInfluences) uniform samplerBuffer influenceTexels;

float uploaded(uint i) { return texelFetch(uploadTexels, int(i)).x; }

vec4 uploadedRow(uint i) { return vec4(uploaded(i), uploaded(i + 1u), uploaded(i + 2u), uploaded(i + 3u)); }

// sum_i w_i J_i (rest + sum_k m_k offset_k)  (glTF 2.0, sections 3.7.2.2 and 3.7.3.3).
vec3 rigged(uint point) {
    vec3 p = texelFetch(restTexels, int(point)).xyz;
    for (uint k = 0u; k < morphCount; ++k)
        p += uploaded(k) * texelFetch(restTexels, int((k + 1u) * pointCount + point)).xyz;
    if (influenceCount == 0u) return p;
    vec3 sum = vec3(0);
    for (uint i = point * influenceCount; i < (point + 1u) * influenceCount; ++i) {
        float weight = texelFetch(influenceTexels, int(i)).x;
        uint row = morphCount + 12u * texelFetch(jointTexels, int(i)).x;
        sum += weight * vec3(dot(uploadedRow(row), vec4(p, 1)), dot(uploadedRow(row + 4u), vec4(p, 1)),
                             dot(uploadedRow(row + 8u), vec4(p, 1)));
    }
    return sum;
}

void main() {
    uint point = gl_GlobalInvocationID.x;
    if (point >= pointCount) return;
    vec3 p = isRigged != 0u ? rigged(point) : vec3(uploaded(3u * point), uploaded(3u * point + 1u), uploaded(3u * point + 2u));
    target.at[firstPoint + point] = vec4(p, 1.0);
}
