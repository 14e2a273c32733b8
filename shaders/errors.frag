#version 460
#extension GL_GOOGLE_include_directive : require
#include "displaced.glsl"
#define RELIEF_VARYING in
#include "varyings.glsl"
#include "octahedral.glsl"
#include "rounding.glsl"

// How far triangles are from the surface that they stand for: what surface.frag writes, in colours of that distance.

layout(constant_id = kIdShow) const uint kShow = kShowError;
layout(constant_id = kIdIsMesh) const bool kIsMesh = false; // the triangles are the surface
layout(constant_id = kIdHasInstances) const bool kHasInstances = false;

#include "techniques.glsl"

layout(location = 0) out vec2 normal; // octahedral
layout(location = 1) out vec4 color;
layout(location = 2) out uint instance; // kHasInstances

vec3 positionAt(vec2 pixel) {
    vec4 position = inputs.view.fromClip * vec4(pixel / vec2(inputs.view.pictureSize) * 2.0 - 1.0, gl_FragCoord.z, 1.0);
    return position.xyz / position.w;
}

// Fragments at a side of a face may have their centre beside it.
vec2 pointInFace() {
    vec2 uv = clamp(vTexCoord.zw, 0.0, 1.0);
#ifdef RELIEF_TRIANGLES
    uv /= max(uv.x + uv.y, 1.0);
#endif
    return uv;
}

// The distance from the tangent plane of the surface at the same (face,u,v), in pixels, positive outside: it differs from the
// distance to the surface by the square of how far along the surface the two points are apart. The surface has the full map, at
// no mip level.
float signedError() {
    if (kIsMesh) return 0.0;
    vec2 uv = pointInFace();
    SampleLocation location = insideLocation(vFace, uv);
    location.level = 0.0;
    DisplacedSample there = displaced(vFace, uv, location);
    float pixel = length(positionAt(gl_FragCoord.xy + vec2(0.0, 1.0)) - positionAt(gl_FragCoord.xy));
    // The point is interpolated as (u,v) is: SwiftShader takes both at another place than gl_FragCoord says.
    return dot(there.normal, vGradientS.xyz - there.q) / pixel;
}

void main() {
    vec3 n = normalize(vNormal);
    normal = roundToHalf(octahedral(gl_FrontFacing ? n : -n));
    color = vec4(storedColor(heightColor(signedError()), false), 1.0);
    if (kHasInstances) instance = inputs.view.instance;
}
