// What the dicing shaders share.
#ifndef RELIEF_DICE_GLSL
#define RELIEF_DICE_GLSL

#include "inputs.glsl"
#include "shared/dice.h"

layout(push_constant, scalar) uniform PushBlock { DicePush push; };

RELIEF_TABLE(kBindDiceTable, uvec4, tableTexel)
RELIEF_TABLE(kBindDiceTiles, uvec4, tileTexel)
RELIEF_TABLE(kBindDiceFirsts, uint, firstVertexOf) // of a run

VertexRun fetchRun(uint i) {
    uvec4 a = tableTexel(kRunTexels * i), b = tableTexel(kRunTexels * i + 1u);
    return VertexRun(unpackIncidence(a), b.x, b.y);
}

FaceRuns fetchFaceRuns(uint face) {
    uint first = inputs.model.firstFaceRuns + kFaceRunsTexels * face;
    uvec4 a = tableTexel(first), b = tableTexel(first + 1u), c = tableTexel(first + 2u), d = tableTexel(first + 3u);
    return FaceRuns(uint[4](a.x, a.y, a.z, a.w), uint[4](b.x, b.y, b.z, b.w),
                    uint[8](c.x, c.y, c.z, c.w, d.x, d.y, d.z, d.w));
}

InsideTile fetchInsideTile(uint i) {
    uvec4 a = tileTexel(kInsideTileTexels * i), b = tileTexel(kInsideTileTexels * i + 1u);
    return InsideTile(a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w);
}

// x / d and x % d, for x < 2^23, by a float and a correction: CPU drivers divide integers lane by lane.
uvec2 divided(uint x, uint d) {
    uint quotient = uint(float(x) / float(d));
    if (quotient * d > x) --quotient;
    uint rest = x - quotient * d;
    return rest < d ? uvec2(quotient, rest) : uvec2(quotient + 1u, rest - d);
}

// The common case, known when the shader is compiled, for CPU drivers run both sides of every branch: insides in bicubic
// patches, of the surface and of its texture coordinates; triangles between inner samples.
layout(constant_id = kIdIsCommon) const bool kIsCommon = false;

uvec2 halvesOf(uint packed) { return uvec2(packed & 0xffffu, packed >> 16); }
#endif
