// Where the vertices of a diced mesh lie in a face. They are shared with other faces, so that this follows from their numbers:
// runs along the sides first, then the lattice inside. RELIEF_DICED_FACE: the face, a DicedFacePush.
#ifndef RELIEF_DICED_POINTS_GLSL
#define RELIEF_DICED_POINTS_GLSL

#include "locations.glsl"
#include "shared/dice.h"

vec2 latticePoint(uint i, uint j, uvec2 n) {
    if (inputs.rates.isFractional == 0u) return vec2(i, j) / vec2(n);
    float rates[kSideCount];
    for (uint side = 0u; side < kSideCount; ++side) rates[side] = RELIEF_DICED_FACE.rates[side];
    return fractionalPoint(i, j, n, rates);
}

// Number k inside the face: row after row of the lattice without its border.
vec2 insidePoint(uint k) {
#ifdef RELIEF_TRIANGLES
    uvec2 n = latticeSegments(3u, RELIEF_DICED_FACE.segments[0], RELIEF_DICED_FACE.segments[1], RELIEF_DICED_FACE.segments[2], 0u);
    uint j = 1u;
    for (uint row = n.x - 2u; k >= row; --row) {
        k -= row;
        ++j;
    }
    return latticePoint(k + 1u, j, n);
#else
    uvec2 n = latticeSegments(4u, RELIEF_DICED_FACE.segments[0], RELIEF_DICED_FACE.segments[1], RELIEF_DICED_FACE.segments[2],
                              RELIEF_DICED_FACE.segments[3]);
    return latticePoint(k % (n.x - 1u) + 1u, k / (n.x - 1u) + 1u, n);
#endif
}

// Where a vertex lies along a side, 0 to less than 1; -1 where it is not on that side.
float alongSide(uint side, uint vertex) {
    uint entry = RELIEF_DICED_FACE.sides[side];
    uint halves = (entry & kSideSplit) != 0u ? 2u : 1u, n = RELIEF_DICED_FACE.segments[side] / halves;
    if (vertex == RELIEF_DICED_FACE.runs.corners[side]) return 0.0;
    if (halves == 2u && vertex == RELIEF_DICED_FACE.runs.middles[side]) return 0.5;
    for (uint half_ = 0u; half_ < halves; ++half_) {
        uint before = vertex - RELIEF_DICED_FACE.runs.sides[2u * side + half_]; // in its run; wraps where the vertex is in an earlier one
        if (before >= n - 1u) continue;
        float x = (float(half_) + sampleParameter(before + 1u, n, RELIEF_DICED_FACE.rates[side] / float(halves))) / float(halves);
        return (entry & kSideReversed) != 0u ? 1.0 - x : x;
    }
    return -1.0;
}

vec2 borderPoint(uint vertex) {
    vec2 uv = vec2(0);
    for (uint side = 0u; side < kSideCount; ++side) {
        float x = alongSide(side, vertex);
        if (x >= 0.0) uv = sidePoint(side, x);
    }
    return uv;
}

vec2 dicedPoint(uint vertex) {
    uint firstInside = RELIEF_DICED_FACE.firstInside;
    return vertex >= firstInside ? insidePoint(vertex - firstInside) : borderPoint(vertex);
}
#endif
