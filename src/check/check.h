// The certificate: are the device's triangles watertight, its frames exact, the displacement one-to-one, and do the two
// sides of a seam agree? All of it on the host, from what a device has handed back.
#pragma once

#include <optional>
#include <span>

#include "displacement/displacement.h"
#include "triangles/triangles.h"
#include "shared/sample.h"
#include "surface/surface.h"

namespace relief {

// --- watertight ---------------------------------------------------------------------------------------------------

/// All edges of one triangle are counted; gaps and T-junctions are looked for at so many of the open ones, among so
/// many.
inline constexpr std::size_t kMostDiagnosedEdges = 1u << 13, kMostKeptEdges = 1u << 20;

/// What is left open when vertices at the same position are one.
struct Watertightness {
    std::uint64_t triangles = 0; ///< three different vertices each, whether or not they lie apart
    std::optional<std::uint64_t> expectedTriangles;
    std::uint64_t distinctPoints = 0;
    std::uint64_t degenerateTriangles = 0; ///< fewer than 3 distinct points: samples may coincide; they have no edges
    std::uint64_t notFinite = 0;           ///< vertices; their triangles have no edges
    std::uint64_t openEdges = 0;           ///< edges of one triangle, inside the cage
    std::uint64_t tJunctions = 0;          ///< ends of open edges inside another edge of one triangle
    std::uint64_t boundarySegments = 0;    ///< edges of one triangle whose ends are both on the cage's boundary
    std::uint64_t expectedBoundarySegments = 0;
    /// Boundary segments that may have gone: collapsed to a point, or in the place of another edge.
    std::uint64_t hiddenBoundarySegments = 0;
    /// From an open edge to the nearest other edge of one triangle, end to end, in units in the last place of the
    /// ends' largest coordinate; 0 when nothing is open.
    float largestGapUlps = 0;
    vec3 worstPlace{0}; ///< of the largest gap

