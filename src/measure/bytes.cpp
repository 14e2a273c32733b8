#include <algorithm>

#include "measure/measure.h"
#include "shared/inputs.h"

namespace relief {
namespace {

// What shaders/limit.glsl and heights.glsl read for one point of a regular bicubic patch.
constexpr std::uint64_t kRootAndPatch = 2 * 16; ///< texels
constexpr std::uint64_t kTreeWords = 2 * 4;     ///< the root, and one entry below it
constexpr std::uint64_t kNarrowIndices = 16 * 2, kWideIndices = 16 * 4;
constexpr std::uint64_t kPoints = 16 * 16, kTexPoints = 16 * 8;
constexpr std::uint64_t kHeightTexels = 12; ///< around the height and its central differences

} // namespace

std::uint64_t residentBytes(const DenseLayout& layout, const MeshCounts& counts) {
    return layout.vertexBytes() * counts.vertices + std::uint64_t(layout.indexBytes) * 3 * counts.triangles;
}

Traffic denseTraffic(const DenseLayout& layout, const MeshCounts& counts, std::uint64_t vertexCalls) {
    return {.least = residentBytes(layout, counts),
            .cacheless = layout.vertexBytes() * vertexCalls + std::uint64_t(layout.indexBytes) * 3 * counts.triangles};
}

std::uint64_t evaluationBytes(const Evaluation& evaluation) {
    const std::uint64_t indices = evaluation.hasWideIndices ? kWideIndices : kNarrowIndices;
    return kRootAndPatch + kTreeWords + indices + kPoints + (evaluation.hasTexCoords ? indices + kTexPoints : 0) +
           kHeightTexels * (evaluation.format == MapFormat::bc4 ? 8 : 4);
}

Traffic surfaceTraffic(const SurfaceTrafficDesc& desc) {
    constexpr DenseLayout kDiced{16, 16, 0, 4};
    // A diced mesh is written once and read back by the draw.
    const std::uint64_t written = residentBytes(kDiced, desc.diced);
    return {.least = desc.residentBytes + 2 * written,
            .cacheless = desc.calls * evaluationBytes(desc.evaluation) + 2 * written};
}

std::uint64_t posedCageBytes(std::uint64_t cagePoints) { return 12 * cagePoints; }

std::uint64_t posedDenseBytes(const DenseLayout& layout, std::uint64_t vertices) {
    return std::uint64_t(layout.positionBytes + layout.normalBytes) * vertices;
}

} // namespace relief
