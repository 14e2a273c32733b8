#version 460
#extension GL_GOOGLE_include_directive : require
#include "displaced.glsl"
#define RELIEF_VARYING in
#include "varyings.glsl"
#include "octahedral.glsl"
#include "rounding.glsl"
#include "errors.glsl"

// How far triangles are from the surface that they stand for: what surface.frag writes, in colours of that distance.

layout(constant_id = kIdShow) const uint kShow = kShowError;
layout(constant_id = kIdIsMesh) const bool kIsMesh = false; // the triangles are the surface
layout(constant_id = kIdHasInstances) const bool kHasInstances = false;

#include "techniques.glsl"

layout(location = 0) out vec2 normal; // octahedral
layout(location = 1) out vec4 color;
layout(location = 2) out uint instance; // kHasInstances

// In pixels. The point is interpolated as (u,v) is: SwiftShader takes both at another place than gl_FragCoord says.
float signedError() {
    if (kIsMesh) return 0.0;
    vec2 ndc = gl_FragCoord.xy / vec2(inputs.view.pictureSize) * 2.0 - 1.0;
    return signedDistance(vFace, vTexCoord.zw, vGradientS.xyz) / pixelWidth(ndc, gl_FragCoord.z);
}

void main() {
    vec3 n = normalize(vNormal);
    normal = roundToHalf(octahedral(gl_FrontFacing ? n : -n));
    color = vec4(storedColor(heightColor(signedError()), false), 1.0);
    if (kHasInstances) instance = inputs.view.instance;
}
