#version 460
#extension GL_GOOGLE_include_directive : require
#include "pose.glsl"
#include "rig.glsl"

// The vertices of a dense mesh, position and normal in turn, moved by joints: what a cage saves.
layout(local_size_x = 64) in;

void main() {
    uint vertex = push.firstPoint + gl_GlobalInvocationID.x;
    if (vertex >= push.pointCount) return;
    mat3x4 joints = blendedJoints(vertex);
    vec4 position = restAt(2u * vertex);
    vec3 normal = vec4(restAt(2u * vertex + 1u).xyz, 0.0) * joints;
    push.target.at[2u * vertex] = vec4(vec4(position.xyz, 1.0) * joints, position.w);
    push.target.at[2u * vertex + 1u] = vec4(normalize(normal), 0.0);
}
