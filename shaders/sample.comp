#version 460
#extension GL_GOOGLE_include_directive : require
#ifndef RELIEF_TRIANGLES
#define RELIEF_GENERIC_BASIS
#endif
#include "displaced.glsl"

layout(local_size_x = 64) in;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= passNumber) return;
    uint face = scene.sampleQueries.at[i].face;
    vec2 uv = scene.sampleQueries.at[i].uv;
    DisplacedSample s = displaced(face, uv, insideLocation(face, uv));
    scene.sampleResults.at[i].p = s.p;
    scene.sampleResults.at[i].pu = s.frame.pu;
    scene.sampleResults.at[i].pv = s.frame.pv;
    scene.sampleResults.at[i].puu = s.frame.puu;
    scene.sampleResults.at[i].puv = s.frame.puv;
    scene.sampleResults.at[i].pvv = s.frame.pvv;
    scene.sampleResults.at[i].n = s.n;
    scene.sampleResults.at[i].st = s.st;
    scene.sampleResults.at[i].stu = s.jacobian[0];
    scene.sampleResults.at[i].stv = s.jacobian[1];
    scene.sampleResults.at[i].h = s.h;
    scene.sampleResults.at[i].gradient = s.gradient;
    scene.sampleResults.at[i].q = s.q;
    scene.sampleResults.at[i].m = s.normal;
}
