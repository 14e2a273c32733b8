// Corners of faces whose own tangents span no plane, or hardly one (see shared/surface.h).
#ifndef RELIEF_CORNERS_GLSL
#define RELIEF_CORNERS_GLSL

#include "limit.glsl"

const float kParallel = 1e-6; // sine of the angle under which two tangents count as parallel

layout(constant_id = kIdHasStraightCorners) const bool kHasStraightCorners = false;

// The corner of a patch that lies at its (u,v), which halving keeps exact; one past the last corner elsewhere.
uint cornerAt(vec2 uv) {
#ifdef RELIEF_TRIANGLES
    return uv == vec2(0, 0) ? 0u : uv == vec2(1, 0) ? 1u : uv == vec2(0, 1) ? 2u : 3u;
#else
    return uv == vec2(0, 0) ? 0u : uv == vec2(1, 0) ? 1u : uv == vec2(1, 1) ? 2u : uv == vec2(0, 1) ? 3u : 4u;
#endif
}

// The direction of p_u x p_v beside such a corner, t x d; zero at all other points.
vec3 straightCornerNormal(PatchPoints patchPoints, vec2 uv) {
    uint corner = cornerAt(uv), bit = 1u << corner;
    if ((patchPoints.straightCorners & bit) == 0u) return vec3(0);
    uint first = patchSize(patchPoints.surface.type) + 2u * bitCount(patchPoints.straightCorners & (bit - 1u));
    ControlPoints points = patchPoints.surface;
    vec4 p = surfacePointAt(points, pointIndex(points, 5u * corner));
    vec3 t = offsetAt(points, pointIndex(points, first), p), d = offsetAt(points, pointIndex(points, first + 1u), p);
    precise vec3 normal = cross(t, d);
    return dot(normal, normal) > kParallel * kParallel * dot(t, t) * dot(d, d) ? normal : vec3(0);
}
#endif
