#version 460
#extension GL_GOOGLE_include_directive : require
#include "pose.glsl"
#include "rig.glsl"

// The vertices of a dense mesh, position and normal in turn, moved by joints: what a cage saves.
layout(local_size_x = 64) in;

RELIEF_TABLE(kPoseGradients, vec4, restGradientAt)

// Gradients along the mesh turn as its normals do where L moves its points: L^-T g, for (L^-T g) . (L d) = g . d. Those of s and t
// stay in the plane of the normal; `toGradient` is L^-T.
void poseGradients(uint vertex, vec3 normal, mat3 toGradient) {
    uint first = push.gradientTexels * vertex;
    for (uint i = 0u; i < push.gradientTexels; ++i) {
        vec4 g = restGradientAt(first + i);
        if (i < kGradientTexels) {
            vec3 moved = toGradient * g.xyz;
            g.xyz = moved - normal * dot(normal, moved);
        }
        push.gradients.at[first + i] = g;
    }
    if (push.gradientTexels <= kGradientTexels) return;
    mat3 rest;
    for (uint i = 0u; i < 3u; ++i) rest[i] = restGradientAt(first + kGradientTexels + i).xyz;
    rest = rest * transpose(toGradient);
    for (uint i = 0u; i < 3u; ++i) push.gradients.at[first + kGradientTexels + i].xyz = rest[i];
}

void main() {
    uint vertex = push.firstPoint + gl_GlobalInvocationID.x;
    if (vertex >= push.pointCount) return;
    mat3x4 joints = blendedJoints(vertex);
    vec4 position = restAt(2u * vertex);
    vec3 normal = vec4(restAt(2u * vertex + 1u).xyz, 0.0) * joints;
    push.target.at[2u * vertex] = vec4(vec4(position.xyz, 1.0) * joints, position.w);
    push.target.at[2u * vertex + 1u] = vec4(normalize(normal), 0.0);
    if (push.gradientTexels > 0u) // the columns of `joints` are the rows of L
        poseGradients(vertex, normalize(normal), inverse(mat3(joints[0].xyz, joints[1].xyz, joints[2].xyz)));
}
