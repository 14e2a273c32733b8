#version 460
#extension GL_GOOGLE_include_directive : require
#include "locations.glsl"

layout(vertices = 1) out;
layout(location = 0) flat in uint faceIn[];
layout(location = 0) patch out uint face;
layout(location = 1) patch out vec2 insideRates; // along u and v; of a triangle both the same

void main() {
    face = faceIn[0];
    SideRate sides[kSideCount];
    Face record = fetchFace(face);
    for (uint side = 0u; side < kSideCount; ++side) sides[side] = sideRate(record.sides[side]);
#ifdef RELIEF_TRIANGLES
    // Barycentric (x,y,z) belong to corners 0, 1, 2; outer level i is the side where coordinate i is zero.
    gl_TessLevelOuter[0] = float(sides[1].segments);
    gl_TessLevelOuter[1] = float(sides[2].segments);
    gl_TessLevelOuter[2] = float(sides[0].segments);
    gl_TessLevelInner[0] = float(max(sides[0].segments, max(sides[1].segments, sides[2].segments)));
    insideRates = vec2(max(sides[0].rate, max(sides[1].rate, sides[2].rate)));
#else
    // Outer levels 0..3 are the sides u = 0, v = 0, u = 1, v = 1.
    gl_TessLevelOuter[0] = float(sides[3].segments);
    gl_TessLevelOuter[1] = float(sides[0].segments);
    gl_TessLevelOuter[2] = float(sides[1].segments);
    gl_TessLevelOuter[3] = float(sides[2].segments);
    gl_TessLevelInner[0] = float(max(sides[0].segments, sides[2].segments));
    gl_TessLevelInner[1] = float(max(sides[1].segments, sides[3].segments));
    insideRates = vec2(max(sides[0].rate, sides[2].rate), max(sides[1].rate, sides[3].rate));
#endif
}
