#version 460
#extension GL_GOOGLE_include_directive : require
#include "raster.glsl"

// The vertices of a mesh on the screen, one invocation each.
layout(local_size_x_id = kIdGroupSize) in;

void main() {
    uint vertex = push.first + gl_GlobalInvocationID.x;
    if (vertex >= push.count) return;
    precise vec4 clip = project(meshAt(2u * vertex).xyz);
    ScreenVertex v = toScreen(clip);
    if (isBehind(clip)) v.p = ivec2(kUnplaced, kBehind);
    if (kPass == kPassSurface) v.normal = packNormal(worldNormal(meshAt(2u * vertex + 1u).xyz));
    inputs.targets.screen.at[vertex] = uvec4(v.p, floatBitsToUint(v.depth), v.normal);
}
