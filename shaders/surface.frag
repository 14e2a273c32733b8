#version 460
#extension GL_GOOGLE_include_directive : require
#include "inputs.glsl"
#define RELIEF_VARYING in
#include "varyings.glsl"
#include "detail.glsl"
#include "octahedral.glsl"
#include "rounding.glsl"

// Writes what light.comp needs of the surface, four samples per pixel, and no more: dense triangles are about a pixel large,
// and what is done here is done several times per pixel.

layout(constant_id = kIdShow) const uint kShow = kShowShaded;
layout(constant_id = kIdHasInstances) const bool kHasInstances = false;
layout(constant_id = kIdWantsTexCoords) const bool kWantsTexCoords = false;

#include "techniques.glsl"

layout(constant_id = kIdShading) const uint kShading = kShadingPhysical;

layout(location = 0) out vec2 normal; // octahedral; kShadingVertexTable: coordinates in the table
layout(location = 1) out vec4 color;  // albedo, or with --show what is seen: see storedColor()
layout(location = 2) out uint instance; // kHasInstances: which one, for its material

void main() {
    vec3 n = fragmentNormal();
    if (!gl_FrontFacing && kShow != kShowNormal) n = -n;
    normal = roundToHalf(kShading == kShadingVertexTable ? vTexCoord.zw : octahedral(n));
    color = vec4(storedColor(techniqueColor(), kShow == kShowShaded), 1.0);
    if (kHasInstances) instance = inputs.view.instance;
}
