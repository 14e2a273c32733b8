// The triangles made of a model: rates, plans of draws, diced and captured meshes, single points.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "model/model.h"
#include "shared/push.h"

namespace relief {

/// The triangles that the grid path draws at `rate` segments per edge, by the reference evaluator, with full normals;
/// faces share no vertices. For surfaces of four-sided faces.
DenseMesh denseMesh(const ReferenceSurface& surface, const HeightMap* map, int rate);

// --- rates --------------------------------------------------------------------------------------------------------

enum class Path { tessellation, grid, dice }; ///< ways to make the triangles; dense meshes have their own
enum class Spacing { equal, fractional };

struct TriangleOptions {
    Path path = Path::tessellation;
    std::optional<int> rate; ///< segments per cage edge, the same for all ...
    double edgePixels = 2;   ///< ... or as many as make segments this long on screen
    Spacing spacing = Spacing::equal;
    bool filtersHeights = true; ///< heights from the mips whose texels are as large as the segments
    NormalKind normal = NormalKind::full;
    /// Tessellation: vertices that one draw may make; default what suits the device.
    std::optional<std::uint32_t> tessellatedVerticesPerDraw;
    std::optional<std::uint64_t> memory; ///< dicing: bytes that a mesh may take; default half of the device's heap
};

/// What rates are measured from.
struct View {
    vec3 eye{0};
    float nearDistance = 0;
    float pixelsAtUnitDistance = 1; ///< of something one unit long at one unit's distance
};

/// One rate per edge: whole numbers of segments, or with fractional spacing any number from 1.
struct EdgeRates {
    std::vector<float> rates;
    Spacing spacing = Spacing::equal;
    std::vector<float> cornerLevels; ///< mip level of the height map at each corner; empty: 0 everywhere

    [[nodiscard]] bool hasMips() const { return !cornerLevels.empty(); }

    [[nodiscard]] std::uint32_t segments(std::uint32_t edge) const;
};

/// Rates of all edges when a cage edge has `rate` segments: half of it, rounded up, for the halves of edges beside
/// n-gons.
std::vector<float> uniformRates(const SurfaceModel& model, float rate);

/// Measures displaced edges on the device. Shaders are compiled once per kind of model.
class EdgeRater {
public:
    explicit EdgeRater(Device& device);
    ~EdgeRater();

    /// Throws Failure::usage for a rate or path that the device cannot do. `milliseconds`: device time, if measured.
    EdgeRates rates(const SurfaceModel& model, const TriangleOptions& options, const View& view,
                    double* milliseconds = nullptr);
    /// Starts to make the pipelines that rates() will need for a model.
    void startPipelines(const SurfaceModel& model, const TriangleOptions& options);

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// Whether rates of up to `maxRate` are the tessellator's limit, so that segments may be longer than edgePixels asks
/// for. The other paths make up to 1024 segments.
bool isCutShort(const TriangleOptions& options, const DeviceTraits& traits, std::uint32_t maxRate);

/// Segments around and inside a face.
struct FaceSegments {
    std::uint32_t sides[4] = {};
    std::uint32_t u = 1, v = 1; ///< along u and v; of a triangle both the largest
    float rateU = 1, rateV = 1; ///< the larger of the two sides along u, and along v
    float largestRate = 1;
};
FaceSegments faceSegments(const SurfaceModel& model, const EdgeRates& rates, std::uint32_t face);

// --- draws --------------------------------------------------------------------------------------------------------

/// One per face: false where it is hidden with certainty: its box is outside what `worldToClip` shows, or all its
/// normals point away and the near plane cuts nothing of a closed surface. `rates`: those that it is drawn with, for
/// the mip levels of its heights; by default level 0.
std::vector<char> visibleFaces(const SurfaceModel& model, const mat4& worldToClip, const View& view,
                               const EdgeRates& rates = {});

/// Faces drawn together, and the calls that draw them.
struct DrawBatch {
    std::uint32_t columns = 0, rows = 0;        ///< grid: segments along u and v of every face in it
    std::uint32_t firstFace = 0, faceCount = 0; ///< into DrawPlan::faces
};

struct DrawPlan {
    std::vector<std::uint32_t> faces;
    std::vector<DrawBatch> batches; ///< those of visible faces first
    std::size_t visibleBatchCount = 0;
    std::uint64_t visibleFaceCount = 0;
    std::uint64_t triangleCount = 0;
    std::uint64_t vertexCount = 0; ///< distinct samples of the surface
    std::uint32_t maxRate = 0;
};

/// Splits faces into draws of at most `verticesPerDraw` tessellated vertices, in order of faces; the draws of visible
/// faces come first, and without `isVisible` all faces are.
DrawPlan planPatches(const SurfaceModel& model, const EdgeRates& rates, std::uint32_t verticesPerDraw,
                     std::span<const char> isVisible = {});
/// Groups faces by their segments along u and v.
DrawPlan planGrids(const SurfaceModel& model, const EdgeRates& rates, std::span<const char> isVisible = {});
/// Triangles that the fixed-function tessellator, or the dicer, makes of one patch with these side rates (3 or 4 of
/// them).
std::uint64_t tessellatedTriangles(std::span<const std::uint32_t> sideRates);
std::uint64_t dicedTriangles(std::span<const std::uint32_t> sideRates);

// --- diced meshes -------------------------------------------------------------------------------------------------

struct DicedPieces;

/// An indexed mesh on the device: every distinct sample of the surface once, repeated with the same position bits only
/// where normals or texture coordinates differ. Or the buffers for one piece of a large mesh after the other: each is
/// written by what Dicer::recordPiece() records, and read before the next one.
struct DicedMesh {
    TexelBuffer vertices;                             ///< two texels each: position and height, normal
    TexelBuffer texCoords;                            ///< empty unless asked for
    TexelBuffer texGradients;                         ///< as kBindMeshTexGradients; empty unless asked for
    TexelBuffer indices;                              ///< three 32-bit indices per triangle, face after face
    std::vector<std::uint32_t> firstTriangles;        ///< of each face; one more at the end
    std::vector<std::uint32_t> faceRates;             ///< the largest around each face
    std::vector<std::uint32_t> runFirsts;             ///< first vertex of each run along edges; one more at the end
    std::vector<DicedFacePush> faces;                 ///< where vertices lie in each face; empty unless asked for
    std::uint64_t sampleCount = 0;                    ///< distinct samples of the surface
    std::uint64_t allTriangles = 0;                   ///< of the surface
    std::uint32_t vertexCount = 0, triangleCount = 0; ///< in the buffers at most
    std::uint32_t maxRate = 0;
    std::shared_ptr<const DicedPieces> pieces; ///< null: the buffers hold all of it
    bool hasTexCoords = false;
    std::uint64_t byteCount = 0;
    double milliseconds = 0;       ///< on the device; 0 where it cannot time
    double vertexMilliseconds = 0; ///< without the triangles; only where DiceOptions asks for it
};

struct DiceOptions {
    NormalKind normal = NormalKind::full;
    bool wantsTexCoords = false, wantsTexGradients = false;
    bool wantsFaces = false; ///< DicedMesh::faces: 120 bytes of host memory per face
    std::optional<std::uint64_t> memory;
    /// Where the mesh has more triangles it is made in pieces of at most as many (a face is in one piece); default:
    /// never.
    std::optional<std::uint64_t> pieceTriangles;
    bool timesVertices = false; ///< apart from the triangles: one more wait for the device
};

class Dicer {
public:
    explicit Dicer(Device& device);
    ~Dicer();

