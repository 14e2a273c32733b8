// What displacement costs and saves, compared with dense meshes of the same error: the suites that `relief bench` runs.
// Their results, and how those are written and compared, are in results.h. (The program relief_bench in bench/ is
// another thing: comparisons for developers, among them with evaluators of other projects.)
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "frame/frame.h"
#include "measure/results.h"

namespace relief {

// --- the model of bytes --------------------------------------------------------------------------------------------

/// 16-bit positions, 8-bit octahedral normals in the two bytes that pad them to eight, 16-bit texture coordinates.
inline constexpr DenseLayout kQuantisedLayout{6, 2, 4, 4};

struct MeshCounts {
    std::uint64_t vertices = 0, triangles = 0;
};

/// Bytes that one frame reads to make its triangles, and writes where triangles go through memory. `cached`: every
/// resident byte once, as with caches that hold everything; `uncached`: every fetch of every shader invocation.
struct Traffic {
    std::uint64_t cached = 0, uncached = 0;
};
Traffic computeDenseTraffic(const DenseLayout& layout, const MeshCounts& counts, std::uint64_t vertexInvocations);

/// What decides how many bytes one evaluation of a bicubic patch with its height reads.
struct PatchEvaluation {
    bool hasTexCoords = true;
    bool hasWideIndices = false; ///< as SurfaceModel::hasWideIndices
    MapFormat format = MapFormat::real;
};
std::uint64_t computeEvaluationBytes(const PatchEvaluation& evaluation);

struct SurfaceTrafficDesc {
    std::uint64_t residentBytes = 0;
    std::uint64_t evaluationCount = 0;
    PatchEvaluation evaluation;
    MeshCounts diced; ///< the mesh that dicing writes and the draw reads; 0 for other paths
};
Traffic computeSurfaceTraffic(const SurfaceTrafficDesc& desc);

/// Bytes sent to the device for one pose: the positions of the cage, or positions and normals of a dense mesh.
std::uint64_t computePosedCageBytes(std::uint64_t cagePointCount);
std::uint64_t computePosedDenseBytes(const DenseLayout& layout, std::uint64_t vertexCount);

// --- smaller maps and meshes ---------------------------------------------------------------------------------------

/// Makes the map of another size, 32-bit floats, whose lookups are nearest to those of `map` by least squares.
HeightMap resampleMap(const HeightMap& map, int width, int height);

/// A mesh in another form: its geometry after decoding, and its bytes.
struct EncodedMesh {
    DenseMesh decoded;
    std::uint64_t residentBytes = 0, diskBytes = 0; ///< 0 where the form is not used on the device, or on disk
};
/// Quantises a mesh to kQuantisedLayout, triangles and vertices in meshoptimizer's order for caches; its bytes on disk
/// are those of meshoptimizer's coding.
EncodedMesh quantiseMesh(const DenseMesh& mesh);
/// Simplifies a mesh to `triangleCount` triangles by meshoptimizer, which may stop at more because of seams.
DenseMesh simplifyMesh(const DenseMesh& mesh, std::size_t triangleCount);
/// Encodes a mesh by Draco's edgebreaker: `positionBits` per coordinate, 8 per component of normals, 12 per texture
/// coordinate. Throws Failure::internal where Draco fails.
EncodedMesh encodeWithDraco(const DenseMesh& mesh, int positionBits);

// --- suites --------------------------------------------------------------------------------------------------------

/// A cage with its height map.
struct TestScene {
    std::string name;
    Cage cage;
    SurfaceOptions surface;
    HeightMap height;           ///< as the device reads it
    MapEncoding heightEncoding; ///< how the device stores it
};
/// Smooth noise and crisp plates, on bigguy.obj of the folder RELIEF_DATA where it is there, else on the octopus that
/// is built in. The first scene is the one of the suites that take one.
std::vector<TestScene> makeBuiltInScenes(bool isQuick);

/// A frame to be rendered by a process of its own.
struct ProcessRequest {
    std::optional<Path> path;         ///< none: the program's choice
    std::optional<int> rate;          ///< segments per edge, or
    std::optional<double> edgePixels; ///< pixels per segment
    bool usesShaderCache = true;
};
/// What such a process took, and what it reported of its frame.
struct ProcessRun {
    double milliseconds = 0;     ///< from its start to its end
    std::uint64_t peakBytes = 0; ///< resident memory of the process at most
    std::uint64_t triangleCount = 0;
    std::uint64_t deviceBytes = 0, peakDeviceBytes = 0; ///< of surface and map; of all buffers at most
};
using RenderProcess = std::function<ProcessRun(const ProcessRequest&)>;

struct MeasureOptions {
    bool isQuick = false;
    std::string device; ///< as DeviceDesc::name
    /// Makes what renders a scene in processes: `memory` and `startup` need it, and are refused without it.
    std::function<RenderProcess(const TestScene&)> makeRenderProcess;
    ShowProgress progress = ShowProgress::automatic;
};
/// Runs the named suites, those that start processes first. Only `bandwidth` takes all scenes, and one where quick.
/// Throws Failure::input for no scene, and what devices and processes throw.
Results runSuites(std::span<const Suite> suites, std::span<const TestScene> scenes, const MeasureOptions& options);

} // namespace relief
