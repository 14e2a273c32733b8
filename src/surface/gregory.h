// Internal: basis weights of Gregory patches with their true first and second derivatives.
#pragma once

#include <array>

namespace relief {

/// A function of (u,v) at one point with its derivatives to second order.
struct Jet {
    double f = 0, u = 0, v = 0, uu = 0, uv = 0, vv = 0;
};

inline Jet operator+(const Jet& a, const Jet& b) {
    return {a.f + b.f, a.u + b.u, a.v + b.v, a.uu + b.uu, a.uv + b.uv, a.vv + b.vv};
}
inline Jet operator-(const Jet& a, const Jet& b) {
    return {a.f - b.f, a.u - b.u, a.v - b.v, a.uu - b.uu, a.uv - b.uv, a.vv - b.vv};
}
inline Jet operator*(const Jet& a, const Jet& b) {
    return {a.f * b.f,
            a.u * b.f + a.f * b.u,
            a.v * b.f + a.f * b.v,
            a.uu * b.f + 2 * a.u * b.u + a.f * b.uu,
            a.uv * b.f + a.u * b.v + a.v * b.u + a.f * b.uv,
            a.vv * b.f + 2 * a.v * b.v + a.f * b.vv};
}
inline Jet operator*(double a, const Jet& b) { return {a * b.f, a * b.u, a * b.v, a * b.uu, a * b.uv, a * b.vv}; }
/// From q b = a: each derivative of the product rule solved for that of q.
inline Jet operator/(const Jet& a, const Jet& b) {
    Jet q;
    q.f = a.f / b.f;
    q.u = (a.u - q.f * b.u) / b.f;
    q.v = (a.v - q.f * b.v) / b.f;
    q.uu = (a.uu - 2 * q.u * b.u - q.f * b.uu) / b.f;
    q.uv = (a.uv - q.u * b.v - q.v * b.u - q.f * b.uv) / b.f;
    q.vv = (a.vv - 2 * q.v * b.v - q.f * b.vv) / b.f;
    return q;
}

inline constexpr int kGregoryQuadPoints = 20;
inline constexpr int kGregoryTrianglePoints = 18;
inline constexpr int kMostPatchPoints = 20;
using PatchWeights = std::array<Jet, kMostPatchPoints>;

/// Weights of the 20 points of a bicubic Gregory patch at (u,v) in [0,1]², in OpenSubdiv's order.
PatchWeights gregoryQuadWeights(double u, double v);

/// Weights of the 18 points of a quartic Gregory triangle at barycentric (1-u-v, u, v), in OpenSubdiv's order.
PatchWeights gregoryTriangleWeights(double u, double v);

} // namespace relief
