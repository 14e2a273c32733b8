// How a stage reaches its scene and the surface's arrays. Included before anything else.
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
layout(set = 0, binding = kBindWords) uniform usamplerBuffer wordTexels;
layout(set = 0, binding = kBindPoints) uniform samplerBuffer pointTexels;
layout(set = 0, binding = kBindTexPoints) uniform samplerBuffer texPointTexels;
layout(set = 0, binding = kBindEdgeRates) uniform samplerBuffer edgeRateTexels;
layout(set = 0, binding = kBindDrawFaces) uniform usamplerBuffer drawFaceTexels;
layout(set = 0, binding = kBindLevels) uniform samplerBuffer levelTexels;

layout(constant_id = 8) const bool kHasMips = false;
layout(constant_id = 10) const bool kStretches = false; // heights grow with the surface since scene.pointsRest

// The pose that patches are evaluated in: this frame's, unless a stage asks for another one.
uint pose = scene.pointsNow;

layout(constant_id = 13) const bool kHasWideNets = false;

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

Touch touchOf(uvec4 a) { return Touch(a.x, a.y & 255u, uintBitsToFloat(a.z), uintBitsToFloat(a.w)); }
Touch fetchTouch(uint i) { return touchOf(recordTexel(scene.firstTouch, kTouchTexels, i, 0u)); }

// Of a touch at a corner: its share in the direction that the faces there agree on.
float sectorShare(uint touch) { return 1.0 / float(recordTexel(scene.firstTouch, kTouchTexels, touch, 0u).y >> 8); }

Edge fetchEdge(uint i) {
    uvec4 a = recordTexel(scene.firstEdge, kEdgeTexels, i, 0u);
    uint span = a.y >> 30, partner = a.z >> 30;
    Touch owner = Touch(a.x & 0xfffffffu, a.x >> 28 & 3u, span == kSpanSecondHalf ? 0.5 : 0.0, span == kSpanFirstHalf ? 0.5 : 1.0);
    uint touches = a.w == kNoTouch ? 0u : recordTexel(scene.firstTouch, kTouchTexels, a.w, 0u).y >> 8;
    uint other = partner == kPartnerNext ? i + 1u : partner == kPartnerBefore ? i - 1u : i;
    return Edge(owner, uint[2](a.y & 0x3fffffffu, a.z & 0x3fffffffu), a.w, touches, other, a.x >> 30);
}

Corner fetchCorner(uint i) {
    uvec4 a = recordTexel(scene.firstCorner, kCornerTexels, i, 0u);
    float x = 0.5 * float(a.y & 1u);
    return Corner(Touch(a.x & 0xfffffffu, a.x >> 28 & 3u, x, x), a.z, a.y >> 1, a.x >> 30);
}

// Control points of a patch, or of the texture coordinates on it, by their numbers.
struct Net {
    uint first;    // texel
    uint base;     // that the numbers are counted from
    uint type;     // kPatch...
    uint boundary; // Far::PatchParam's mask of boundary sides
};

struct NetPair {
    Net points, texPoints;
    uint straightCorners; // as in Patch
};

NetPair fetchPatch(uint i) {
    uvec4 a = recordTexel(scene.firstPatch, kPatchTexels, i, 0u);
    return NetPair(Net(a.x, a.y, a.w & 15u, a.w >> 8 & 31u), Net(a.x + (a.w >> 18 & 63u), a.z, a.w >> 4 & 15u, a.w >> 13 & 31u), a.w >> 24);
}

// Points 4 row .. 4 row + 3 of a net.
uvec4 netRow(Net net, uint row) {
    if (kHasWideNets) return recordTexel(net.first, 1u, row, 0u);
    uvec4 eight = recordTexel(net.first, 1u, row >> 1, 0u);
    uvec2 four = (row & 1u) == 0u ? eight.xy : eight.zw;
    return net.base + uvec4(four.x & 0xffffu, four.x >> 16, four.y & 0xffffu, four.y >> 16);
}

uint netPoint(Net net, uint k) { return netRow(net, k >> 2)[k & 3u]; }

vec3 pointAt(uint i) { return texelFetch(pointTexels, int(pose + i)).xyz; }
vec2 texPointAt(uint i) { return texelFetch(texPointTexels, int(i)).xy; }

uint treeEntry(uint i) { return texelFetch(wordTexels, int(i)).x; }

float edgeRate(uint edge) { return texelFetch(edgeRateTexels, int(edge)).x; }

#endif
