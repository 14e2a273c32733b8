#include "measure/measure.h"

namespace relief {
namespace {

// Bytes that shaders/limit.glsl and heights.glsl read for one point of a regular bicubic patch.
constexpr std::uint64_t kRootAndPatch = 2 * 16; ///< a record of the face and one of the patch
constexpr std::uint64_t kTreeWords = 2 * 4;     ///< the root of the face's tree, and one entry below it
constexpr std::uint64_t kNarrowIndices = 16 * 2, kWideIndices = 16 * 4;
constexpr std::uint64_t kPoints = 16 * 16, kTexPoints = 16 * 8;
constexpr std::uint64_t kHeightTexels = 12; ///< count: those around the height and its central differences
constexpr std::uint64_t kTexelBytes = 4, kBlockBytes = 8;

} // namespace

Traffic computeDenseTraffic(const DenseLayout& layout, const MeshCounts& counts, std::uint64_t vertexInvocations) {
    return {.cached = denseBytes(counts.vertices, counts.triangles, layout),
            .uncached = denseBytes(vertexInvocations, counts.triangles, layout)};
}

std::uint64_t computeEvaluationBytes(const PatchEvaluation& evaluation) {
    const std::uint64_t indices = evaluation.hasWideIndices ? kWideIndices : kNarrowIndices;
    return kRootAndPatch + kTreeWords + indices + kPoints + (evaluation.hasTexCoords ? indices + kTexPoints : 0) +
           kHeightTexels * (evaluation.format == MapFormat::bc4 ? kBlockBytes : kTexelBytes);
}

Traffic computeSurfaceTraffic(const SurfaceTrafficDesc& desc) {
    constexpr DenseLayout kDicedLayout{16, 16, 0, 4};
    // A diced mesh is written once and read back by the draw.
    const std::uint64_t diced = 2 * denseBytes(desc.diced.vertices, desc.diced.triangles, kDicedLayout);
    return {.cached = desc.residentBytes + diced,
            .uncached = desc.evaluationCount * computeEvaluationBytes(desc.evaluation) + diced};
}

std::uint64_t computePosedCageBytes(std::uint64_t cagePointCount) { return sizeof(vec3) * cagePointCount; }

std::uint64_t computePosedDenseBytes(const DenseLayout& layout, std::uint64_t vertexCount) {
    return std::uint64_t(layout.positionBytes + layout.normalBytes) * vertexCount;
}

} // namespace relief
