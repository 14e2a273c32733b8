// Queries of single points: relief sample, the certificates, and the tests of the shaders against the reference.
#ifndef RELIEF_SHARED_SAMPLE_H
#define RELIEF_SHARED_SAMPLE_H

#include "shared/types.h"

#ifdef __cplusplus
namespace relief {
#endif

struct SampleQuery {
    uint face; // ptex face
    vec2 uv;
};

// All of it evaluated at the face itself, in the shaders' own arithmetic.
struct SampleResult {
    vec3 p, pu, pv, puu, puv, pvv; // limit frame by face coordinates
    vec3 n;                        // unit limit normal
    vec2 st;                       // texture coordinates
    vec2 stu, stv;                 // their derivatives by u and v; with a height function those of (u,v)
    float h;
    vec2 gradient; // (h_s, h_t); of a height function (h_u, h_v)
    vec3 q;        // p + h n
    vec3 m;        // unit normal of the displaced surface, as --normal asks
    // Only of a vector map: its components, cage units, and their derivatives by s and t (without texture coordinates
    // by u and v).
    vec3 c, cs, ct;
};

#ifdef __cplusplus
static_assert(sizeof(SampleQuery) == 12 && sizeof(SampleResult) == 45 * 4);
} // namespace relief
#endif
#endif
