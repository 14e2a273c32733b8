#version 460
#extension GL_GOOGLE_include_directive : require
#include "pose.glsl"
#include "rig.glsl"

// The vertices of a dense mesh, position and normal in turn, moved by joints: what a cage saves.
layout(local_size_x = 64) in;

void main() {
    uint vertex = firstPoint + gl_GlobalInvocationID.x;
    if (vertex >= pointCount) return;
    mat3x4 joints = blendedJoints(vertex);
    vec4 position = texelFetch(restTexels, int(2u * vertex));
    vec3 normal = vec4(texelFetch(restTexels, int(2u * vertex + 1u)).xyz, 0.0) * joints;
    target.at[2u * vertex] = vec4(vec4(position.xyz, 1.0) * joints, position.w);
    target.at[2u * vertex + 1u] = vec4(normalize(normal), 0.0);
}
