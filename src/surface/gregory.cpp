// Loop, Schaefer, Ni, Castaño: Approximating Subdivision Surfaces with Gregory Patches for Hardware Tessellation
// (2009). OpenSubdiv's own derivatives of these patches hold the rational multipliers fixed; here they are
// differentiated too.
//
//   point order, quads                            triangles
//   15----17----11----10                          10
//   |      |     |     |                           | \.
//   16 -- 18,19 14,13 --12                         11  12
//   |      |     |     |                           |      \.
//   2 --- 3,4   9,8 ----6                          17 13,14 16
//   |      |     |     |                           |          \.
//   0 ---- 1 --- 7 --- 5                           2  3,4  8,9  6
//                                                  |              \.
//                                                  0 -- 1 - 15 - 7 - 5
#include "surface/gregory.h"

namespace relief {
namespace {

/// bezier * x / (x + y): the share of one of two points that stand for an inner Bézier point near the corner x = y = 0,
/// where bezier is scale * x y to second order.
Jet innerWeight(const Jet& bezier, double scale, const Jet& x, const Jet& y) {
    const Jet sum = x + y;
    if (sum.f > 0) return bezier * x / sum;
    // In the corner the second derivatives of scale x^2 y / (x + y) depend on the direction of approach: along x = y.
    const double xx = scale / 4, xy = scale / 2, yy = -scale / 4;
    Jet weight;
    weight.uu = xx * x.u * x.u + 2 * xy * x.u * y.u + yy * y.u * y.u;
    weight.uv = xx * x.u * x.v + xy * (x.u * y.v + x.v * y.u) + yy * y.u * y.v;
    weight.vv = xx * x.v * x.v + 2 * xy * x.v * y.v + yy * y.v * y.v;
    return weight;
}

std::array<Jet, 4> cubicBezier(const Jet& t) {
    const Jet s = Jet{1} - t;
    return {s * s * s, 3 * t * s * s, 3 * t * t * s, t * t * t};
}

} // namespace

PatchWeights gregoryQuadWeights(double u, double v) {
    const Jet s{u, 1, 0}, t{v, 0, 1};
    const Jet s1 = Jet{1} - s, t1 = Jet{1} - t;
    const auto bs = cubicBezier(s), bt = cubicBezier(t);

    PatchWeights weights;
    constexpr int kOuterPoint[] = {0, 1, 7, 5, 2, 6, 16, 12, 15, 17, 11, 10};
    constexpr int kOuterColumn[] = {0, 1, 2, 3, 0, 3, 0, 3, 0, 1, 2, 3};
    constexpr int kOuterRow[] = {0, 0, 0, 0, 1, 1, 2, 2, 3, 3, 3, 3};
    for (int i = 0; i < 12; ++i) weights[kOuterPoint[i]] = bs[kOuterColumn[i]] * bt[kOuterRow[i]];

    const double scale = 9;
    weights[3] = innerWeight(bs[1] * bt[1], scale, s, t);
    weights[4] = innerWeight(bs[1] * bt[1], scale, t, s);
    weights[8] = innerWeight(bs[2] * bt[1], scale, t, s1);
    weights[9] = innerWeight(bs[2] * bt[1], scale, s1, t);
    weights[13] = innerWeight(bs[2] * bt[2], scale, s1, t1);
    weights[14] = innerWeight(bs[2] * bt[2], scale, t1, s1);
    weights[18] = innerWeight(bs[1] * bt[2], scale, t1, s);
    weights[19] = innerWeight(bs[1] * bt[2], scale, s, t1);
    return weights;
}

PatchWeights gregoryTriangleWeights(double uValue, double vValue) {
    const Jet u{uValue, 1, 0}, v{vValue, 0, 1};
    const Jet w = Jet{1} - u - v;
    const Jet uu = u * u, vv = v * v, ww = w * w;

    // Corners and the points along the border: quartic Bernstein polynomials.
    PatchWeights weights;
    weights[0] = ww * ww;
    weights[1] = 4 * u * w * ww;
    weights[15] = 6 * uu * ww;
    weights[7] = 4 * u * w * uu;
    weights[5] = uu * uu;
    weights[6] = 4 * u * v * uu;
    weights[16] = 6 * uu * vv;
    weights[12] = 4 * u * v * vv;
    weights[10] = vv * vv;
    weights[11] = 4 * v * w * vv;
    weights[17] = 6 * vv * ww;
    weights[2] = 4 * v * w * ww;

    // Each inner point of the Bezier triangle is a blend of two: a corner's pair shares its polynomial.
    const double scale = 12;
    weights[3] = innerWeight(scale * ww * u * v, scale, u, v);
    weights[4] = innerWeight(scale * ww * u * v, scale, v, u);
    weights[8] = innerWeight(scale * uu * v * w, scale, v, w);
    weights[9] = innerWeight(scale * uu * v * w, scale, w, v);
    weights[13] = innerWeight(scale * vv * u * w, scale, w, u);
    weights[14] = innerWeight(scale * vv * u * w, scale, u, w);
    return weights;
}

} // namespace relief
