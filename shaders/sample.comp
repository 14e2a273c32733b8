#version 460
#extension GL_GOOGLE_include_directive : require
#define RELIEF_GENERIC_BASIS
#include "displaced.glsl"

layout(local_size_x = 64) in;

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= passNumber) return;
    SampleQuery query = scene.sampleQueries.at[i];
    DisplacedSample s = displaced(query.face, query.uv, insidePlace(query.face, query.uv));
    SampleResult r;
    r.p = s.p;
    r.pu = s.frame.pu;
    r.pv = s.frame.pv;
    r.puu = s.frame.puu;
    r.puv = s.frame.puv;
    r.pvv = s.frame.pvv;
    r.n = s.n;
    r.st = s.st;
    r.stu = s.jacobian[0];
    r.stv = s.jacobian[1];
    r.h = s.h;
    r.gradient = s.gradient;
    r.q = s.q;
    r.m = s.normal;
    scene.sampleResults.at[i] = r;
}
