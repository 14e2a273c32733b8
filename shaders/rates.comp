#version 460
#extension GL_GOOGLE_include_directive : require
#include "displaced.glsl"

// One rate an edge, from the edge alone: both faces read the same number.
layout(local_size_x = 64) in;

layout(set = 0, binding = kBindEdgeHeights) uniform samplerBuffer edgeHeightTexels;

// Length in pixels of the displaced edge seen face-on from its distance: direction does not shorten it, so silhouettes
// keep their detail. Between the samples heights may go up and down unseen: once through all their range is
// counted.
float pixelLength(uint edge) {
    const uint pieces = 4u;
    float pixels = 0.0, straight = 0.0, middle = 0.0;
    vec3 last = vec3(0), lastLimit = vec3(0);
    for (uint k = 0u; k <= pieces; ++k) {
        SampleLocation location = edgeLocation(edge, k, pieces, float(pieces));
        DisplacedSample s = displaced(location.owner.face, vec2(0), location);
        vec3 q = s.q;
        float distance = max(length(0.5 * (q + last) - scene.eye), scene.nearDistance);
        if (k > 0u) pixels += length(q - last) * scene.pixelsAtUnitDistance / distance;
        if (k > 0u) straight += length(s.p - lastLimit);
        if (2u * k == pieces) middle = max(length(q - scene.eye), scene.nearDistance);
        last = q;
        lastLimit = s.p;
    }
    float range = texelFetch(edgeHeightTexels, int(edge)).x;
    return max(pixels, length(vec2(straight, range)) * scene.pixelsAtUnitDistance / middle);
}

void main() {
    uint edge = gl_GlobalInvocationID.x;
    if (edge >= scene.edgeCount) return;
    // The halves of an edge beside an n-gon share the larger length, so that a quad's side divides evenly.
    uint partner = fetchEdge(edge).partner;
    float pixels = 0.0;
    for (uint i = 0u; i < (partner == edge ? 1u : 2u); ++i)
        pixels = max(pixels, pixelLength(i == 0u ? edge : partner));
    float rate = pixels / scene.edgePixels;
    if (scene.isFractional == 0u) rate = ceil(rate);
    uint limit = partner == edge ? scene.maxRate : max(scene.maxRate / 2u, 1u);
    // NaN compares false: it becomes 1, never a missing face.
    scene.edgeTarget.at[edge] = rate > 1.0 ? min(rate, float(limit)) : 1.0;
}
