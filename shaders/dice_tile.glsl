// For workgroups whose samples all lie in one leaf patch: its control points are fetched once and shared. On CPU drivers the
// loads that follow have constant addresses and serve all lanes at once.
#ifndef RELIEF_DICE_TILE_GLSL
#define RELIEF_DICE_TILE_GLSL

const uint kMostPoints = 20u;
shared vec3 sharedPoints[kMostPoints];
shared vec2 sharedTexPoints[kMostPoints];
vec3 ownPoints[kMostPoints];
vec2 ownTexPoints[kMostPoints];

// Only where heights stretch: of the rest pose.
shared vec3 sharedRestPoints[kMostPoints];
vec3 ownRestPoints[kMostPoints];

vec3 tilePoint(uint i) { return kStretches && pose == scene.pointsRest ? ownRestPoints[i] : ownPoints[i]; }
vec2 tileTexPoint(uint i) { return ownTexPoints[i]; }
#define RELIEF_PATCH_POINT tilePoint
#define RELIEF_TEX_PATCH_POINT tileTexPoint
#define RELIEF_UNROLL [[unroll]] // constant places in the arrays
#include "displaced.glsl"

vec3 restPoint(uint i) {
    pose = scene.pointsRest;
    vec3 p = patchPoint(i);
    pose = scene.pointsNow;
    return p;
}

void loadTile(Patch patch_) {
    for (uint i = gl_LocalInvocationID.x; i < kMostPoints; i += gl_WorkGroupSize.x) {
        if (i < patchSize(patch_.type)) sharedPoints[i] = patchPoint(patch_.firstPoint + i);
        if (kStretches && i < patchSize(patch_.type)) sharedRestPoints[i] = restPoint(patch_.firstPoint + i);
        if (kHasTexCoords && i < patchSize(patch_.texType)) sharedTexPoints[i] = texPatchPoint(patch_.texFirstPoint + i);
    }
    barrier();
    // Here, outside all branches, where a load with a constant address is one load for all lanes.
    [[unroll]] for (uint i = 0u; i < kMostPoints; ++i) ownPoints[i] = sharedPoints[i];
    if (kStretches) {
        [[unroll]] for (uint i = 0u; i < kMostPoints; ++i) ownRestPoints[i] = sharedRestPoints[i];
    }
    if (kHasTexCoords) {
        [[unroll]] for (uint i = 0u; i < kMostPoints; ++i) ownTexPoints[i] = sharedTexPoints[i];
    }
}
#endif
