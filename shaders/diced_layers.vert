#version 460
#extension GL_GOOGLE_include_directive : require
#include "locations.glsl"
#include "shared/dice.h"
#define RELIEF_VARYING out
#include "varyings.glsl"
#include "project.glsl"

// One face of a diced mesh, for layers. Its vertices are shared with other faces, so that where one lies in this face follows
// from the vertex's number: runs along the sides first, then the lattice inside.
layout(push_constant, scalar) uniform PushBlock { DicedFacePush push; };

RELIEF_TABLE(kBindMesh, vec4, meshAt)
RELIEF_TABLE(kBindMeshTexCoords, vec2, meshTexCoords)
#include "mesh_gradients.glsl"

layout(constant_id = kIdHasTexCoords) const bool kHasTexCoords = false;

vec2 latticePoint(uint i, uint j, uvec2 n) {
    if (inputs.rates.isFractional == 0u) return vec2(i, j) / vec2(n);
    float rates[kSideCount];
    for (uint side = 0u; side < kSideCount; ++side) rates[side] = push.rates[side];
    return fractionalPoint(i, j, n, rates);
}

// Number k inside the face: row after row of the lattice without its border.
vec2 insidePoint(uint k) {
#ifdef RELIEF_TRIANGLES
    uvec2 n = latticeSegments(3u, push.segments[0], push.segments[1], push.segments[2], 0u);
    uint j = 1u;
    for (uint row = n.x - 2u; k >= row; --row) {
        k -= row;
        ++j;
    }
    return latticePoint(k + 1u, j, n);
#else
    uvec2 n = latticeSegments(4u, push.segments[0], push.segments[1], push.segments[2], push.segments[3]);
    return latticePoint(k % (n.x - 1u) + 1u, k / (n.x - 1u) + 1u, n);
#endif
}

// Where a vertex lies along a side, 0 to less than 1; -1 where it is not on that side.
float alongSide(uint side, uint vertex) {
    uint entry = push.sides[side];
    uint halves = (entry & kSideSplit) != 0u ? 2u : 1u, n = push.segments[side] / halves;
    if (vertex == push.runs.corners[side]) return 0.0;
    if (halves == 2u && vertex == push.runs.middles[side]) return 0.5;
    for (uint half_ = 0u; half_ < halves; ++half_) {
        uint before = vertex - push.runs.sides[2u * side + half_]; // in its run; wraps where the vertex is in an earlier one
        if (before >= n - 1u) continue;
        float x = (float(half_) + sampleParameter(before + 1u, n, push.rates[side] / float(halves))) / float(halves);
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

void main() {
    uint vertex = uint(gl_VertexIndex);
    vec4 at = meshAt(2u * vertex);
    precise vec4 clip = project(at.xyz);
    gl_Position = clip;
    vNormal = worldNormal(meshAt(2u * vertex + 1u).xyz);
    vec2 uv = vertex >= push.firstInside ? insidePoint(vertex - push.firstInside) : borderPoint(vertex);
    vTexCoord = vec4(kHasTexCoords ? meshTexCoords(vertex) : uv, uv);
    vHeight = at.w;
    readGradients(vertex);
    vFace = push.face;
    vRate = 1u;
}
