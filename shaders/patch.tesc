#version 460
#extension GL_GOOGLE_include_directive : require
#include "places.glsl"

layout(vertices = 1) out;
layout(location = 0) flat in uint faceIn[];
layout(location = 0) patch out uint face;

void main() {
    face = faceIn[0];
    uint rates[kSideCount];
    Face record = fetchFace(face);
    for (uint side = 0u; side < kSideCount; ++side) rates[side] = sideRate(record.sides[side]);
#ifdef RELIEF_TRIANGLES
    // Barycentric (x,y,z) belong to corners 0, 1, 2; outer level i is the side where coordinate i is zero.
    gl_TessLevelOuter[0] = float(rates[1]);
    gl_TessLevelOuter[1] = float(rates[2]);
    gl_TessLevelOuter[2] = float(rates[0]);
    gl_TessLevelInner[0] = float(max(rates[0], max(rates[1], rates[2])));
#else
    // Outer levels 0..3 are the sides u = 0, v = 0, u = 1, v = 1.
    gl_TessLevelOuter[0] = float(rates[3]);
    gl_TessLevelOuter[1] = float(rates[0]);
    gl_TessLevelOuter[2] = float(rates[1]);
    gl_TessLevelOuter[3] = float(rates[2]);
    gl_TessLevelInner[0] = float(max(rates[0], rates[2]));
    gl_TessLevelInner[1] = float(max(rates[1], rates[3]));
#endif
}
