// Where a displacement along the normal folds the surface over itself, and what omitting curvature costs.
#include <algorithm>
#include <cmath>

#include "check/angles.h"
#include "check/check.h"

namespace relief {
namespace {

LimitFrame frameOf(const SampleResult& r) {
    return {.p = dvec3(r.p),
            .pu = dvec3(r.pu),
            .pv = dvec3(r.pv),
            .puu = dvec3(r.puu),
            .puv = dvec3(r.puv),
            .pvv = dvec3(r.pvv)};
}

/// Eigenvalues of I^-1 II with I = dP.dP and II = dn.dP (do Carmo, section 3.3, with the sign of dn turned).
Curvatures curvaturesOf(const LimitFrame& f, const NormalFrame& normal) {
    const double E = glm::dot(f.pu, f.pu), F = glm::dot(f.pu, f.pv), G = glm::dot(f.pv, f.pv);
    const double e = glm::dot(normal.nu, f.pu), g = glm::dot(normal.nv, f.pv);
    const double m = 0.5 * (glm::dot(normal.nu, f.pv) + glm::dot(normal.nv, f.pu));
    const double determinant = E * G - F * F;
    const double mean = 0.5 * (e * G - 2 * m * F + g * E) / determinant;
    const double gauss = (e * g - m * m) / determinant;
    const double spread = std::sqrt(std::max(mean * mean - gauss, 0.0));
    return {mean - spread, mean + spread};
}

double foldFactorOf(const LimitFrame& f, const NormalFrame& normal, double h) {
    const Curvatures k = curvaturesOf(f, normal);
    return 1 + std::min(h * k.lowest, h * k.highest);
}

/// Degrees between the full and the first-order normal of the displaced surface.
double normalAngle(const LimitFrame& f, const SampleResult& r) {
    const dvec2 slope(r.gradient), stu(r.stu), stv(r.stv);
    const dvec2 dh(slope.x * stu.x + slope.y * stu.y, slope.x * stv.x + slope.y * stv.y);
    const DisplacedNormals normals = computeDisplacedNormals(f, r.h, dh);
    return degreesBetween(normals.firstOrder, normals.full);
}

/// Sums angle times area into meanNormalAngle. `error`: of a vector map, or null.
void add(CurvatureReport& report, const SampleQuery& query, const SampleResult& r, double weight,
         const SampleError* error) {
    const LimitFrame frame = frameOf(r);
    const NormalFrame normal = computeNormalFrame(frame);
    const double factor = error != nullptr ? error->foldFactor.value_or(NAN) : foldFactorOf(frame, normal, r.h);
    const double angle = error != nullptr ? error->firstOrderAngle : normalAngle(frame, r);
    if (!frame.hasTangentPlane() || !std::isfinite(factor + angle + normal.area)) {
        ++report.countWithoutCurvature;
        return;
    }
    const SurfaceLocation location{query.face, query.uv};
    ++report.count;
    report.area += weight * normal.area;
    if (factor <= 0) report.foldedArea += weight * normal.area;
    if (factor < report.lowestFactor || report.count == 1) report.lowestFactor = factor, report.lowestAt = location;
    if (angle > report.maxNormalAngle) report.maxNormalAngle = angle, report.maxNormalAngleAt = location;
    report.meanNormalAngle += angle * weight * normal.area;
}

} // namespace

Curvatures principalCurvatures(const LimitFrame& frame) { return curvaturesOf(frame, computeNormalFrame(frame)); }

double foldFactor(const SampleResult& result) {
    const LimitFrame frame = frameOf(result);
    return foldFactorOf(frame, computeNormalFrame(frame), result.h);
}

namespace {

CurvatureReport report(const SurfaceSamples& samples, std::span<const SampleResult> results,
                       const SampleError* firstError) {
    RELIEF_CHECK(results.size() == samples.queries.size());
    RELIEF_CHECK(samples.hasCurvature.size() == samples.queries.size());
    CurvatureReport report;
    for (std::size_t i = 0; i < samples.queries.size(); ++i)
        if (samples.hasCurvature[i])
            add(report, samples.queries[i], results[i], samples.weights[i],
                firstError != nullptr ? firstError + i : nullptr);
        else
            ++report.countWithoutCurvature;
    report.meanNormalAngle = report.area > 0 ? report.meanNormalAngle / report.area : 0;
    return report;
}

} // namespace

CurvatureReport reportCurvature(const SurfaceSamples& samples, std::span<const SampleResult> results) {
    return report(samples, results, nullptr);
}

CurvatureReport reportFolds(const SurfaceSamples& samples, std::span<const SampleResult> results,
                            std::span<const SampleError> errors) {
    RELIEF_CHECK(errors.size() == results.size());
    return report(samples, results, errors.data());
}

} // namespace relief
