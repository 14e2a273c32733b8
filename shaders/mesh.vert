#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#define RELIEF_VARYING out
#include "varyings.glsl"

// A dense triangle mesh as it is: the opponent of every comparison.
layout(constant_id = 1) const bool kHasTexCoords = false;

void main() {
    vec3 position = scene.meshPositions.at[gl_VertexIndex];
    gl_Position = (drawsShadow != 0u ? scene.worldToShadow : scene.worldToClip) * vec4(position, 1.0);
    vPosition = position;
    vNormal = scene.meshNormals.at[gl_VertexIndex];
    vTexCoord = kHasTexCoords ? scene.meshTexCoords.at[gl_VertexIndex] : vec2(0);
    vHeight = 0.0;
    vFace = uint(gl_VertexIndex) / 64u;
    vRate = 1u;
}
