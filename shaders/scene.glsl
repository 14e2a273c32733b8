// How a stage heightBounds its scene and the surface's arrays. Included before anything else.
#ifndef RELIEF_SCENE_GLSL
#define RELIEF_SCENE_GLSL

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

#include "shared/scene.h"

layout(set = 0, binding = kBindScene, scalar) uniform SceneBlock { Scene scene; };

layout(push_constant, scalar) uniform Push {
    uint passNumber;     // grid: segments along u; sample: number of queries
    uint drawsShadow;    // 1: from the key light
    uint passRows;       // grid: segments along v
    uint passFirst;      // grid: where the draw's captured vertices begin
};

layout(set = 0, binding = kBindRecords) uniform usamplerBuffer recordTexels;
layout(set = 0, binding = kBindTree) uniform usamplerBuffer treeTexels;
layout(set = 0, binding = kBindPoints) uniform samplerBuffer pointTexels;
layout(set = 0, binding = kBindTexPoints) uniform samplerBuffer texPointTexels;
layout(set = 0, binding = kBindEdgeRates) uniform samplerBuffer edgeRateTexels;
layout(set = 0, binding = kBindDrawFaces) uniform usamplerBuffer drawFaceTexels;
layout(set = 0, binding = kBindLevels) uniform samplerBuffer levelTexels;

layout(constant_id = 8) const bool kHasMips = false;
layout(constant_id = 10) const bool kStretches = false; // heights grow with the surface since scene.pointsRest

// The pose that patches are evaluated in: this frame's, unless a stage asks for another one.
uint pose = scene.pointsNow;

layout(constant_id = 13) const bool kHasWideIndices = false;

uvec4 recordTexel(uint first, uint texels, uint index, uint texel) {
    return texelFetch(recordTexels, int(first + texels * index + texel));
}

// --- records: the bits are those of shared/records.h ------------------------------------------------------------------

uint faceRoot(uint face) { return recordTexel(scene.firstFace, kFaceTexels, face, 0u).x; }
uint cageFaceOf(uint face) { return recordTexel(scene.firstFace, kFaceTexels, face, 1u).y; }

Face fetchFace(uint face) {
    uvec4 a = recordTexel(scene.firstFace, kFaceTexels, face, 0u), b = recordTexel(scene.firstFace, kFaceTexels, face, 1u);
    return Face(a.x, uint[4](a.y, a.z, a.w, b.x), b.y);
}

Incidence unpackIncidence(uvec4 a) { return Incidence(a.x, a.y & 255u, uintBitsToFloat(a.z), uintBitsToFloat(a.w)); }
Incidence fetchIncidence(uint i) { return unpackIncidence(recordTexel(scene.firstIncidence, kIncidenceTexels, i, 0u)); }

// Of a incidence at a corner: its share in the direction that the faces there agree on.
float sectorShare(uint incidence) { return 1.0 / float(recordTexel(scene.firstIncidence, kIncidenceTexels, incidence, 0u).y >> 8); }

Edge fetchEdge(uint i) {
    uvec4 a = recordTexel(scene.firstEdge, kEdgeTexels, i, 0u);
    uint span = a.y >> 30, partner = a.z >> 30;
    Incidence owner = Incidence(a.x & 0xfffffffu, a.x >> 28 & 3u, span == kSpanSecondHalf ? 0.5 : 0.0, span == kSpanFirstHalf ? 0.5 : 1.0);
    uint incidences = a.w == kNoIncidence ? 0u : recordTexel(scene.firstIncidence, kIncidenceTexels, a.w, 0u).y >> 8;
    uint other = partner == kPartnerNext ? i + 1u : partner == kPartnerBefore ? i - 1u : i;
    return Edge(owner, uint[2](a.y & 0x3fffffffu, a.z & 0x3fffffffu), a.w, incidences, other, a.x >> 30);
}

Corner fetchCorner(uint i) {
    uvec4 a = recordTexel(scene.firstCorner, kCornerTexels, i, 0u);
    float x = 0.5 * float(a.y & 1u);
    return Corner(Incidence(a.x & 0xfffffffu, a.x >> 28 & 3u, x, x), a.z, a.y >> 1, a.x >> 30);
}

// Control points of a patch, or of the texture coordinates on it, by their numbers.
struct ControlPoints {
    uint first;    // texel
    uint base;     // that the numbers are counted from
    uint type;     // kPatch...
    uint boundary; // Far::PatchParam's mask of boundary sides
};

struct PatchPoints {
    ControlPoints surface, texture;
    uint straightCorners; // as in Patch
};

PatchPoints fetchPatch(uint i) {
    uvec4 a = recordTexel(scene.firstPatch, kPatchTexels, i, 0u);
    return PatchPoints(ControlPoints(a.x, a.y, a.w & 15u, a.w >> 8 & 31u), ControlPoints(a.x + (a.w >> 18 & 63u), a.z, a.w >> 4 & 15u, a.w >> 13 & 31u), a.w >> 24);
}

// Points 4 row .. 4 row + 3 of a points.
uvec4 pointRow(ControlPoints points, uint row) {
    if (kHasWideIndices) return recordTexel(points.first, 1u, row, 0u);
    uvec4 eight = recordTexel(points.first, 1u, row >> 1, 0u);
    uvec2 four = (row & 1u) == 0u ? eight.xy : eight.zw;
    return points.base + uvec4(four.x & 0xffffu, four.x >> 16, four.y & 0xffffu, four.y >> 16);
}

uint pointIndex(ControlPoints points, uint k) { return pointRow(points, k >> 2)[k & 3u]; }

vec3 pointAt(uint i) { return texelFetch(pointTexels, int(pose + i)).xyz; }
vec2 texPointAt(uint i) { return texelFetch(texPointTexels, int(i)).xy; }

uint treeEntry(uint i) { return texelFetch(treeTexels, int(i)).x; }

float edgeRate(uint edge) { return texelFetch(edgeRateTexels, int(edge)).x; }

#endif
