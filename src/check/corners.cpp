// Normals in corners of faces against those beside them.
#include <cmath>
#include <limits>

#include "check/angles.h"
#include "check/check.h"

namespace relief {
namespace {

/// Distance from a corner, as a fraction of the face: within the patch that holds the corner, since normals beside a
/// vertex of high valence turn fast; not nearer, since OpenSubdiv's tangents of straight corners are 1.5e-5 off.
constexpr double kBeside = 1.0 / 1024;
/// The distance from a corner with more than kFewFacesPerWave faces per wave, where normals converge slowly.
constexpr double kBesideInCap = 0x1p-28;
constexpr int kFewFacesPerWave = 8;
/// Faces per wave (ReferenceSurface::facesPerWave) with which normals at that distance have converged.
constexpr int kMostFacesPerWave = 24;

/// Degrees between `normal` and the reference's normals beside the corner, less the turn of these.
double turnAtCorner(const ReferenceSurface& reference, const SampleQuery& corner, const dvec3& normal) {
    const dvec2 uv(corner.uv);
    // The sum of both sides' directions: from (0,0) it is (1,1).
    const dvec2 diagonal = dvec2(1) - (reference.sideCount() == 4 ? 2.0 : 3.0) * uv;
    const bool isSlow = reference.facesPerWave(int(corner.face), uv) > kFewFacesPerWave;
    const double distance = isSlow ? kBesideInCap : kBeside;
    const dvec3 beside = reference.normal(int(corner.face), uv + distance * diagonal);
    const dvec3 farther = reference.normal(int(corner.face), uv + 2 * distance * diagonal);
    const double turn = degreesBetween(normal, beside) - degreesBetween(beside, farther);
    return std::isnan(turn) ? std::numeric_limits<double>::infinity() : turn;
}

/// p_u and p_v point nearly the same way, not the opposite one as in straight corners.
bool isNarrow(const LimitFrame& frame) {
    const double lengths = glm::length(frame.pu) * glm::length(frame.pv);
    return glm::length(glm::cross(frame.pu, frame.pv)) < 0.1 * lengths && frame.hasTangentPlane();
}

} // namespace

std::vector<SampleQuery> cornersOf(const Surface& surface) {
    std::vector<SampleQuery> queries;
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        if (surface.faces[face].root == kNoPatch) continue;
        for (int corner = 0; corner < surface.sideCount; ++corner)
            queries.push_back({face, vec2(sidePoint(surface.sideCount, corner, 0))});
    }
    return queries;
}

CornerReport reportCorners(const ReferenceSurface& reference, std::span<const SampleQuery> queries,
                           std::span<const SampleResult> results) {
    RELIEF_CHECK(results.size() == queries.size());
    CornerReport report;
    for (std::size_t i = 0; i < queries.size(); ++i) {
        const dvec2 uv(queries[i].uv);
        const int face = int(queries[i].face);
        if (isNarrow(reference.limit(face, uv)) || reference.facesPerWave(face, uv) > kMostFacesPerWave) continue;
        ++report.count;
        const double turn = turnAtCorner(reference, queries[i], dvec3(results[i].n));
        if (turn <= report.max) continue;
        report.max = turn;
        report.worst = {queries[i].face, queries[i].uv};
    }
    return report;
}

} // namespace relief
