#version 460
#extension GL_GOOGLE_include_directive : require
#ifndef RELIEF_TRIANGLES
#define RELIEF_GENERIC_BASIS
#endif
#include "displaced.glsl"

layout(local_size_x = 64) in;

layout(push_constant, scalar) uniform PushBlock { SamplePush push; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= push.count) return;
    uint face = inputs.targets.sampleQueries.at[i].face;
    vec2 uv = inputs.targets.sampleQueries.at[i].uv;
    DisplacedSample s = displaced(face, uv, insideLocation(face, uv));
    inputs.targets.sampleResults.at[i].p = s.p;
    inputs.targets.sampleResults.at[i].pu = s.frame.pu;
    inputs.targets.sampleResults.at[i].pv = s.frame.pv;
    inputs.targets.sampleResults.at[i].puu = s.frame.puu;
    inputs.targets.sampleResults.at[i].puv = s.frame.puv;
    inputs.targets.sampleResults.at[i].pvv = s.frame.pvv;
    inputs.targets.sampleResults.at[i].n = s.n;
    inputs.targets.sampleResults.at[i].st = s.st;
    inputs.targets.sampleResults.at[i].stu = s.jacobian[0];
    inputs.targets.sampleResults.at[i].stv = s.jacobian[1];
    inputs.targets.sampleResults.at[i].h = s.h;
    inputs.targets.sampleResults.at[i].gradient = s.gradient;
    inputs.targets.sampleResults.at[i].q = s.q;
    inputs.targets.sampleResults.at[i].m = s.normal;
    bool isVector = kVectorSpace != kVectorNone;
    inputs.targets.sampleResults.at[i].c = isVector ? s.vector.c : vec3(0);
    inputs.targets.sampleResults.at[i].cs = isVector ? s.vector.dc[0] : vec3(0);
    inputs.targets.sampleResults.at[i].ct = isVector ? s.vector.dc[1] : vec3(0);
}
