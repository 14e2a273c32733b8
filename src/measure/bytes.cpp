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

/// Bytes of one level of a map.
std::uint64_t levelBytes(MapFormat format, std::uint64_t width, std::uint64_t height) {
    switch (format) {
    case MapFormat::real: return width * height * 4;
    case MapFormat::half:
    case MapFormat::unorm16: return width * height * 2;
    case MapFormat::unorm8: return width * height;
    case MapFormat::bc4: return (width + 3) / 4 * ((height + 3) / 4) * 8;
    }
    return 0;
}

} // namespace

std::string nameOf(MapFormat format) {
    switch (format) {
    case MapFormat::real: return "float";
    case MapFormat::half: return "half";
    case MapFormat::unorm16: return "16 bit";
    case MapFormat::unorm8: return "8 bit";
    case MapFormat::bc4: return "BC4";
    }
    return "";
}

std::uint64_t mapBytes(MapFormat format, int width, int height) {
    std::uint64_t bytes = levelBytes(format, std::uint64_t(width), std::uint64_t(height));
    for (std::uint32_t level = 1; (width > 1 || height > 1) && level < kMostMapLevels; ++level) {
        width = std::max(1, width / 2), height = std::max(1, height / 2);
        bytes += levelBytes(format, std::uint64_t(width), std::uint64_t(height));
    }
    return bytes;
}

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
