#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "dice.glsl"

// The samples inside faces, one workgroup per tile.
layout(local_size_x_id = kIdGroupSize) in;

#ifdef RELIEF_TRIANGLES
#include "displaced.glsl"
#else
#include "dice_tile.glsl"
#endif
#include "dice_store.glsl"

vec2 insidePoint(InsideTile tile, uvec2 ij) {
    uvec2 segments = halvesOf(tile.segments);
    if (inputs.rates.isFractional == 0u) return vec2(ij) / vec2(segments);
    Face record = fetchFace(tile.face);
    float rates[kSideCount];
    for (uint side = 0u; side < kSideCount; ++side) rates[side] = sideRate(record.sides[side]).rate;
    return fractionalPoint(ij.x, ij.y, segments, rates);
}

#ifdef RELIEF_TRIANGLES

// Number of inner sample (i,j) of a triangle with n segments per side: rows of n - 2, n - 3, ... samples.
uint insideIndex(uvec2 ij, uint n) { return (ij.y - 1u) * (n - 2u) - (ij.y - 1u) * (ij.y - 2u) / 2u + ij.x - 1u; }

void main() {
    InsideTile tile = fetchInsideTile(gl_WorkGroupID.x + push.first);
    uvec2 first = halvesOf(tile.firstIJ), size = halvesOf(tile.sizeIJ);
    uint n = halvesOf(tile.segments).x;
    for (uint k = gl_LocalInvocationID.x; k < size.x * size.y; k += gl_WorkGroupSize.x) {
        uvec2 ij = first + divided(k, size.x).yx;
        if (ij.x + ij.y >= n) continue;
        vec2 uv = insidePoint(tile, ij);
        DisplacedSample s = displaced(tile.face, uv, insideLocation(tile.face, uv));
        storeVertex(tile.firstVertex + insideIndex(ij, n), s);
    }
}

#else

void main() {
    InsideTile tile = fetchInsideTile(gl_WorkGroupID.x + push.first);
    PatchPoints patchPoints = fetchPatch(tile.patchIndex, inputs.model.pointsNow);
    if (kIsCommon) patchPoints.surface.type = patchPoints.texture.type = kPatchRegular;
    loadTile(patchPoints);
    uvec2 first = halvesOf(tile.firstIJ), size = halvesOf(tile.sizeIJ);
    float scale = float(1u << tile.depth);
    vec2 origin = vec2(halvesOf(tile.origin));
    for (uint k = gl_LocalInvocationID.x; k < size.x * size.y; k += gl_WorkGroupSize.x) {
        uvec2 ij = first + divided(k, size.x).yx;
        vec2 uv = insidePoint(tile, ij);
        DisplacedSample s = displacedInLeaf(patchPoints, Leaf(tile.patchIndex, scale * uv - origin, scale), uv,
                                             faceLevel(tile.face, uv));
        uint row = halvesOf(tile.segments).x - 1u;
        storeVertex(tile.firstVertex + (ij.y - 1u) * row + ij.x - 1u, s);
    }
}
#endif
