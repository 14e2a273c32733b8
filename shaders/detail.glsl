// The normal of a fragment: the vertices' own, bent by the slopes of heights (bump mapping), and turned by a normal map.
#ifndef RELIEF_DETAIL_GLSL
#define RELIEF_DETAIL_GLSL

#include "project.glsl"
#include "shared/displacement.h"

layout(constant_id = kIdHasHeight) const bool kHasHeight = false; // vertices are displaced
layout(constant_id = kIdHasSlopes) const bool kHasSlopes = false;
layout(constant_id = kIdNormalMap) const uint kNormalMap = kNormalMapNone;

layout(set = 0, binding = kBindSlopes) uniform sampler2D slopeMap;
layout(set = 0, binding = kBindNormalMap) uniform sampler2D normalMap;

#include "lookup.glsl"

// Added to the mip level that fits a pixel: displaced triangles show what each of four samples per pixel meets, and these are
// half a pixel apart.
const float kSampleLevel = -1.0;

// The slopes (h_s, h_t) of the map, at the mip that fits the samples: vertices have none of them. Central differences over one
// texel commute with interpolation between texels, so they are taken once per texel, and the sampler does the rest.
vec2 mapSlopes() {
    vec2 slopes = inputs.model.slopeUnit * lookUp(slopeMap, inputs.model.slopeTiles, kSampleLevel).rg;
    return kHasPictureTiles ? slopes * inputs.model.slopeTiles.zw : slopes; // by s and t of the picture before
}

// The normal map at the fragment: a mean of unit normals, shorter than 1 where they differ.
vec3 mappedNormal() { return lookUp(normalMap, inputs.model.normalTiles, 0.0).xyz; }

vec3 unitOrElse(vec3 m, vec3 n) { return dot(m, m) > 0.0 ? normalize(m) : n; }

// The mapped normal in the frame of the unit normal n: T along p_s, made perpendicular to n (interpolated and stretched tangents are
// not), B = n x T on the side of p_t.
vec3 turnedNormal(vec3 n, vec3 ps, float side) {
    vec3 tangent = ps - n * dot(n, ps);
    if (!(dot(tangent, tangent) > 0.0)) return n;
    tangent = normalize(tangent);
    vec3 c = mappedNormal();
    return unitOrElse(c.x * tangent + c.y * side * cross(n, tangent) + c.z * n, n);
}

#ifdef RELIEF_HEIGHT_FUNCTION
#include "function.glsl"

#ifdef RELIEF_OWN_DERIVATIVES // how vRest changes from a pixel to the next
vec3 restStepX, restStepY;
#else
layout(constant_id = kIdHasTexCoords) const bool kHasTexCoords = false;
#endif

// How far the points at rest of neighbouring pixels are apart.
float pixelAtRest() {
#ifdef RELIEF_OWN_DERIVATIVES
    return max(length(restStepX), length(restStepY));
#else
    return max(length(dFdx(vRest)), length(dFdy(vRest)));
#endif
}

// Gradient of the function's height along the surface, by central differences in directions that are perpendicular to each other:
// over half a pixel, for samples are that far apart, and at least over the step of vertices. Two directions span the surface;
// vertices that stretch have slopes of their own, and gradients are not perpendicular to their normals.
vec3 functionGradient(vec3 n, vec3 gradientS, vec3 gradientT) {
    float d = max(0.25 * pixelAtRest(), inputs.model.heightStep);
    vec3 first = normalize(abs(n.x) < 0.7 ? cross(n, vec3(1, 0, 0)) : cross(n, vec3(0, 1, 0)));
    vec3 gradient = vec3(0);
    for (uint i = 0u; i < (kStretches && kHasHeight ? 6u : 4u); ++i) {
        vec3 direction = i < 2u ? first : i < 4u ? cross(n, first) : n;
        vec3 atRest = vRestGradient * direction;
        float size = length(atRest);
        if (!(size > 0.0)) continue;
        float along = ((i & 1u) == 0u ? d : -d) / size;
        vec2 st = vTexCoord.xy + along * vec2(dot(gradientS, direction), dot(gradientT, direction));
        gradient += heightOfFunction(vRest + along * atRest, kHasTexCoords ? st : vec2(0)) / (2.0 * along) * direction;
    }
    return gradient;
}
#endif

vec3 fragmentNormal() {
    if (!kHasSlopes && kNormalMap == kNormalMapNone) return vNormal;
    vec3 n = normalize(vNormal);
    if (kNormalMap == kNormalMapObject) return unitOrElse(worldNormal(mappedNormal()), n);
    vec3 gradientS = vGradientS.xyz, gradientT = vGradientT.xyz;
#ifdef RELIEF_HEIGHT_FUNCTION
    vec3 rise = kHasSlopes ? functionGradient(n, gradientS, gradientT) : vec3(0);
    vec2 slopes = vec2(0);
    vec3 bent = unitOrElse(n - rise, n);
#else
    vec2 slopes = kHasSlopes ? mapSlopes() : vec2(0);
    vec3 bent = kHasSlopes ? unitOrElse(bumpedNormal(n, gradientS, gradientT, slopes), n) : n;
#endif
    if (kNormalMap == kNormalMapNone) return bent;
    // p_s = (grad t x n) / (n . (grad s x grad t)); by the slope it rises along the normal of the limit surface, which both
    // gradients are perpendicular to.
    vec3 across = cross(gradientS, gradientT);
    float density = length(across);
    if (density == 0.0) return bent;
    float side = dot(n, across) < 0.0 ? -1.0 : 1.0; // -1 where texture coordinates are mirrored
    vec3 ps = side / density * cross(gradientT, n);
#ifdef RELIEF_HEIGHT_FUNCTION
    slopes.x = dot(rise, ps);
#endif
    return turnedNormal(bent, ps + slopes.x * side / density * across, side);
}
#endif
