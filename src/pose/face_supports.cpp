#include <algorithm>
#include <cmath>
#include <utility>

#include "pose/pose.h"

namespace relief {
namespace {

/// A phantom point 2 a - b beyond a boundary is as far from the middle as three points.
constexpr float kPhantomSpread = 3;

/// Far::PatchParam's field1: bits 7 to 11 mark boundaries.
bool hasBoundary(const Patch& patch) { return (patch.param1 >> 7 & 31) != 0; }

/// Collects the cage points that move one face after another, each once.
class SupportBuilder {
public:
    explicit SupportBuilder(const Surface& surface)
        : surface_(surface), seenBy_(surface.controlPointCount + surface.stencils.sharedRowCount, kNoPatch) {
        for (std::size_t row = 0; row < surface.stencils.rowCount(); ++row) {
            float sum = 0;
            for (std::uint32_t k = surface.stencils.offsets[row]; k < surface.stencils.offsets[row + 1]; ++k)
                sum += float(std::abs(surface.stencils.weight(row, k))) * spreadOf(surface.stencils.indices[k]);
            rowSpreads_.push_back(sum);
        }
    }

    /// Appends the points of a face; returns its spread.
    float addFace(std::uint32_t face, std::vector<std::uint32_t>& points) {
        float spread = 1;
        for (const TreeLeaf& leaf : leavesOf(surface_.tree, surface_.faces[face].root)) {
            const Patch& patch = surface_.patches[leaf.patchIndex];
            const float factor = hasBoundary(patch) ? kPhantomSpread : 1;
            for (std::uint32_t i = 0; i < patch.pointCount; ++i)
                spread = std::max(spread, factor * addPoint(surface_.patchPoints[patch.firstPoint + i], face, points));
        }
        return spread;
    }

private:
    [[nodiscard]] float spreadOf(std::uint32_t point) const {
        return point < surface_.controlPointCount ? 1 : rowSpreads_[point - surface_.controlPointCount];
    }

    /// Returns the point's spread.
    float addPoint(std::uint32_t point, std::uint32_t face, std::vector<std::uint32_t>& points) {
        const bool isKept = point < seenBy_.size(); // a point of the cage or a shared one
        if (isKept && std::exchange(seenBy_[point], face) == face) return spreadOf(point);
        if (point < surface_.controlPointCount) {
            points.push_back(point);
            return 1;
        }
        const std::uint32_t row = point - surface_.controlPointCount;
        for (std::uint32_t k = surface_.stencils.offsets[row]; k < surface_.stencils.offsets[row + 1]; ++k)
            addPoint(surface_.stencils.indices[k], face, points);
        return rowSpreads_[row];
    }

    const Surface& surface_;
    std::vector<std::uint32_t> seenBy_; ///< the latest face that has each point of the cage and each shared one
    std::vector<float> rowSpreads_;
};

} // namespace

FaceSupports::FaceSupports(const Surface& surface) {
    SupportBuilder builder(surface);
    firsts_.push_back(0);
    for (std::uint32_t face = 0; face < surface.faces.size(); ++face) {
        spreads_.push_back(builder.addFace(face, points_));
        firsts_.push_back(std::uint32_t(points_.size()));
    }
}

/// A point sum_i w_i p_i with sum_i w_i = 1 is at most sum_i |w_i| half boxes away from the middle of the box of all
/// p_i.
std::vector<Bounds> FaceSupports::bounds(std::span<const vec3> cagePositions,
                                         std::span<const float> heightBounds) const {
    std::vector<Bounds> all(spreads_.size());
    for (std::size_t face = 0; face < all.size(); ++face) {
        if (firsts_[face] == firsts_[face + 1]) continue;
        Bounds hull;
        for (std::uint32_t k = firsts_[face]; k < firsts_[face + 1]; ++k) hull.add(dvec3(cagePositions[points_[k]]));
        const dvec3 half = 0.5 * (hull.upper - hull.lower) * double(spreads_[face]) + double(heightBounds[face]);
        all[face].add(hull.center() - half);
        all[face].add(hull.center() + half);
    }
    return all;
}

} // namespace relief
