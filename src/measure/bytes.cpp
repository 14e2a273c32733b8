#include <algorithm>

#include "measure/measure.h"
#include "shared/scene.h"

namespace relief {
namespace {

// What shaders/limit.glsl and displaced.glsl read for one point of a regular bicubic patch.
constexpr std::uint64_t kFaceRecord = 32, kPatchRecord = 32; ///< two texels of 16 bytes each
constexpr std::uint64_t kTreeWords = 2 * 4;                  ///< the root, and one entry below it
constexpr std::uint64_t kPatchPoints = 16 * (4 + 16);        ///< an index and a point
constexpr std::uint64_t kTexPatchPoints = 16 * (4 + 8);
constexpr std::uint64_t kHeightTexels = 5 * 4; ///< the height and its central differences, four texels each

} // namespace

std::uint64_t residentBytes(const DenseLayout& layout, const MeshCounts& counts) {
    return layout.vertexBytes() * counts.vertices + std::uint64_t(layout.indexBytes) * 3 * counts.triangles;
}

Traffic denseTraffic(const DenseLayout& layout, const MeshCounts& counts, std::uint64_t vertexCalls) {
    return {.least = residentBytes(layout, counts),
            .cacheless = layout.vertexBytes() * vertexCalls + std::uint64_t(layout.indexBytes) * 3 * counts.triangles};
}

int fetchedTexelBytes(MapFormat format) {
    switch (format) {
    case MapFormat::real: return 4;
    case MapFormat::half:
    case MapFormat::unorm16:
    case MapFormat::bc4: return 2;
    case MapFormat::unorm8: return 1;
    }
    return 0;
}

std::uint64_t evaluationBytes(int heightBytes, bool hasTexCoords) {
    return kFaceRecord + kPatchRecord + kTreeWords + kPatchPoints + (hasTexCoords ? kTexPatchPoints : 0) +
           kHeightTexels * std::uint64_t(heightBytes);
}

Traffic surfaceTraffic(const SurfaceTrafficDesc& desc) {
    constexpr DenseLayout kDiced{16, 16, 0, 4};
    // A diced mesh is written once and read back by the draw.
    const std::uint64_t written = residentBytes(kDiced, desc.diced);
    return {.least = desc.residentBytes + 2 * written,
            .cacheless = desc.calls * evaluationBytes(desc.heightBytes, desc.hasTexCoords) + 2 * written};
}

std::uint64_t posedCageBytes(std::uint64_t cagePoints) { return 12 * cagePoints; }

std::uint64_t posedDenseBytes(const DenseLayout& layout, std::uint64_t vertices) {
    return std::uint64_t(layout.positionBytes + layout.normalBytes) * vertices;
}

} // namespace relief