    /// Throws Failure::device when the mesh would take more than the memory allowed, before anything is allocated.
    DicedMesh dice(const SurfaceModel& model, const EdgeRates& rates, const DiceOptions& options = {});
    /// Vertices and triangles of one piece of a mesh.
    struct PieceSize {
        std::uint32_t vertexCount, triangleCount;
    };
    /// Of a mesh that is diced in pieces.
    static std::vector<PieceSize> piecesOf(const DicedMesh& mesh);
    /// Records how piece `number` of a mesh is written to its buffers; those on edges come with piece 0.
    void recordPiece(VkCommandBuffer commands, const DicedMesh& mesh, std::size_t number) const;
    /// Dices the surface and reads the mesh back to host memory. Throws as dice() does.
    DenseMesh diceToHost(const SurfaceModel& model, const EdgeRates& rates, const DiceOptions& options = {});
    /// Starts to make the pipelines that dice() will need, before there are rates. `hasMips`: a guess at
    /// EdgeRates::hasMips(); where it is wrong they are made in vain.
    void startPipelines(const SurfaceModel& model, const DiceOptions& options, bool hasMips);

    struct Parts;

private:
    std::unique_ptr<Parts> parts_;
};

/// Copies a diced mesh to host memory, ready to be written to a file.
DenseMesh readBack(Device& device, const DicedMesh& mesh);

// --- captured triangles -------------------------------------------------------------------------------------------

/// The triangles that a path makes, as the device made them.
struct CapturedMesh {
    std::vector<vec3> positions;
    std::vector<char> isOnBoundary;     ///< one per vertex: it lies on an edge of the cage that has one drawn face
    std::vector<std::uint32_t> indices; ///< three per triangle
};

/// Reads triangles back. Shaders are compiled once per kind of model.
class Capturer {
public:
    explicit Capturer(Device& device);
    ~Capturer();

    /// Tessellation: by transform feedback (Failure::usage where the device has none); grid: stored by the vertex
    /// shader; dice: read back.
    CapturedMesh capture(const SurfaceModel& model, const TriangleOptions& options, const EdgeRates& rates);

    struct Parts;

private:
    std::unique_ptr<Parts> parts_;
};

/// How many triangles a Capturer has to find.
std::uint64_t plannedTriangles(const SurfaceModel& model, Path path, const EdgeRates& rates);

/// Segments of all edges of the cage that have one drawn face.
std::uint64_t boundarySegments(const SurfaceModel& model, const EdgeRates& rates);

// --- single points ------------------------------------------------------------------------------------------------

struct SampleOptions {
    std::size_t firstRow = 0; ///< number of the first query, for messages
    NormalKind normal = NormalKind::full;
    bool isGenericBasis = false; ///< OpenSubdiv's own basis for all patches: slower, the check of the others
};

/// The device's own frames at single points. Shaders are compiled once per kind of model.
class SurfaceSampler {
public:
    explicit SurfaceSampler(Device& device);
    ~SurfaceSampler();

    /// Throws Failure::input for a face out of range, a hole, or (u,v) outside its face.
    std::vector<SampleResult> sample(const SurfaceModel& model, std::span<const SampleQuery> queries,
                                     const SampleOptions& options = {});

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace relief
