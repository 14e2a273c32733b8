// The displaced surface at one point in double precision: the reference that the shaders are compared with.
//
// It shares no formula with the shaders (shaders/shared/displacement.h), so that an error in theirs shows. Points are
// written down as q = p + sigma h n alone; every derivative comes from forward-mode automatic differentiation (Griewank
// and Walther 2008, "Evaluating Derivatives", section 3.1).
#include <algorithm>
#include <cmath>

#include "displacement/displacement.h"
#include "displacement/reference_parts.h"
#include "displacement/vector_map.h"

namespace relief {
namespace {

/// A number or vector that varies over a face, with its derivatives by u and v.
template <typename T>
struct Dual {
    T value{0}, u{0}, v{0};
};
using DualNumber = Dual<double>;
using DualVector = Dual<dvec3>;

/// A bilinear product: (a b)_u = a_u b + a b_u.
template <typename Multiply, typename A, typename B>
auto multiply(const Multiply& product, const Dual<A>& a, const Dual<B>& b) {
    using T = decltype(product(a.value, b.value));
    return Dual<T>{product(a.value, b.value), product(a.u, b.value) + product(a.value, b.u),
                   product(a.v, b.value) + product(a.value, b.v)};
}

DualNumber operator*(const DualNumber& a, const DualNumber& b) { return multiply(std::multiplies<>(), a, b); }
DualVector operator*(const DualNumber& a, const DualVector& b) { return multiply(std::multiplies<>(), a, b); }
DualVector operator+(const DualVector& a, const DualVector& b) { return {a.value + b.value, a.u + b.u, a.v + b.v}; }

DualVector cross(const DualVector& a, const DualVector& b) {
    return multiply([](const dvec3& x, const dvec3& y) { return glm::cross(x, y); }, a, b);
}

DualNumber dot(const DualVector& a, const DualVector& b) {
    return multiply([](const dvec3& x, const dvec3& y) { return glm::dot(x, y); }, a, b);
}

DualNumber reciprocal(const DualNumber& a) {
    const double slope = -1 / (a.value * a.value);
    return {1 / a.value, slope * a.u, slope * a.v};
}

DualNumber squareRoot(const DualNumber& a) {
    const double root = std::sqrt(a.value);
    return {root, a.u / (2 * root), a.v / (2 * root)};
}

/// p_u x p_v; its length is the area per unit of (u,v).
DualVector areaVector(const LimitFrame& frame) {
    return cross(DualVector{frame.pu, frame.puu, frame.puv}, DualVector{frame.pv, frame.puv, frame.pvv});
}

DualNumber areaOf(const LimitFrame& frame) {
    const DualVector c = areaVector(frame);
    return squareRoot(dot(c, c));
}

DualVector normalOf(const LimitFrame& frame) { return reciprocal(areaOf(frame)) * areaVector(frame); }

/// m = q_u x q_v for q = p + h n. With a constant n this is Blinn's normal (1978), with the n that varies that of Lee,
/// Moreton and Hoppe (2000).
dvec3 normalOfDisplaced(const LimitFrame& frame, const DualNumber& h, const DualVector& n) {
    const DualVector q = DualVector{frame.p, frame.pu, frame.pv} + h * n;
    return glm::cross(q.u, q.v);
}

/// The direction of m, or n where m vanishes.
dvec3 unitOr(const dvec3& m, const dvec3& n) {
    const double length = glm::length(m);
    return length > 0 ? m / length : n;
}

/// Heights that stretch with the surface are multiplied with sigma = sqrt(A / A0), A the area now and A0 at rest. The
/// factor ends here because there is no ratio where the rest pose has no area. The shaders' limit, stated again.
constexpr double kLargestStretch = 4;

/// Where p_u and p_v are parallel the areas are compared at first order along the diagonal, and there is no slope.
DualNumber stretchAtCorner(const dvec3& rest, const dvec3& now) {
    const double before = glm::length(rest), after = glm::length(now);
    if (before == 0 || after == 0) return {1};
    return {std::min(std::sqrt(after / before), kLargestStretch)};
}

DualNumber stretchSince(const LimitFrame& rest, const LimitFrame& now) {
    const DualNumber stretch = squareRoot(areaOf(now) * reciprocal(areaOf(rest)));
    return stretch.value < kLargestStretch ? stretch : DualNumber{kLargestStretch};
}

} // namespace

DisplacedFrame frameWithoutHeight(const ReferenceSurface& surface, int face, const dvec2& uv) {
    DisplacedFrame frame;
    frame.limit = surface.limit(face, uv);
    frame.tex = surface.texture(face, uv);
    frame.normal = frame.firstOrder = frame.full = surface.normal(face, uv);
    return frame;
}

namespace {

/// Fills in the point and the normals. Without a tangent plane the normal has no derivatives: all three normals stay
/// that of the limit surface.
void displace(DisplacedFrame& frame, const DualNumber& height) {
    frame.q = frame.limit.p + height.value * frame.normal;
    if (!frame.limit.hasTangentPlane()) return;
    const DisplacedNormals normals = computeDisplacedNormals(frame.limit, height.value, {height.u, height.v});
    frame.firstOrder = unitOr(normals.firstOrder, frame.normal);
    frame.full = unitOr(normals.full, frame.normal);
}

/// How much the surface has grown since the rest pose.
DualNumber stretchAt(const ReferenceSurface& rest, const ReferenceSurface& now, int face, const dvec2& uv) {
    const LimitFrame before = rest.limit(face, uv), after = now.limit(face, uv);
    return before.hasTangentPlane() && after.hasTangentPlane()
               ? stretchSince(before, after)
               : stretchAtCorner(rest.areaNormal(face, uv), now.areaNormal(face, uv));
}

/// The height over the face, by the chain rule through the texture coordinates.
DualNumber heightOver(const TexFrame& tex, const HeightSample& sample) {
    const dvec2 su = tex.jacobian[0], sv = tex.jacobian[1]; // (s_u, t_u) and (s_v, t_v)
    return {sample.h, sample.hs * su.x + sample.ht * su.y, sample.hs * sv.x + sample.ht * sv.y};
}

} // namespace

double computeStretch(const ReferenceSurface& rest, const ReferenceSurface& now, int face, const dvec2& uv) {
    return stretchAt(rest, now, face, uv).value;
}

NormalFrame computeNormalFrame(const LimitFrame& frame) {
    const DualVector n = normalOf(frame);
    return {.n = n.value, .nu = n.u, .nv = n.v, .area = areaOf(frame).value};
}

DisplacedNormals computeDisplacedNormals(const LimitFrame& frame, double h, const dvec2& dh) {
    const DualNumber height{h, dh.x, dh.y};
    const DualVector n = normalOf(frame), constant{n.value};
    return {.firstOrder = normalOfDisplaced(frame, height, constant), .full = normalOfDisplaced(frame, height, n)};
}

DisplacedFrame displacedFrame(const ReferenceSurface& surface, const HeightMap* map, int face, const dvec2& uv,
                              const ReferenceSurface* rest) {
    if (map != nullptr && map->vectors) {
        const MapPlace place{.face = face, .uv = uv, .st = surface.texture(face, uv).st};
        const VectorSample sample = sampleVectors(*map->vectors, place);
        return displacedByVectors({surface, map->vectors->space, rest}, sample, face, uv);
    }
    // The limit surface, and the height by the map alone.
    DisplacedFrame frame = frameWithoutHeight(surface, face, uv);
    if (map != nullptr) frame.height = sampleHeight(*map, {.face = face, .uv = uv, .st = frame.tex.st});
    const bool isPerFace = map != nullptr && map->addressing == Addressing::faces;

    DualNumber stretch{1};
    if (rest != nullptr) stretch = stretchAt(*rest, surface, face, uv);
    const DualNumber height = stretch * heightOver(isPerFace ? TexFrame{} : frame.tex, frame.height);
    frame.height.h *= stretch.value, frame.height.hs *= stretch.value, frame.height.ht *= stretch.value;
    displace(frame, height);
    return frame;
}

DisplacedFrame displacedFrame(const ReferenceSurface& surface, const FaceHeight& height, int face, const dvec2& uv) {
    DisplacedFrame frame = frameWithoutHeight(surface, face, uv);
    frame.height = {.h = height.h, .hs = height.hu, .ht = height.hv};
    displace(frame, {height.h, height.hu, height.hv});
    return frame;
}

} // namespace relief
