#version 460
#extension GL_GOOGLE_include_directive : require
#include "displaced.glsl"
#include "emit.glsl"

#ifdef RELIEF_TRIANGLES
layout(triangles, equal_spacing, cw) in;
#else
layout(quads, equal_spacing, cw) in;
#endif

layout(location = 0) patch in uint face;

const uint kInside = 4u;

// The side a vertex lies on, and how far along.
uint findSide(out float x) {
    vec3 c = gl_TessCoord;
    x = 0.0;
#ifdef RELIEF_TRIANGLES
    if (c.z == 0.0) { x = c.y; return 0u; }
    if (c.x == 0.0) { x = c.z; return 1u; }
    if (c.y == 0.0) { x = c.x; return 2u; }
#else
    if (c.y == 0.0) { x = c.x; return 0u; }
    if (c.x == 1.0) { x = c.y; return 1u; }
    if (c.y == 1.0) { x = 1.0 - c.x; return 2u; }
    if (c.x == 0.0) { x = 1.0 - c.y; return 3u; }
#endif
    return kInside;
}

void main() {
#ifdef RELIEF_TRIANGLES
    vec2 uv = gl_TessCoord.yz;
#else
    vec2 uv = gl_TessCoord.xy;
#endif
    float x;
    uint side = findSide(x);
    Place place = insidePlace(face, uv);
    if (side != kInside) {
        // The tessellator's coordinate only says which sample of the edge this is.
        uint entry = fetchFace(face).sides[side];
        uint n = sideRate(entry);
        place = sidePlace(entry, uint(round(x * float(n))), n);
    }
#ifdef RELIEF_TRIANGLES
    float rate = gl_TessLevelInner[0];
#else
    float rate = max(gl_TessLevelInner[0], gl_TessLevelInner[1]);
#endif
    emitVertex(face, uv, place, uint(rate));
}
