#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#define RELIEF_VARYING out
#include "varyings.glsl"
#include "project.glsl"

// A triangle mesh as it is: a dense one, the opponent of every comparison, or one that was diced.
layout(set = 0, binding = kBindMesh) uniform samplerBuffer meshTexels;
layout(set = 0, binding = kBindMeshTexCoords) uniform samplerBuffer meshTexCoordTexels;

layout(constant_id = 1) const bool kHasTexCoords = false;
layout(constant_id = 4) const bool kWantsTexCoords = false;

void main() {
    vec4 vertex = texelFetch(meshTexels, 2 * gl_VertexIndex);
    precise vec4 clip = project(vertex.xyz);
    gl_Position = clip;
    vNormal = texelFetch(meshTexels, 2 * gl_VertexIndex + 1).xyz;
    vTexCoord = vec4(kHasTexCoords && kWantsTexCoords ? texelFetch(meshTexCoordTexels, gl_VertexIndex).xy : vec2(0), vec2(0));
    vHeight = vertex.w;
    // Draws of a face each carry its number; a whole mesh in one draw has patches of 64 vertices instead.
    vFace = passRows > 0u ? cageFaceOf(passFirst) : uint(gl_VertexIndex) / 64u;
    vRate = max(passNumber, 1u);
}
