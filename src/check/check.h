// The certificate: are the device's triangles watertight, its frames exact, the displacement one-to-one, and do the two
// sides of a seam agree? All of it runs on the host, on what a device has handed back, and shares no formula with the
// shaders.
#pragma once

#include <optional>
#include <span>

#include "displacement/displacement.h"
#include "shared/sample.h"
#include "surface/surface.h"
#include "triangles/triangles.h"

namespace relief {

// --- watertight ---------------------------------------------------------------------------------------------------

/// Limits of the diagnosis, which keep its time and memory small. All edges that only one triangle has are counted; at
/// most kMostKeptEdges of them are kept, and gaps and T-junctions are searched for at most kMostDiagnosedEdges of
/// these.
inline constexpr std::size_t kMostDiagnosedEdges = 1u << 13, kMostKeptEdges = 1u << 20;

/// What is left open after vertices at the same position have been merged.
struct Watertightness {
    std::uint64_t triangles = 0; ///< with three different vertices, whose positions may coincide
    std::optional<std::uint64_t> expectedTriangles;
    std::uint64_t distinctPoints = 0;
    std::uint64_t degenerateTriangles = 0; ///< with fewer than 3 distinct points; their edges are not counted
    std::uint64_t notFinite = 0;           ///< vertices; the edges of their triangles are not counted
    std::uint64_t openEdges = 0;           ///< edges that only one triangle has, inside the cage
    std::uint64_t tJunctions = 0;          ///< ends of open edges inside another edge that only one triangle has
    std::uint64_t boundarySegments = 0;    ///< edges that only one triangle has, both ends on the cage's boundary
    std::uint64_t expectedBoundarySegments = 0;
    /// Boundary segments that may be missing among `boundarySegments`: they collapsed to a point, or coincide with
    /// another edge.
    std::uint64_t hiddenBoundarySegments = 0;
    /// Distance from an open edge to the nearest other edge that only one triangle has, end to end, in units in the
    /// last place of the ends' largest coordinate; 0 when nothing is open.
    float largestGapUlps = 0;
    vec3 worstLocation{0}; ///< position of the largest gap

    [[nodiscard]] bool isBoundaryWhole() const;
    [[nodiscard]] bool hasAllTriangles() const { return triangles == expectedTriangles.value_or(triangles); }
    [[nodiscard]] bool isWatertight() const;
};

/// Merges vertices whose positions have the same bits (-0 equals +0) and counts the triangles at each edge.
/// A missing triangle whose edges are all on the boundary leaves no open edge behind: only a comparison with
/// `expectedTriangles` (plannedTriangles) shows it.
/// Throws Failure::internal for arrays that do not fit each other.
Watertightness checkWatertight(const CapturedMesh& mesh, std::uint64_t expectedBoundarySegments,
                               std::optional<std::uint64_t> expectedTriangles = {});

// --- exact --------------------------------------------------------------------------------------------------------

/// A point of the surface by face and (u,v).
struct SurfaceLocation {
    std::uint32_t face = 0;
    vec2 uv{0};
};

/// Points that cover all drawn faces equally, corners and edges included.
struct SurfaceSamples {
    std::vector<SampleQuery> queries;
    std::vector<double> weights; ///< per query: its share of the face's (u,v) domain, which is 1, or 1/2 for triangles
    std::vector<char> hasCurvature; ///< per query: false in corners of end caps, where it depends on the direction
};

/// Makes about `budget` points, and at least 3 x 3 per face (10 per triangle).
SurfaceSamples sampleEverywhere(const Surface& surface, std::size_t budget);

struct ErrorSummary {
    double max = 0, rms = 0; ///< infinite when a value is not finite
    SurfaceLocation worst;
};

struct RegionErrors {
    std::uint64_t count = 0;
    std::uint64_t countWithoutNormal = 0; ///< points without a tangent plane, which have no tangents and normals
    std::uint64_t countMisplaced = 0;     ///< points where SampleError::isMisplaced
    std::uint64_t countMisturned = 0;     ///< points where SampleError::isMisturned
    ErrorSummary point;                   ///< |p - p'| over the diagonal
    ErrorSummary tangent;                 ///< the larger of |p_u - p_u'| and |p_v - p_v'| over the diagonal
    ErrorSummary limitNormal, normal;     ///< degrees; `normal` is that of the displaced surface
};

/// Errors of the device's frames against the reference, apart for end caps, where the patches only approximate the
/// surface.
struct FrameErrors {
    RegionErrors regular, endCaps;
};

/// A height function in double precision. Its values come from a shader that contains nothing else; points, texture
/// coordinates and slopes are computed here. Slopes are central differences over FunctionHeights::step along p_u and
/// p_v at rest, at most 1/64 of the face: h_u = (h(p + d p_u, st + d st_u) - h(p - d p_u, st - d st_u)) / 2d.
class FunctionReference {
public:
    /// `rest`: the surface at rest. All of it has to outlive this.
    FunctionReference(Device& device, const FunctionHeights& heights, const ReferenceSurface& rest, double seconds);

    /// One height per query, with its slopes.
    std::vector<FaceHeight> heights(std::span<const SampleQuery> queries);
    /// One height per point (face, uv), without slopes.
    std::vector<double> heightsAt(std::span<const std::pair<int, dvec2>> points);

private:
    std::vector<double> evaluate(std::span<const FunctionPoint> points);
    [[nodiscard]] FunctionPoint pointAt(const dvec3& p, const dvec2& st) const;

