#version 460
#extension GL_GOOGLE_include_directive : require
#include "displaced.glsl"

// One rate per edge, from the edge alone: both faces read the same number.
layout(local_size_x = 64) in;

RELIEF_TABLE(kBindEdgeHeights, float, edgeHeightRange)

const float kOutlineSegment = 0.25; // length of segments at outlines, relative to other segments
const float kOutlineCosine = 0.3;   // of the angle at which segments begin to be shorter

// Where fragments show all slopes, large triangles are seen at outlines only: of the surface, and of its relief, which hides more of
// itself the more aslant it is seen. Segments there are up to four times as short. `facing`: the least cosine between the line of sight
// and the limit normal, along an edge.
float outlineRefinement(float facing) {
    return kHasSlopes && kHasHeight ? 1.0 / mix(kOutlineSegment, 1.0, clamp(facing / kOutlineCosine, 0.0, 1.0)) : 1.0;
}

// Length in pixels of the displaced edge seen face-on from its distance: direction does not shorten it, so silhouettes
// keep their detail. Heights between the samples are not seen: the edge counts as at least as long as if they went once
// through their whole range.
float pixelLength(uint edge) {
    float facing = 1.0, lastFacing = 1.0;
    const uint pieces = 4u;
    float pixels = 0.0, straight = 0.0, middle = 0.0;
    vec3 last = vec3(0), lastLimit = vec3(0);
    for (uint k = 0u; k <= pieces; ++k) {
        SampleLocation location = edgeLocation(edge, k, pieces, float(pieces));
        DisplacedSample s = displaced(location.owner.face, vec2(0), location);
        vec3 q = s.q;
        float distance = max(length(0.5 * (q + last) - inputs.view.eye), inputs.rates.nearDistance);
        float toEye = dot(s.n, normalize(inputs.view.eye - s.p));
        facing = k > 0u && toEye * lastFacing < 0.0 ? 0.0 : min(facing, abs(toEye));
        lastFacing = toEye;
        if (k > 0u) pixels += length(q - last) * inputs.rates.pixelsAtUnitDistance / distance;
        if (k > 0u) straight += length(s.p - lastLimit);
        if (2u * k == pieces) middle = max(length(q - inputs.view.eye), inputs.rates.nearDistance);
        last = q;
        lastLimit = s.p;
    }
    float range = edgeHeightRange(edge);
    pixels = max(pixels, length(vec2(straight, range)) * inputs.rates.pixelsAtUnitDistance / middle);
    return pixels * outlineRefinement(facing);
}

void main() {
    uint edge = gl_GlobalInvocationID.x;
    if (edge >= inputs.model.edgeCount) return;
    // The halves of an edge beside an n-gon share the larger length, so that a quad's side divides evenly.
    uint partner = fetchEdge(edge).partner;
    float pixels = 0.0;
    for (uint i = 0u; i < (partner == edge ? 1u : 2u); ++i)
        pixels = max(pixels, pixelLength(i == 0u ? edge : partner));
    float rate = pixels / inputs.rates.edgePixels;
    if (inputs.rates.isFractional == 0u) rate = ceil(rate);
    uint limit = partner == edge ? inputs.rates.maxRate : max(inputs.rates.maxRate / 2u, 1u);
    // NaN compares false: it becomes 1, never a missing face.
    inputs.targets.edges.at[edge] = rate > 1.0 ? min(rate, float(limit)) : 1.0;
}
