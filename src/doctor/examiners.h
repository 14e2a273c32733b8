// Internal: what examineMap is made of.
#pragma once

#include <cmath>

#include "doctor/doctor.h"

namespace relief {

/// A map, its file and the surface that it is for, while they are examined.
struct MapCase {
    const DoctorSubject& subject;
    const DoctorOptions& options;
    const ImageInfo& info;
    const HeightMap& map;
    std::vector<float> sorted; ///< all texels, the lowest first
    std::vector<float> used;   ///< those that the surface covers, the lowest first

    [[nodiscard]] double cageUnits(double height) const { return height * subject.unit; }
    /// A height in cage units by a stored value.
    [[nodiscard]] double heightOf(double stored) const { return cageUnits(map.scale * (stored - map.mid)); }
    [[nodiscard]] double storedRange() const { return double(map.highest) - map.lowest; }
};

/// Calls `take` with the whole-numbered points of a quad between two corners of a box. The quad is two triangles.
template <typename Take>
void eachPointIn(const std::array<dvec2, 4>& quad, const dvec2& lowest, const dvec2& highest, const Take& take) {
    const auto cross = [](const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; };
    const auto isIn = [&](const dvec2& p, std::size_t a, std::size_t b, std::size_t c) {
        const double x = cross(quad[b] - quad[a], p - quad[a]), y = cross(quad[c] - quad[b], p - quad[b]);
        const double z = cross(quad[a] - quad[c], p - quad[c]);
        return (x >= 0 && y >= 0 && z >= 0) || (x <= 0 && y <= 0 && z <= 0);
    };
    dvec2 low(INFINITY), high(-INFINITY);
    for (const dvec2& corner : quad) low = glm::min(low, corner), high = glm::max(high, corner);
    low = glm::clamp(glm::ceil(low), lowest, highest), high = glm::clamp(glm::floor(high), lowest, highest);
    for (int y = int(low.y); y <= high.y; ++y)
        for (int x = int(low.x); x <= high.x; ++x)
            if (isIn(dvec2(x, y), 0, 1, 2) || isIn(dvec2(x, y), 0, 2, 3)) take(x, y);
}

/// The stored values of a map without the aprons of its tiles: tile after tile, row after row.
std::vector<float> valuesOf(const HeightMap& map);

/// Which island covers each of valuesOf(): its number, or kNoIsland.
inline constexpr std::uint32_t kNoIsland = 0xffffffffu;
std::vector<std::uint32_t> coverTexels(const SurfaceLayout& layout, const HeightMap& map);

/// Where the height at the centre of a cell is looked up.
inline MapPlace placeOf(const LayoutCell& cell) {
    return {.face = int(cell.at.face), .uv = dvec2(cell.at.uv), .st = cell.st};
}

/// The value that most of some values are near to, within a width, and their share.
struct Peak {
    double value = 0, share = 0;
};
Peak findPeak(std::span<const float> sorted, double width);
inline constexpr double kPeakShare = 0.15; ///< of a flat part; waves spend up to a twentieth at their crests

/// "face 3 of the cage at (s,t) = (0.1, 0.2)"
std::string describeSpot(const MapCase& map, const SurfaceLocation& at);

using Findings = std::vector<Finding>;

// Of the file: voids, a scale and a channel that are not named.
void examineFile(const MapCase& map, const std::string& path, Findings& findings);
/// Of each file of a set what is examined of a single map's file and values; what several have is one finding.
/// `coverage`: of the set.
void examineTiles(const std::string& path, const DoctorOptions& options, const DoctorSubject& subject,
                  std::span<const std::uint32_t> coverage, Findings& findings);
// Of the values alone.
void examineSteps(const MapCase& map, Findings& findings);
void examineColors(const MapCase& map, Findings& findings);
void examineSigns(const MapCase& map, Findings& findings);
void examineMidlevel(const MapCase& map, Findings& findings);
/// Of vector maps: steps of 8 bits, midlevels of components, and components in another order.
void examineVectors(const MapCase& map, std::span<const std::uint32_t> coverage, Findings& findings);
// Of the values on the surface.
/// Of vector maps: where the surface turns over, by computeFoldFactor().
void examineTurns(const MapCase& map, Findings& findings);
void examineFlips(const MapCase& map, const SeamReport& seams, std::span<const std::uint32_t> coverage,
                  Findings& findings);
void examineSeams(const MapCase& map, const SeamReport& seams, Findings& findings);
void examineIslands(const MapCase& map, std::span<const vec2> ranges, Findings& findings);
void examineStretch(const MapCase& map, Findings& findings);
void examineFolds(const MapCase& map, Findings& findings);

/// How a texel lies on the surface at a cell: its longest and shortest extent, in units of positions.
dvec2 texelExtents(const LayoutCell& cell, const HeightMap& map);
/// The smaller 1 + h kappa in the centre of a cell, of vectors computeFoldFactor(); 1 where nothing is known of it.
double foldFactorOf(const LayoutCell& cell, const HeightMap& map, const ReferenceSurface& reference);
/// Whether a texel is so much longer on the surface than the usual one that its heights smear.
struct StretchLimit {
    double longest = INFINITY; ///< units of positions
    [[nodiscard]] bool isExceededBy(const dvec2& extents) const;
};
StretchLimit computeStretchLimit(const SurfaceLayout& layout, const HeightMap& map);
/// Islands that hold one value while other parts of the map differ; `values`: lowest and highest per island.
std::vector<vec2> computeIslandRanges(const SurfaceLayout& layout, const HeightMap& map,
                                      std::span<const std::uint32_t> coverage);
bool isEmptyIsland(const vec2& range, const HeightMap& map);

} // namespace relief
