// The displaced surface at one point in double precision: the oracle for the shaders.
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

} // namespace

DisplacedFrame displacedFrame(const ReferenceSurface& surface, const HeightMap* map, int face, const dvec2& uv) {
    const TexFrame tex = surface.texture(face, uv);
    DisplacedFrame frame;
    frame.limit = surface.limit(face, uv);
    frame.st = tex.st;
    frame.normal = frame.firstOrder = frame.full = surface.normal(face, uv);
    if (map) frame.height = sampleHeight(*map, tex.st);
    frame.q = formulas::displacedPoint(frame.limit.p, frame.normal, frame.height.h);
    if (!frame.limit.hasTangentPlane()) return frame; // there is no derivative of its normal either

    const dvec3& n = frame.normal;
    const dvec2 dh = formulas::heightGradient({frame.height.hs, frame.height.ht}, tex.jacobian);
    frame.firstOrder = unitOr(formulas::firstOrderNormal(n, frame.limit.pu, frame.limit.pv, dh), n);
    frame.full = unitOr(fullNormal(frame.limit, n, frame.height.h, dh), n);
    return frame;
}

} // namespace relief
