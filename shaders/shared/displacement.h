// The mathematics of a displaced surface, once for both sides of the bus. n is the unit normal of the limit surface,
// h the height in cage units; subscripts are derivatives. Everything is written in face coordinates (u,v): m only needs
// its direction, and q_u x q_v = det(J) q_s x q_t with J = d(s,t)/d(u,v), so no inverse of J is taken, mirrored islands
// keep their side and singular texture coordinates do no harm.
#ifndef RELIEF_SHARED_DISPLACEMENT_H
#define RELIEF_SHARED_DISPLACEMENT_H

#include "shared/types.h"

#ifdef __cplusplus
#include <cmath>
#endif

#ifdef __cplusplus
namespace relief::formulas {
using glm::cross;
using glm::dot;
using std::sqrt;
#endif

// (h_u, h_v) = (h_s, h_t) J by the chain rule; J has columns d(s,t)/du and d(s,t)/dv.
RELIEF_SHARED_FUNCTION real2 heightGradient(real2 gradientST, real2x2 J) {
    return real2(dot(gradientST, J[0]), dot(gradientST, J[1]));
}

// q = p + h n  (Lee, Moreton, Hoppe 2000, section 3).
RELIEF_SHARED_FUNCTION real3 displacedPoint(real3 p, real3 n, real h) { return p + h * n; }

// n_u = (I - n n^T)(p_uu x p_v + p_u x p_uv) / |p_u x p_v|: the derivative of (p_u x p_v)/|p_u x p_v|.
// With (p_uv, p_vv) in place of (p_uu, p_uv) this formula gives n_v.
RELIEF_SHARED_FUNCTION real3 normalDerivative(real3 n, real area, real3 pu, real3 pv, real3 dpu, real3 dpv) {
    real3 c = cross(dpu, pv) + cross(pu, dpv);
    return (c - n * dot(n, c)) / area;
}

// Derivative of the area |p_u x p_v| by u: n . (p_uu x p_v + p_u x p_uv); by v with (p_uv, p_vv).
RELIEF_SHARED_FUNCTION real areaDerivative(real3 n, real3 pu, real3 pv, real3 dpu, real3 dpv) {
    return dot(n, cross(dpu, pv) + cross(pu, dpv));
}

// m = p_u x p_v + h_u (n x p_v) - h_v (n x p_u): Blinn (1978); Hart, "Perturbation of normals", eq. 16.3.
RELIEF_SHARED_FUNCTION real3 firstOrderNormal(real3 n, real3 pu, real3 pv, real2 dh) {
    return cross(pu, pv) + dh.x * cross(n, pv) - dh.y * cross(n, pu);
}

// firstOrderNormal() by (s,t), divided by |p_s x p_t|: n - h_s grad s - h_t grad t, for p_t x n = |p_s x p_t| grad s
// and n x p_s = |p_s x p_t| grad t. Mirrored texture coordinates need no other sign.
RELIEF_SHARED_FUNCTION real3 bumpedNormal(real3 n, real3 gradientS, real3 gradientT, real2 slopes) {
    return n - slopes.x * gradientS - slopes.y * gradientT;
}

// q_u = p_u + h_u n + h n_u  (Lee, Moreton, Hoppe 2000, section 3); m = q_u x q_v.
RELIEF_SHARED_FUNCTION real3 displacedTangent(real3 pu, real3 n, real3 nu, real h, real hu) {
#if defined(RELIEF_MUTANT_FORMULA) && !defined(__cplusplus) // a test of the certificate: h n_u is missing
    return pu + hu * n;
#else
    return pu + hu * n + h * nu;
#endif
}

// Heights that stretch with the surface are sigma h with sigma = sqrt(A / A0), A = |p_u x p_v| here and A0 at rest;
// then (sigma h)_u = sigma h_u + sigma h (log sigma)_u with (log sigma)_u = (A_u / A - A0_u / A0) / 2. No more than
// kMostStretch: where the rest pose has no area there is no ratio.
const real kMostStretch = 4.0;

RELIEF_SHARED_FUNCTION real stretchOf(real area, real restArea) {
    return area < kMostStretch * kMostStretch * restArea ? sqrt(area / restArea) : kMostStretch;
}

#ifdef __cplusplus
} // namespace relief::formulas
#endif
#endif