    const FunctionHeights& heights_;
    const ReferenceSurface& rest_;
    double seconds_;
    FunctionEvaluator evaluator_;
};

struct FrameComparison {
    const ReferenceSurface* reference = nullptr;
    const HeightMap* height = nullptr; ///< or none
    NormalKind normal = NormalKind::full;
    double diagonal = 1; ///< of the cage's bounding box
    /// One per query, in place of a map: FunctionReference::heights().
    std::span<const FaceHeight> heights{};
};

/// What is wrong at one point, in the units of RegionErrors; not finite where a value is not.
struct SampleError {
    double point = 0, tangent = 0, limitNormal = 0, normal = 0;
    bool hasTangentPlane = true; ///< else the device has repaired its tangents, and all but `point` is 0
    bool isApproximate = false;  ///< in an end cap

    // The device's displacement against that of the reference, for the device's own height and slopes: rough maps and
    // texture coordinates of few digits do not count as errors of it. Height functions have neither: there height and
    // slopes are the reference's.
    bool isMisplaced = false; ///< q is farther from p + h n than 1e-6 of the diagonal and 1 % of |h|
    bool isMisturned = false; ///< the displaced normal is off by more than 0.1 degrees; by more where its terms cancel
    // Of vector maps, by the device's own components:
    std::optional<double> foldFactor{}; ///< computeFoldFactor
    double firstOrderAngle = 0;         ///< degrees between the full and the first-order normal
};

/// Compares the device's answers with the reference: `results[i]` is the answer to `queries[i]`.
std::vector<SampleError> sampleErrors(const FrameComparison& with, std::span<const SampleQuery> queries,
                                      std::span<const SampleResult> results);
FrameErrors summarizeErrors(std::span<const SampleQuery> queries, std::span<const SampleError> errors);
/// sampleErrors and summarizeErrors in one call.
FrameErrors compareFrames(const FrameComparison& with, std::span<const SampleQuery> queries,
                          std::span<const SampleResult> results);

// --- corners --------------------------------------------------------------------------------------------------------

/// Makes a query for each corner of every drawn face.
std::vector<SampleQuery> cornersOf(const Surface& surface);

/// How far the device's limit normals in corners of faces are from the reference's normals beside them. In the corner
/// itself, where p_u and p_v may be parallel, device and reference could share a mistake.
struct CornerReport {
    /// Corners of 6 degrees and more, at vertices of up to 24 faces, or 12 between sharp edges: around more a surface
    /// is nearly a cone.
    std::uint64_t count = 0;
    /// Degrees between the normal in the corner and that 1/1024 of the face away along the diagonal, or 2^-28 around
    /// more than 8 faces (4 between sharp edges), less the degrees between that and the normal twice as far away.
    double max = 0;
    SurfaceLocation worst;
};

/// `results[i]` is the device's answer to `queries[i]`, each of which is a corner.
CornerReport reportCorners(const ReferenceSurface& reference, std::span<const SampleQuery> queries,
                           std::span<const SampleResult> results);

// --- one-to-one ---------------------------------------------------------------------------------------------------

/// Principal curvatures, 1 / cage units, with dn = kappa dP: a sphere of radius r with its normal outward has kappa =
/// 1/r twice.
struct Curvatures {
    double lowest = 0, highest = 0;
};

/// Computes them from the first and second fundamental forms of a frame that has a tangent plane.
Curvatures principalCurvatures(const LimitFrame& frame);

/// The displaced surface is locally one-to-one where 1 + h kappa > 0 for both principal curvatures.
struct CurvatureReport {
    std::uint64_t count = 0;                 ///< points that are evaluated
    std::uint64_t countWithoutCurvature = 0; ///< points without curvature or tangent plane, or not finite: skipped
    double lowestFactor = 1;                 ///< minimum of 1 + h kappa
    SurfaceLocation lowestAt;
    double area = 0, foldedArea = 0; ///< of the limit surface, cage units squared; folded where 1 + h kappa <= 0
    /// Angle between the full normal and the first-order one, which ignores curvature; the mean is over the area.
    double maxNormalAngle = 0, meanNormalAngle = 0; ///< degrees
    SurfaceLocation maxNormalAngleAt;

    [[nodiscard]] double foldedFraction() const { return area > 0 ? foldedArea / area : 0; }
};

/// The smaller of 1 + h kappa; not finite without a tangent plane.
double foldFactor(const SampleResult& result);

/// Evaluates the device's own frames: `results[i]` is the answer to `samples.queries[i]`.
CurvatureReport reportCurvature(const SurfaceSamples& samples, std::span<const SampleResult> results);
/// Evaluates the frames of a vector map, whose fold factors are those of `errors`.
CurvatureReport reportFolds(const SurfaceSamples& samples, std::span<const SampleResult> results,
                            std::span<const SampleError> errors);

// --- seams --------------------------------------------------------------------------------------------------------

/// How far the faces of one edge disagree.
struct SeamEdge {
    std::uint32_t edge = 0; ///< of the Surface
    double max = 0;         ///< cage units
    SurfaceLocation worst;  ///< in the owner's face
};

/// How far the faces of an edge disagree about the height there. The height of the edge's owner is drawn; a
/// disagreement is a fault of the map.
struct SeamReport {
    std::uint64_t seamEdgeCount = 0; ///< edges of the Surface whose faces have different texture coordinates
    double length = 0;               ///< of those edges on the limit surface, cage units
    double max = 0, mean = 0;        ///< cage units; the mean is over the length
    SurfaceLocation worst;           ///< in the owner's face
    std::vector<SeamEdge> edges;     ///< those that disagree, in the order of the Surface
};

/// Measures all seams. Without texture coordinates every face takes the whole map, and every edge between faces can be
/// a seam.
SeamReport reportSeams(const Surface& surface, const ReferenceSurface& reference, const HeightMap& map);
/// Measures all seams of a surface whose heights a function gives.
SeamReport reportSeams(const Surface& surface, const ReferenceSurface& reference, FunctionReference& function);

} // namespace relief
