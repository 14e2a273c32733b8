// The device's frames against the double-precision reference.
#include <cmath>
#include <limits>

#include "check/angles.h"
#include "check/check.h"

namespace relief {
namespace {

/// Sums squares into rms until finish().
void add(ErrorSummary& summary, double error, const SurfaceLocation& location) {
    if (!std::isfinite(error)) error = std::numeric_limits<double>::infinity();
    summary.rms += error * error;
    if (error <= summary.max) return;
    summary.max = error;
    summary.worst = location;
}

void finish(RegionErrors& errors) {
    const auto root = [](ErrorSummary& summary, std::uint64_t count) {
        summary.rms = count > 0 ? std::sqrt(summary.rms / double(count)) : 0;
    };
    root(errors.point, errors.count);
    for (ErrorSummary* summary : {&errors.tangent, &errors.limitNormal, &errors.normal})
        root(*summary, errors.count - errors.countWithoutNormal);
}

const dvec3& normalOf(const DisplacedFrame& frame, NormalKind kind) {
    return kind == NormalKind::limit ? frame.normal : kind == NormalKind::firstOrder ? frame.firstOrder : frame.full;
}

double farther(double a, double b) { return a >= b || std::isnan(a) ? a : b; }

/// The reference's frame displaced by the device's own height, against what the device has made of it.
void checkDisplacement(SampleError& error, const DisplacedFrame& frame, const SampleResult& r,
                       const FrameComparison& with) {
    constexpr double kPoint = 1e-6, kShareOfHeight = 1e-2, kDegrees = 0.1;
    const bool isFunction = !with.heights.empty();
    const double h = isFunction ? frame.height.h : r.h;
    const double distance = glm::length(frame.limit.p + h * frame.normal - dvec3(r.q));
    error.isMisplaced = !(distance <= kPoint * with.diagonal + kShareOfHeight * std::abs(h));

    // h_u = h_s s_u + h_t t_u, and h_v likewise.
    const bool isPerFace = with.height != nullptr && with.height->addressing == Addressing::faces; // slopes by u and v
    const dmat2 jacobian = isPerFace ? dmat2(1) : frame.tex.jacobian;
    const dvec2 slope(r.gradient), stu = jacobian[0], stv = jacobian[1];
    const dvec2 dh = isFunction ? dvec2(frame.height.hs, frame.height.ht)
                                : dvec2(slope.x * stu.x + slope.y * stu.y, slope.x * stv.x + slope.y * stv.y);
    const DisplacedNormals normals = computeDisplacedNormals(frame.limit, h, dh);
    const dvec3 expected = with.normal == NormalKind::limit        ? frame.normal
                           : with.normal == NormalKind::firstOrder ? normals.firstOrder
                                                                   : normals.full;

    // Where q_u and q_v are much shorter than their terms, or nearly parallel, rounding turns their product.
    const NormalFrame n = computeNormalFrame(frame.limit);
    const double terms = (glm::length(frame.limit.pu) + std::abs(dh.x) + std::abs(h) * glm::length(n.nu)) *
                         (glm::length(frame.limit.pv) + std::abs(dh.y) + std::abs(h) * glm::length(n.nv));
    const double certainty = with.normal == NormalKind::limit ? 1 : std::min(glm::length(expected) / terms, 1.0);
    error.isMisturned = !(certainty * degreesBetween(expected, dvec3(r.m)) <= kDegrees);
}

/// Whether T changes its side there, where texture coordinates are mirrored smoothly, or has no direction: such a map
/// has no one displacement there.
bool isAmbiguous(const VectorMap& map, const TexFrame& tex) {
    constexpr double kSingular = 1e-4; // of the squares
    const dmat2& J = tex.jacobian;
    const double squares = glm::dot(J[0], J[0]) + glm::dot(J[1], J[1]);
    return map.space == VectorSpace::tangent && !(std::abs(glm::determinant(J)) > kSingular * squares);
}

/// Errors of a sample that vectors move: against the reference's surface moved by the device's own components.
void checkVectors(SampleError& error, const SampleQuery& query, const SampleResult& r, const FrameComparison& with) {
    constexpr double kPoint = 1e-6, kShareOfLength = 1e-2, kDegrees = 0.1;
    const VectorSample sample{dvec3(r.c), dvec3(r.cs), dvec3(r.ct)};
    const DisplacedFrame frame =
        displacedByVectors({*with.reference, with.height->vectors->space}, sample, int(query.face), dvec2(query.uv));
    const double length = glm::length(sample.c);
    error.isMisplaced = !(glm::length(frame.q - dvec3(r.q)) <= kPoint * with.diagonal + kShareOfLength * length);
    const dvec3& pu = frame.limit.pu;
    const dvec3& pv = frame.limit.pv;
    const double terms =
        (glm::length(pu) + glm::length(frame.qu - pu)) * (glm::length(pv) + glm::length(frame.qv - pv));
    const double certainty =
        with.normal == NormalKind::limit ? 1 : std::min(glm::length(glm::cross(frame.qu, frame.qv)) / terms, 1.0);
    error.isMisturned = !(certainty * degreesBetween(normalOf(frame, with.normal), dvec3(r.m)) <= kDegrees);
    error.foldFactor = computeFoldFactor(frame);
    error.firstOrderAngle = degreesBetween(frame.firstOrder, frame.full);
}

SampleError errorOf(const FrameComparison& with, std::size_t number, const SampleQuery& query,
                    const SampleResult& result) {
    const int face = int(query.face);
    const DisplacedFrame frame = with.heights.empty()
                                     ? displacedFrame(*with.reference, with.height, face, dvec2(query.uv))
                                     : displacedFrame(*with.reference, with.heights[number], face, dvec2(query.uv));
    const auto distance = [&](const dvec3& a, const vec3& b) { return glm::length(a - dvec3(b)) / with.diagonal; };
    SampleError error{.point = distance(frame.limit.p, result.p),
                      .hasTangentPlane = frame.limit.hasTangentPlane(),
                      .isApproximate = with.reference->isApproximate(int(query.face), dvec2(query.uv))};
    if (!error.hasTangentPlane) return error;
    error.tangent = farther(distance(frame.limit.pu, result.pu), distance(frame.limit.pv, result.pv));
    error.limitNormal = degreesBetween(frame.normal, dvec3(result.n));
    const bool hasVectors = with.height != nullptr && with.height->vectors;
    if (hasVectors && (isAmbiguous(*with.height->vectors, frame.tex) || frame.qu == dvec3(0))) return error;
    error.normal = degreesBetween(normalOf(frame, with.normal), dvec3(result.m));
    if (hasVectors)
        checkVectors(error, query, result, with);
    else
        checkDisplacement(error, frame, result, with);
    return error;
}

void add(RegionErrors& errors, const SampleError& error, const SurfaceLocation& location) {
    ++errors.count;
    add(errors.point, error.point, location);
    if (!error.hasTangentPlane) {
        ++errors.countWithoutNormal;
        return;
    }
    add(errors.tangent, error.tangent, location);
    add(errors.limitNormal, error.limitNormal, location);
    add(errors.normal, error.normal, location);
    errors.countMisplaced += error.isMisplaced ? 1 : 0;
    errors.countMisturned += error.isMisturned ? 1 : 0;
}

} // namespace

std::vector<SampleError> sampleErrors(const FrameComparison& with, std::span<const SampleQuery> queries,
                                      std::span<const SampleResult> results) {
    RELIEF_CHECK(results.size() == queries.size());
    if (!with.heights.empty()) RELIEF_CHECK(with.heights.size() == queries.size());
    std::vector<SampleError> errors;
    errors.reserve(queries.size());
    for (std::size_t i = 0; i < queries.size(); ++i) errors.push_back(errorOf(with, i, queries[i], results[i]));
    return errors;
}

FrameErrors summarizeErrors(std::span<const SampleQuery> queries, std::span<const SampleError> errors) {
    RELIEF_CHECK(errors.size() == queries.size());
    FrameErrors summary;
    for (std::size_t i = 0; i < queries.size(); ++i)
        add(errors[i].isApproximate ? summary.endCaps : summary.regular, errors[i], {queries[i].face, queries[i].uv});
    finish(summary.regular);
    finish(summary.endCaps);
    return summary;
}

FrameErrors compareFrames(const FrameComparison& with, std::span<const SampleQuery> queries,
                          std::span<const SampleResult> results) {
    return summarizeErrors(queries, sampleErrors(with, queries, results));
}

} // namespace relief
