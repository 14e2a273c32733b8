// The device's frames against the double-precision reference.
#include <cmath>
#include <limits>

#include "check/check.h"

namespace relief {
namespace {

/// Sums squares into rms until finish().
void add(ErrorSummary& summary, double error, const SurfacePlace& place) {
    if (!std::isfinite(error)) error = std::numeric_limits<double>::infinity();
    summary.rms += error * error;
    if (error <= summary.max) return;
    summary.max = error;
    summary.worst = place;
}

void finish(RegionErrors& errors) {
    const auto root = [](ErrorSummary& summary, std::uint64_t count) {
        summary.rms = count > 0 ? std::sqrt(summary.rms / double(count)) : 0;
    };
    root(errors.point, errors.count);
    for (ErrorSummary* summary : {&errors.tangent, &errors.limitNormal, &errors.normal})
        root(*summary, errors.count - errors.countWithoutNormal);
}

double degreesBetween(const dvec3& a, const dvec3& b) {
    return glm::degrees(std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)));
}

const dvec3& normalOf(const DisplacedFrame& frame, NormalKind kind) {
    return kind == NormalKind::limit ? frame.normal : kind == NormalKind::firstOrder ? frame.firstOrder : frame.full;
}

double farther(double a, double b) { return a >= b || std::isnan(a) ? a : b; }

void compare(const FrameComparison& with, const SampleQuery& query, const SampleResult& result, RegionErrors& errors) {
    const SurfacePlace place{query.face, query.uv};
    const DisplacedFrame frame = displacedFrame(*with.reference, with.height, int(query.face), dvec2(query.uv));
    const auto distance = [&](const dvec3& a, const vec3& b) { return glm::length(a - dvec3(b)) / with.diagonal; };
    ++errors.count;
    add(errors.point, distance(frame.limit.p, result.p), place);
    if (!frame.limit.hasTangentPlane()) { // the device has mended its tangents there
        ++errors.countWithoutNormal;
        return;
    }
    add(errors.tangent, farther(distance(frame.limit.pu, result.pu), distance(frame.limit.pv, result.pv)), place);
    add(errors.limitNormal, degreesBetween(frame.normal, dvec3(result.n)), place);
    add(errors.normal, degreesBetween(normalOf(frame, with.normal), dvec3(result.m)), place);
}

} // namespace

FrameErrors compareFrames(const FrameComparison& with, std::span<const SampleQuery> queries,
                          std::span<const SampleResult> results) {
    FrameErrors errors;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const SampleQuery& query = queries[i];
        const bool isApproximate = with.reference->isApproximate(int(query.face), dvec2(query.uv));
        compare(with, query, results[i], isApproximate ? errors.endCaps : errors.regular);
    }
    finish(errors.regular);
    finish(errors.endCaps);
    return errors;
}

} // namespace relief
