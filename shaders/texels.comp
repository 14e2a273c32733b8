#version 460
#extension GL_GOOGLE_include_directive : require
#include "displaced.glsl"

// Length of every edge in texels of the height map, at its owner: what mip levels are chosen by.
layout(local_size_x = 64) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= scene.edgeCount) return;
    const uint pieces = 4u;
    Touch owner = fetchEdge(index).owner;
    float texels = 0.0;
    vec2 last = vec2(0);
    for (uint k = 0u; k <= pieces; ++k) {
        vec2 uv = touchPoint(owner, float(k) / float(pieces));
        vec2 at = displaced(owner.face, uv, insidePlace(owner.face, uv)).st * vec2(scene.mapSize);
        if (k > 0u) texels += length(at - last);
        last = at;
    }
    scene.edgeRateTarget.at[index] = texels;
}
