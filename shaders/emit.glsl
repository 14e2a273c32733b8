// The end of every stage that makes vertices of the displaced surface.
#define RELIEF_VARYING out
#include "varyings.glsl"
#include "project.glsl"
#include "vertex_table.glsl"

#ifdef RELIEF_CAPTURES_STREAM
layout(xfb_buffer = 0, xfb_stride = 16, xfb_offset = 0, location = 7) out vec4 captured; // position, 1 on a boundary
#endif

// Returns what captures hold of the vertex: its position, and 1 on a boundary.
vec4 emitVertex(uint face, vec2 uv, SampleLocation location, uint rate) {
    DisplacedSample s = displaced(face, uv, location);
    precise vec4 clip = project(s.q);
    gl_Position = clip;
    vNormal = worldNormal(s.normal);
    vTexCoord = vec4(s.st, uv);
    if (kShading == kShadingVertexTable && kPass == kPassSurface) vTexCoord.zw = tableCoordinates(vNormal, s.q);
    vHeight = s.h;
    vGradientS = kHasTexGradients ? worldGradient(s.gradientS) : kPass == kPassLayers ? vec4(s.q, 0.0) : vec4(0);
    vGradientT = kHasTexGradients ? worldGradient(s.gradientT) : vec4(0);
#ifdef RELIEF_HEIGHT_FUNCTION
    vRest = s.rest;
    vRestGradient = worldGradients(s.restGradient);
#endif
    vFace = kPass == kPassLayers ? face : cageFaceOf(face);
    vRate = rate;
    vec4 vertex = vec4(s.q, (location.flags & kOnBoundary) != 0u ? 1.0 : 0.0);
#ifdef RELIEF_CAPTURES_STREAM
    captured = vertex;
#endif
    return vertex;
}
