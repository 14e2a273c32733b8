// The displaced surface at one point in double precision: the oracle for the shaders.
#include <algorithm>
#include <cmath>

#include "displacement/displacement.h"
#include "shared/displacement.h"

namespace relief {
namespace {

/// The direction of m, or n where m vanishes.
dvec3 unitOr(const dvec3& m, const dvec3& n) {
    const double length = glm::length(m);
    return length > 0 ? m / length : n;
}

/// Lee, Moreton, Hoppe 2000: m = q_u x q_v with the curvature term h n_u.
dvec3 fullNormal(const LimitFrame& f, const dvec3& n, double h, const dvec2& dh) {
    const double area = glm::length(glm::cross(f.pu, f.pv));
    const dvec3 nu = formulas::normalDerivative(n, area, f.pu, f.pv, f.puu, f.puv);
    const dvec3 nv = formulas::normalDerivative(n, area, f.pu, f.pv, f.puv, f.pvv);
    return glm::cross(formulas::displacedTangent(f.pu, n, nu, h, dh.x),
                      formulas::displacedTangent(f.pv, n, nv, h, dh.y));
}

/// |p_u x p_v| and its derivatives by (u,v).
struct Area {
    double value = 0;
    dvec2 slope{0};
};

Area areaOf(const LimitFrame& f) {
    const dvec3 c = glm::cross(f.pu, f.pv);
    Area area{.value = glm::length(c)};
    const dvec3 n = c / area.value;
    area.slope = {glm::dot(n, glm::cross(f.puu, f.pv) + glm::cross(f.pu, f.puv)),
                  glm::dot(n, glm::cross(f.puv, f.pv) + glm::cross(f.pu, f.pvv))};
    return area;
}

/// What heights are multiplied with, and the derivatives of its logarithm.
struct Stretch {
    double factor = 1;
    dvec2 logSlope{0};
};

/// Where p_u and p_v are parallel the areas are compared at first order along the diagonal, and there is no slope.
Stretch stretchAtCorner(const dvec3& rest, const dvec3& now) {
    const double before = glm::length(rest), after = glm::length(now);
    if (before == 0 || after == 0) return {};
    return {std::min(std::sqrt(after / before), formulas::kMostStretch), dvec2(0)};
}

Stretch stretchSince(const LimitFrame& rest, const LimitFrame& now) {
    const Area before = areaOf(rest), after = areaOf(now);
    const double factor = std::sqrt(after.value / before.value);
    if (factor >= formulas::kMostStretch) return {formulas::kMostStretch, dvec2(0)};
    return {factor, 0.5 * (after.slope / after.value - before.slope / before.value)};
}

} // namespace

DisplacedFrame displacedFrame(const ReferenceSurface& surface, const HeightMap* map, int face, const dvec2& uv,
                              const ReferenceSurface* rest) {
    const TexFrame tex = surface.texture(face, uv);
    DisplacedFrame frame;
    frame.limit = surface.limit(face, uv);
    frame.st = tex.st;
    frame.normal = frame.firstOrder = frame.full = surface.normal(face, uv);
    if (map) frame.height = sampleHeight(*map, tex.st);
    Stretch stretch;
    if (rest != nullptr) {
        const LimitFrame before = rest->limit(face, uv);
        stretch = before.hasTangentPlane() && frame.limit.hasTangentPlane()
                      ? stretchSince(before, frame.limit)
                      : stretchAtCorner(rest->areaNormal(face, uv), surface.areaNormal(face, uv));
    }
    frame.height.h *= stretch.factor, frame.height.hs *= stretch.factor, frame.height.ht *= stretch.factor;
    frame.q = formulas::displacedPoint(frame.limit.p, frame.normal, frame.height.h);
    if (!frame.limit.hasTangentPlane()) return frame; // there is no derivative of its normal either

    const dvec3& n = frame.normal;
    const dvec2 dh =
        formulas::heightGradient({frame.height.hs, frame.height.ht}, tex.jacobian) + frame.height.h * stretch.logSlope;
    frame.firstOrder = unitOr(formulas::firstOrderNormal(n, frame.limit.pu, frame.limit.pv, dh), n);
    frame.full = unitOr(fullNormal(frame.limit, n, frame.height.h, dh), n);
    return frame;
}

} // namespace relief
