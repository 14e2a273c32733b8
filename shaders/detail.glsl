// The normal of a fragment: the vertices' own, bent by the slopes of heights (bump mapping), and turned by a normal map.
#ifndef RELIEF_DETAIL_GLSL
#define RELIEF_DETAIL_GLSL

#include "project.glsl"
#include "shared/displacement.h"

layout(constant_id = kIdHasSlopes) const bool kHasSlopes = false;
layout(constant_id = kIdNormalMap) const uint kNormalMap = kNormalMapNone;

layout(set = 0, binding = kBindSlopes) uniform sampler2D slopeMap;
layout(set = 0, binding = kBindNormalMap) uniform sampler2D normalMap;

// Where (s,t) lies in a picture, whose rows go down.
vec2 pictureCoordinates() { return vec2(vTexCoord.x, 1.0 - vTexCoord.y); }

// What the vertices' normals lack of the slopes (h_s, h_t) of the map, at the mip that fits the pixel: all of them on a surface
// that is not displaced; on a displaced one what its triangles are too large for. Central differences over one texel commute
// with interpolation between texels, so they are taken once per texel, and the sampler does the rest.
vec2 missingSlopes() {
    return inputs.model.slopeUnit * texture(slopeMap, pictureCoordinates()).rg - vec2(vTangentS.w, vTangentT.w);
}

// What the normal map holds: a mean of unit normals, of any length.
vec3 mappedNormal() { return texture(normalMap, pictureCoordinates()).xyz; }

vec3 fragmentNormal() {
    if (!kHasSlopes && kNormalMap == kNormalMapNone) return vNormal;
    vec3 n = normalize(vNormal);
    if (kNormalMap == kNormalMapObject) {
        vec3 m = worldNormal(mappedNormal());
        return dot(m, m) > 0.0 ? normalize(m) : n;
    }
    vec3 ps = vTangentS.xyz, pt = vTangentT.xyz;
    float side = dot(n, cross(ps, pt)) < 0.0 ? -1.0 : 1.0; // islands whose texture coordinates are mirrored
    vec3 bent = n;
    if (kHasSlopes) {
        vec2 slopes = missingSlopes();
        bent = bumpedNormal(n, ps, pt, slopes);
        bent = dot(bent, bent) > 0.0 ? normalize(bent) : n;
        ps += slopes.x * n; // along the surface that the slopes stand for
    }
    if (kNormalMap == kNormalMapNone) return bent;
    // Interpolated and stretched tangents are not perpendicular to the normal.
    vec3 tangent = ps - bent * dot(bent, ps);
    if (!(dot(tangent, tangent) > 0.0)) return bent;
    tangent = normalize(tangent);
    vec3 c = mappedNormal();
    vec3 m = c.x * tangent + c.y * side * cross(bent, tangent) + c.z * bent;
    return dot(m, m) > 0.0 ? normalize(m) : bent;
}
#endif
