// For workgroups whose samples all lie in one leaf patch: its control points are fetched once and shared. On CPU drivers the
// loads that follow have constant addresses and serve all lanes at once.
#ifndef RELIEF_DICE_TILE_GLSL
#define RELIEF_DICE_TILE_GLSL

const uint kMostPoints = 20u;
shared vec3 sharedPoints[kMostPoints];
shared vec2 sharedTexPoints[kMostPoints];
vec3 ownPoints[kMostPoints];
vec2 ownTexPoints[kMostPoints];

// Only where heights depend on the rest pose.
shared vec3 sharedRestPoints[kMostPoints];
vec3 ownRestPoints[kMostPoints];

vec3 tilePoint(ControlPoints points, uint i) {
    return kReadsRest && points.array == inputs.model.pointsRest ? ownRestPoints[i] : ownPoints[i];
}
vec2 tileTexPoint(uint i) { return ownTexPoints[i]; }
uvec4 tileRow(uint row) { return 4u * row + uvec4(0, 1, 2, 3); }
#define RELIEF_POINT_ROW(points, row) tileRow(row)
#define RELIEF_POINT_INDEX(points, k) (k)
#define RELIEF_POINT tilePoint
#define RELIEF_TEX_POINT tileTexPoint
#define RELIEF_UNROLL [[unroll]] // constant indices into the arrays
#include "displaced.glsl"

void loadTile(PatchPoints patchPoints) {
    for (uint k = gl_LocalInvocationID.x; k < kMostPoints; k += gl_WorkGroupSize.x) {
        if (k < patchSize(patchPoints.surface.type)) {
            uint i = pointIndex(patchPoints.surface, k);
            sharedPoints[k] = pointAt(inputs.model.pointsNow + i).xyz;
            if (kReadsRest) sharedRestPoints[k] = pointAt(inputs.model.pointsRest + i).xyz;
        }
        if (kHasTexCoords && k < patchSize(patchPoints.texture.type))
            sharedTexPoints[k] = texPointAt(pointIndex(patchPoints.texture, k));
    }
    barrier();
    // Here, outside all branches, where a load with a constant address is one load for all lanes.
    [[unroll]] for (uint i = 0u; i < kMostPoints; ++i) ownPoints[i] = sharedPoints[i];
    if (kReadsRest) {
        [[unroll]] for (uint i = 0u; i < kMostPoints; ++i) ownRestPoints[i] = sharedRestPoints[i];
    }
    if (kHasTexCoords) {
        [[unroll]] for (uint i = 0u; i < kMostPoints; ++i) ownTexPoints[i] = sharedTexPoints[i];
    }
}
#endif
