// The surface displaced by vectors, at one point in double precision. Points are written down as q = p + sigma E c
// alone, with E = (T, B, N); tangents are differences of points.
#include <algorithm>
#include <cmath>

#include "displacement/reference_parts.h"
#include "displacement/vector_map.h"

namespace relief {
namespace {

using glm::dmat3;

/// T, B and N: T is the direction of p_s, B lies on the side of p_t. [p_s p_t] = [p_u p_v] J^-1; without an inverse u
/// and v stand for s and t.
dmat3 tangentBasis(const LimitFrame& f, const dmat2& J, const dvec3& n) {
    const double determinant = glm::determinant(J), size = glm::length(J[0]) * glm::length(J[1]);
    dvec3 s = f.pu, t = f.pv;
    if (std::abs(determinant) > 1e-6 * size)
        s = (J[1].y * f.pu - J[0].y * f.pv) / determinant, t = (J[0].x * f.pv - J[1].x * f.pu) / determinant;
    const dvec3 T = glm::normalize(s - n * glm::dot(n, s));
    const dvec3 B = glm::cross(n, T);
    return {T, glm::dot(B, t) < 0 ? -B : B, n};
}

/// Where the surface's basis is taken: at each point, or at one for all of them.
struct Displacer {
    const VectorReference& reference;
    const VectorSample& sample;
    int face;
    dvec2 st; ///< where the sample is

    [[nodiscard]] dmat3 basisAt(const dvec2& uv) const {
        if (reference.space == VectorSpace::object) return dmat3(1);
        const ReferenceSurface& surface = reference.surface;
        return tangentBasis(surface.limit(face, uv), surface.texture(face, uv).jacobian, surface.normal(face, uv));
    }
    [[nodiscard]] dvec3 componentsAt(const dvec2& uv) const {
        const dvec2 d = reference.surface.texture(face, uv).st - st;
        const double stretch =
            reference.rest != nullptr ? computeStretch(*reference.rest, reference.surface, face, uv) : 1;
        return stretch * (sample.c + d.x * sample.cs + d.y * sample.ct);
    }
    [[nodiscard]] dvec3 pointAt(const dvec2& uv) const {
        return reference.surface.limit(face, uv).p + basisAt(uv) * componentsAt(uv);
    }
    [[nodiscard]] dvec3 pointAt(const dvec2& uv, const dmat3& basis) const {
        return reference.surface.limit(face, uv).p + basis * componentsAt(uv);
    }
};

constexpr double kStep = 1e-5; ///< of a face: differences are exact to 1e-10 of what they differ by

/// The point moved so far into the face that differences stay within it.
dvec2 insideOf(const ReferenceSurface& surface, const dvec2& uv) {
    const dvec2 center(surface.sideCount() == 3 ? 1.0 / 3 : 0.5);
    const double least = std::min({uv.x, uv.y, 1 - uv.x, 1 - uv.y, surface.sideCount() == 3 ? 1 - uv.x - uv.y : 1.0});
    return least > kStep ? uv : glm::mix(uv, center, 8 * kStep);
}

/// False at extraordinary vertices, where tangents are those of no derivative by (u,v).
bool hasDerivatives(const ReferenceSurface& surface, int face, const dvec2& at, const LimitFrame& limit) {
    const auto isDerivative = [&](const dvec2& step, const dvec3& tangent) {
        const dvec3 difference = (surface.limit(face, at + step).p - surface.limit(face, at - step).p) / (2 * kStep);
        return glm::length(difference - tangent) <= 0.01 * glm::length(tangent);
    };
    return isDerivative({kStep, 0}, limit.pu) && isDerivative({0, kStep}, limit.pv);
}

dvec3 directionOr(const dvec3& m, const dvec3& n) {
    const double length = glm::length(m);
    return length > 0 ? m / length : n;
}

} // namespace

DisplacedFrame displacedByVectors(const VectorReference& reference, const VectorSample& sample, int face,
                                  const dvec2& uv) {
    DisplacedFrame frame = frameWithoutHeight(reference.surface, face, uv);
    const Displacer displacer{reference, sample, face, frame.tex.st};
    frame.q = displacer.pointAt(uv);
    frame.height.h = glm::dot(frame.q - frame.limit.p, frame.normal);
    if (!frame.limit.hasTangentPlane()) return frame;

    // Differences where the basis turns, and where it is that of the point: the first-order normal.
    const dvec2 at = insideOf(reference.surface, uv), du(kStep, 0), dv(0, kStep);
    if (!hasDerivatives(reference.surface, face, at, frame.limit)) return frame;
    const dmat3 basis = displacer.basisAt(at);
    const auto difference = [&](const dvec2& step) {
        return (displacer.pointAt(at + step) - displacer.pointAt(at - step)) / (2 * kStep);
    };
    const auto differenceInBasis = [&](const dvec2& step) {
        return (displacer.pointAt(at + step, basis) - displacer.pointAt(at - step, basis)) / (2 * kStep);
    };
    frame.qu = difference(du), frame.qv = difference(dv);
    frame.full = directionOr(glm::cross(frame.qu, frame.qv), frame.normal);
    frame.firstOrder = directionOr(glm::cross(differenceInBasis(du), differenceInBasis(dv)), frame.normal);
    return frame;
}

double computeFoldFactor(const DisplacedFrame& frame) {
    // [q_u q_v] on the tangent plane = [p_u p_v] A: A = I^-1 M with I = dp.dp and M = dp.dq.
    const LimitFrame& f = frame.limit;
    const double E = glm::dot(f.pu, f.pu), F = glm::dot(f.pu, f.pv), G = glm::dot(f.pv, f.pv);
    const dmat2 first(E, F, F, G);
    const dmat2 moved(glm::dot(f.pu, frame.qu), glm::dot(f.pv, frame.qu), glm::dot(f.pu, frame.qv),
                      glm::dot(f.pv, frame.qv));
    const dmat2 A = glm::inverse(first) * moved;
    const double mean = 0.5 * (A[0].x + A[1].y), determinant = glm::determinant(A);
    return mean - std::sqrt(std::max(mean * mean - determinant, 0.0));
}

} // namespace relief
