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

uvec4 recordTexel(uint first, uint texels, uint index, uint texel) {
    return texelFetch(recordTexels, int(first + texels * index + texel));
}

uint faceRoot(uint face) { return recordTexel(scene.firstFace, kFaceTexels, face, 0u).x; }

// The order of words is that of the structs in shared/surface.h.
Face fetchFace(uint face) {
    uvec4 a = recordTexel(scene.firstFace, kFaceTexels, face, 0u), b = recordTexel(scene.firstFace, kFaceTexels, face, 1u);
    return Face(a.x, uint[4](a.y, a.z, a.w, b.x), b.y);
}

Patch fetchPatch(uint i) {
    uvec4 a = recordTexel(scene.firstPatch, kPatchTexels, i, 0u), b = recordTexel(scene.firstPatch, kPatchTexels, i, 1u);
    return Patch(a.x, a.y, a.z, a.w, b.x, b.y, b.z);
}

Touch touchOf(uvec4 a) { return Touch(a.x, a.y, uintBitsToFloat(a.z), uintBitsToFloat(a.w)); }

Touch fetchTouch(uint i) { return touchOf(recordTexel(scene.firstTouch, kTouchTexels, i, 0u)); }

Edge fetchEdge(uint i) {
    uvec4 a = recordTexel(scene.firstEdge, kEdgeTexels, i, 0u), b = recordTexel(scene.firstEdge, kEdgeTexels, i, 1u);
    uvec4 c = recordTexel(scene.firstEdge, kEdgeTexels, i, 2u);
    return Edge(touchOf(a), uint[2](b.x, b.y), b.z, b.w, c.x, c.y);
}

Corner fetchCorner(uint i) {
    uvec4 b = recordTexel(scene.firstCorner, kCornerTexels, i, 1u);
    return Corner(touchOf(recordTexel(scene.firstCorner, kCornerTexels, i, 0u)), b.x, b.y, b.z);
}

uint treeEntry(uint i) { return texelFetch(wordTexels, int(i)).x; }

vec3 patchPoint(uint i) {
    uint point = texelFetch(wordTexels, int(scene.firstPatchPoint + i)).x;
    return texelFetch(pointTexels, int(pose + point)).xyz;
}

vec2 texPatchPoint(uint i) {
    uint point = texelFetch(wordTexels, int(scene.firstTexPatchPoint + i)).x;
    return texelFetch(texPointTexels, int(point)).xy;
}

float edgeRate(uint edge) { return texelFetch(edgeRateTexels, int(edge)).x; }

#endif
