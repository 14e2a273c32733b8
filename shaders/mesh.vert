#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#define RELIEF_VARYING out
#include "varyings.glsl"

// A dense triangle mesh as it is: the opponent of every comparison.
layout(set = 0, binding = kBindMesh) uniform samplerBuffer meshTexels;

layout(constant_id = 1) const bool kHasTexCoords = false;

void main() {
    vec3 position = texelFetch(meshTexels, 2 * gl_VertexIndex).xyz;
    gl_Position = (drawsShadow != 0u ? scene.worldToShadow : scene.worldToClip) * vec4(position, 1.0);
    vNormal = texelFetch(meshTexels, 2 * gl_VertexIndex + 1).xyz;
    vTexCoord = kHasTexCoords ? texelFetch(texPointTexels, gl_VertexIndex).xy : vec2(0);
    vHeight = 0.0;
    vFace = uint(gl_VertexIndex) / 64u;
    vRate = 1u;
}
