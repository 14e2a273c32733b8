// Internal: the tables of a surface as the device reads them.
#pragma once

#include <cstring>

#include "shared/points.h"
#include "shared/records.h"
#include "surface/surface.h"

namespace relief {

/// Appends records as words, each padded to its texels; returns the texel that they start at.
template <std::uint32_t kTexels, typename Record>
std::uint32_t appendRecords(std::vector<std::uint32_t>& words, const std::vector<Record>& records) {
    static_assert(sizeof(Record) <= 16 * kTexels);
    const std::size_t first = words.size();
    words.resize(first + records.size() * 4 * kTexels);
    for (std::size_t i = 0; i < records.size(); ++i)
        std::memcpy(&words[first + i * 4 * kTexels], &records[i], sizeof(Record));
    return std::uint32_t(first / 4);
}

/// The words of shared/records.h, and the texel where each table begins.
struct SurfaceRecords {
    std::vector<std::uint32_t> words;
    std::uint32_t firstFace = 0, firstPatch = 0, firstEdge = 0, firstCorner = 0, firstIncidence = 0;
    bool hasWideIndices = false, hasStraightCorners = false;
    std::uint32_t patchTypes = 0; ///< kIdPatchTypes
};
SurfaceRecords recordsOf(const Surface& surface);

/// Packs a point as shared/points.h says.
vec4 packPoint(const dvec3& point);

} // namespace relief
