#version 460
#extension GL_GOOGLE_include_directive : require
#include "inputs.glsl"
#define RELIEF_VARYING in
#include "varyings.glsl"
#include "detail.glsl"
#include "octahedral.glsl"

// Which point of the surface a pixel sees at its centre: what layers.comp reads.
layout(location = 0) out vec4 normalAndTexCoords; // octahedral, (s,t)
layout(location = 1) out vec4 surfacePoint;       // (u,v) in the face, height, the face's number and 1
layout(location = 2) out uint instance;           // kHasInstances

layout(constant_id = kIdHasInstances) const bool kHasInstances = false;

void main() {
    vec3 n = fragmentNormal();
    normalAndTexCoords = vec4(octahedral(gl_FrontFacing ? n : -n), vTexCoord.xy);
    surfacePoint = vec4(vTexCoord.zw, vHeight, float(vFace) + 1.0);
    if (kHasInstances) instance = inputs.view.instance;
}
