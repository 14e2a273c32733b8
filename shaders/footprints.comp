#version 460
#extension GL_GOOGLE_include_directive : require
#include "displaced.glsl"

// Every edge on the height map, at its owner: how long it is in texels, which mip levels are chosen by, and the box of texture
// coordinates around it, for bounds of the heights there.
layout(local_size_x = 64) in;

void main() {
    uint index = gl_GlobalInvocationID.x;
    if (index >= inputs.model.edgeCount) return;
    const uint pieces = 4u;
    Incidence owner = fetchEdge(index).owner;
    float texels = 0.0;
    vec2 last = vec2(0), lower = vec2(1e30), upper = vec2(-1e30);
    for (uint k = 0u; k <= pieces; ++k) {
        vec2 uv = incidencePoint(owner, float(k) / float(pieces));
        vec2 st = displaced(owner.face, uv, insideLocation(owner.face, uv)).st, size = texelsAt(st), at = st * size;
        lower = min(lower, st);
        upper = max(upper, st);
        if (kMapAddressing == kMapOfTiles) at = st; // tiles differ in size
        if (k > 0u) texels += kMapAddressing == kMapOfTiles ? length((at - last) * size) : length(at - last);
        last = at;
    }
    float words[kFootprintFloats] = {texels, lower.x, lower.y, upper.x, upper.y};
    for (uint i = 0u; i < kFootprintFloats; ++i) inputs.targets.edges.at[kFootprintFloats * index + i] = words[i];
}