    [[nodiscard]] bool isBoundaryWhole() const;
    [[nodiscard]] bool hasAllTriangles() const { return triangles == expectedTriangles.value_or(triangles); }
    [[nodiscard]] bool isWatertight() const;
};

/// Welds vertices of identical bits (-0 and +0 are one place, so they weld) and counts the triangles at each edge.
/// A triangle with all its edges on the boundary leaves no open edge behind: only `expectedTriangles`
/// (plannedTriangles) misses it. Throws Failure::internal for arrays that do not fit each other.
Watertightness checkWatertight(const CapturedMesh& mesh, std::uint64_t expectedBoundarySegments,
                               std::optional<std::uint64_t> expectedTriangles = {});

// --- exact --------------------------------------------------------------------------------------------------------

struct SurfacePlace {
    std::uint32_t face = 0;
    vec2 uv{0};
};

/// Points that cover all drawn faces alike, with their corners and edges.
struct SurfaceSamples {
    std::vector<SampleQuery> queries;
    std::vector<double> weights;    ///< one a query: its share of the face's (u,v); 1 a face, 1/2 a triangle
    std::vector<char> hasCurvature; ///< one a query: false in corners of end caps, where it depends on the direction
};

/// About `budget` points, and at least 3 x 3 a face (10 a triangle).
SurfaceSamples sampleEverywhere(const Surface& surface, std::size_t budget);

struct ErrorSummary {
    double max = 0, rms = 0; ///< infinite when a value is not finite
    SurfacePlace worst;
};

struct RegionErrors {
    std::uint64_t count = 0;
    std::uint64_t countWithoutNormal = 0; ///< points without a tangent plane: left out of tangents and normals
    ErrorSummary point;                   ///< |p - p'| over the diagonal
    ErrorSummary tangent;                 ///< the larger of |p_u - p_u'| and |p_v - p_v'| over the diagonal
    ErrorSummary limitNormal, normal;     ///< degrees; `normal` is that of the displaced surface
};

/// The device's frames against the reference. In end caps the patches only approximate the surface.
struct FrameErrors {
    RegionErrors regular, endCaps;
};

struct FrameComparison {
    const ReferenceSurface* reference = nullptr;
    const HeightMap* height = nullptr; ///< or none
    NormalKind normal = NormalKind::full;
    double diagonal = 1; ///< of the cage's bounding box
};

/// What is wrong at one point, in the units of RegionErrors; not finite where a value is not.
struct SampleError {
    double point = 0, tangent = 0, limitNormal = 0, normal = 0;
    bool hasTangentPlane = true; ///< else the device has mended its tangents, and all but `point` are 0
    bool isApproximate = false;  ///< in an end cap
};

/// `results[i]` is the device's answer to `queries[i]`.
std::vector<SampleError> sampleErrors(const FrameComparison& with, std::span<const SampleQuery> queries,
                                      std::span<const SampleResult> results);
FrameErrors summarizeErrors(std::span<const SampleQuery> queries, std::span<const SampleError> errors);
/// Both in one.
FrameErrors compareFrames(const FrameComparison& with, std::span<const SampleQuery> queries,
                          std::span<const SampleResult> results);

// --- corners --------------------------------------------------------------------------------------------------------

/// A query per corner of every drawn face.
std::vector<SampleQuery> cornersOf(const Surface& surface);

/// The device's limit normals in corners of faces against the reference's beside them. In the corner itself device and
/// reference could share a mistake: p_u and p_v may be parallel there.
struct CornerReport {
    std::uint64_t count = 0; ///< without corners of less than 6 degrees: a surface is nearly a cone at vertices of many faces
    /// Degrees from the normal 1/1024 of the face away along the diagonal, less what the normal turns in as much again.
    double max = 0;
    SurfacePlace worst;
};

/// `results[i]` is the device's answer to `queries[i]`, each of which is a corner.
CornerReport reportCorners(const ReferenceSurface& reference, std::span<const SampleQuery> queries,
                           std::span<const SampleResult> results);

// --- one-to-one ---------------------------------------------------------------------------------------------------

/// With dn = kappa dP: a sphere of radius r with its normal outward has kappa = 1/r twice.
struct Curvatures {
    double lowest = 0, highest = 0;
};

/// Principal curvatures from the first and second fundamental forms; the frame has a tangent plane.
Curvatures principalCurvatures(const LimitFrame& frame);

/// The displaced surface is locally one-to-one where 1 + h kappa > 0 for both principal curvatures.
struct CurvatureReport {
    std::uint64_t count = 0;                 ///< points that tell
    std::uint64_t countWithoutCurvature = 0; ///< points without one, without a tangent plane or not finite: left out
    double lowestFactor = 1;                 ///< minimum of 1 + h kappa
    SurfacePlace lowestAt;
    double area = 0, foldedArea = 0; ///< of the limit surface, cage units squared; folded where 1 + h kappa <= 0
    /// Between the full normal and the first-order one, which leaves out curvature; the mean is over the area.
    double maxNormalAngle = 0, meanNormalAngle = 0; ///< degrees
    SurfacePlace maxNormalAngleAt;

    [[nodiscard]] double foldedFraction() const { return area > 0 ? foldedArea / area : 0; }
};

/// The smaller of 1 + h kappa; not finite without a tangent plane.
double foldFactor(const SampleResult& result);

/// From the device's own frames at `samples`.
CurvatureReport reportCurvature(const SurfaceSamples& samples, std::span<const SampleResult> results);

// --- seams --------------------------------------------------------------------------------------------------------

/// How far the faces of an edge disagree about the height there. The owner's height is drawn; this is the map's fault.
struct SeamReport {
    std::uint64_t seamEdgeCount = 0; ///< edges of the Surface whose faces have different texture coordinates
    double length = 0;               ///< of those edges on the limit surface, cage units
    double max = 0, mean = 0;        ///< cage units; the mean is over the length
    SurfacePlace worst;              ///< in the owner's face
};

/// Without texture coordinates every face takes the whole map, and every edge between faces can be a seam.
SeamReport reportSeams(const Surface& surface, const ReferenceSurface& reference, const HeightMap& map);

} // namespace relief
