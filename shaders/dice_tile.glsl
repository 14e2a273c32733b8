// For workgroups whose samples all lie in one leaf patch: its control points are fetched once and shared. On CPU drivers the
// loads that follow have constant addresses and serve all lanes at once.
#ifndef RELIEF_DICE_TILE_GLSL
#define RELIEF_DICE_TILE_GLSL

const uint kMostPoints = 20u;
shared vec3 sharedOffsets[kMostPoints];
shared vec2 sharedTexPoints[kMostPoints];
vec4 ownOrigin;
vec3 ownOffsets[kMostPoints];
vec2 ownTexPoints[kMostPoints];

// Only where heights depend on the rest pose.
shared vec3 sharedRestOffsets[kMostPoints];
vec4 ownRestOrigin;
vec3 ownRestOffsets[kMostPoints];

bool isRest(ControlPoints points) { return kReadsRest && points.array == inputs.model.pointsRest; }
vec3 tileOffset(ControlPoints points, uint i) { return isRest(points) ? ownRestOffsets[i] : ownOffsets[i]; }
vec2 tileTexPoint(uint i) { return ownTexPoints[i]; }
uvec4 tileRow(uint row) { return 4u * row + uvec4(0, 1, 2, 3); }
#define RELIEF_POINT_ROW(points, row) tileRow(row)
#define RELIEF_POINT_INDEX(points, k) (k)
#define RELIEF_OFFSET(points, i, origin) tileOffset(points, i)
#define RELIEF_ORIGIN(points) (isRest(points) ? ownRestOrigin : ownOrigin)
#define RELIEF_TEX_POINT tileTexPoint
#define RELIEF_UNROLL [[unroll]] // constant indices into the arrays
#include "displaced.glsl"

void loadTile(PatchPoints patchPoints) {
    ControlPoints points = patchPoints.surface, restPoints = inPose(points, inputs.model.pointsRest);
    uint originPoint = pointIndex(points, originIndex(points.type));
    ownOrigin = surfacePointAt(points, originPoint);
    if (kReadsRest) ownRestOrigin = surfacePointAt(restPoints, originPoint);
    for (uint k = gl_LocalInvocationID.x; k < kMostPoints; k += gl_WorkGroupSize.x) {
        if (k < patchSize(points.type)) {
            uint i = pointIndex(points, k);
            sharedOffsets[k] = offsetAt(points, i, ownOrigin);
            if (kReadsRest) sharedRestOffsets[k] = offsetAt(restPoints, i, ownRestOrigin);
        }
        if (kHasTexCoords && k < patchSize(patchPoints.texture.type))
            sharedTexPoints[k] = texPointAt(pointIndex(patchPoints.texture, k));
    }
    barrier();
    // Here, outside all branches, where a load with a constant address is one load for all lanes.
    [[unroll]] for (uint i = 0u; i < kMostPoints; ++i) ownOffsets[i] = sharedOffsets[i];
    if (kReadsRest) {
        [[unroll]] for (uint i = 0u; i < kMostPoints; ++i) ownRestOffsets[i] = sharedRestOffsets[i];
    }
    if (kHasTexCoords) {
        [[unroll]] for (uint i = 0u; i < kMostPoints; ++i) ownTexPoints[i] = sharedTexPoints[i];
    }
}
#endif
