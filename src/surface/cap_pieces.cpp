// Where a point of an end cap lies, and the splines of the regular pieces there.
#include <algorithm>
#include <array>
#include <cmath>

#include "surface/caps.h"

namespace relief {

CapPlace placeInCap(int sideCount, double a, double b, int levelCount) {
    const double distance = sideCount == 4 ? std::max(a, b) : a + b;
    CapPlace place;
    if (!(distance > 0)) return place;
    const int level = std::max(-std::ilogb(distance), 1);
    place.level = std::min(level, levelCount);
    place.size = std::ldexp(1.0, -level);
    const double x = std::ldexp(a, level), y = std::ldexp(b, level);
    if (sideCount == 4) {
        place.piece = x < 1 ? 2 : y < 1 ? 0 : 1;
        place.u = x - (place.piece == 2 ? 0 : 1), place.v = y - (place.piece == 0 ? 0 : 1);
    } else {
        place.piece = x >= 1 ? 0 : y >= 1 ? 2 : 1;
        place.u = place.piece == 0 ? x - 1 : x, place.v = place.piece == 2 ? y - 1 : y;
        if (place.piece == 1) place.u = 1 - x, place.v = 1 - y, place.slope = -1;
    }
    return place;
}

namespace {

std::array<Jet, 4> cubicSpline(const Jet& t) {
    const Jet s = Jet{1} - t;
    const Jet t2 = t * t, t3 = t2 * t, s2 = s * s, s3 = s2 * s;
    return {(1.0 / 6) * s3, (1.0 / 6) * (3 * t3 - 6 * t2 + Jet{4}), (1.0 / 6) * (3 * s3 - 6 * s2 + Jet{4}),
            (1.0 / 6) * t3};
}

/// Stam, Evaluation of Loop Subdivision Surfaces (1998), appendix A: the quartic box spline by barycentric coordinates
/// u, v, w of the triangle; here for the corner (0,0) where u = 1 and the numbers of kBoxPoints.
std::vector<Jet> boxSpline(const Jet& v, const Jet& w) {
    const Jet u = Jet{1} - v - w;
    const Jet u3 = u * u * u, v3 = v * v * v, w3 = w * w * w;
    const Jet u4 = u3 * u, v4 = v3 * v, w4 = w3 * w;
    // The central weight of a corner where x = 1, with y and z the other two.
    const auto own = [](const Jet& x, const Jet& y, const Jet& z) {
        const Jet x2 = x * x, y2 = y * y, z2 = z * z;
        return 6 * x2 * x2 + 24 * x2 * x * z + 24 * x2 * z2 + 8 * x * z2 * z + z2 * z2 + 24 * x2 * x * y +
               60 * x2 * y * z + 36 * x * y * z2 + 6 * y * z2 * z + 24 * x2 * y2 + 36 * x * y2 * z + 12 * y2 * z2 +
               8 * x * y2 * y + 6 * y2 * y * z + y2 * y2;
    };
    // A point beside two corners, x near and y: it lies across the edge from x to y.
    const auto across = [](const Jet& x, const Jet& y, const Jet& z) {
        const Jet x2 = x * x, y2 = y * y;
        return x2 * x2 + 6 * x2 * x * y + 12 * x2 * y2 + 6 * x * y2 * y + y2 * y2 + 2 * x2 * x * z + 6 * x2 * y * z +
               6 * x * y2 * z + 2 * y2 * y * z;
    };
    std::vector<Jet> b(12);
    b[0] = u4 + 2 * u3 * v;
    b[1] = across(u, v, w);
    b[2] = v4 + 2 * u * v3;
    b[3] = u4 + 2 * u3 * w;
    b[4] = own(u, v, w);
    b[5] = own(v, w, u);
    b[6] = v4 + 2 * v3 * w;
    b[7] = across(u, w, v);
    b[8] = own(w, u, v);
    b[9] = across(v, w, u);
    b[10] = w4 + 2 * u * w3;
    b[11] = w4 + 2 * v * w3;
    for (Jet& jet : b) jet = (1.0 / 12) * jet;
    return b;
}

} // namespace

std::vector<Jet> pieceBasis(int sideCount, double u, double v) {
    const Jet s{u, 1, 0}, t{v, 0, 1};
    if (sideCount == 3) return boxSpline(s, t);
    std::vector<Jet> basis;
    const auto along = cubicSpline(s), across = cubicSpline(t);
    for (const Jet& y : across)
        for (const Jet& x : along) basis.push_back(x * y);
    return basis;
}

} // namespace relief
