// Internal: conservative bounds of displaced faces, from control points and from the smallest and largest heights of
// blocks of the map.
#pragma once

#include <span>
#include <vector>

#include "displacement/displacement.h"
#include "surface/surface.h"

namespace relief {

struct Range {
    float lowest = 0, highest = 0;
    float slopeS = 0,
          slopeT = 0; ///< most that neighbouring texels differ, along rows and down columns; of h by s and t
};

/// Smallest and largest heights of squares of texels, and of squares of those.
class HeightPyramid {
public:
    HeightPyramid() = default;
    /// `roundOff`: how far a mip's texel may be from the mean that it stands for.
    explicit HeightPyramid(const HeightMap& map, float roundOff = 0);

    /// Bounds of h in cage units over a box of texture coordinates, with all texels that its lookups read.
    [[nodiscard]] Range range(const vec2& lower, const vec2& upper) const;

private:
    struct Level {
        int width = 0, height = 0;
        std::vector<Range> blocks; ///< stored values
    };
    [[nodiscard]] Range blocksIn(std::size_t level, const ivec2& first, const ivec2& last) const;
    [[nodiscard]] Range heights(const Range& stored) const;

    ivec2 size_{0};
    float roundOff_ = 0;
    Wrap wrap_ = Wrap::repeat;
    double mid_ = 0, scale_ = 1;
    std::vector<Level> levels_; ///< the last one is a single block
};

/// The largest |h| on each face; 0 for holes and without a map.
std::vector<float> faceHeightBounds(const Surface& surface, const HeightMap* map, const HeightPyramid& pyramid);

/// A box around each displaced face (empty for holes): the patches lie in the hull of their control points.
std::vector<Bounds> faceBounds(const Surface& surface, std::span<const vec3> points,
                               std::span<const float> heightBounds);

/// Bounds of the displaced normals m = q_u x q_v of a face, not unit: along `axis` at least `along`, across it at most
/// `across`. A face whose normals are not bounded has along = 0.
struct NormalBounds {
    dvec3 axis{0};
    double along = 0, across = 0;
};

/// For faces of a single bicubic patch without boundary: both tangents are convex combinations of differences of
/// control points, and what displacement adds to them is bounded by heights, their slopes and second differences.
/// `pyramid`: of the height map, or null.
std::vector<NormalBounds> normalBounds(const Surface& surface, std::span<const vec3> points,
                                       const HeightPyramid* pyramid);

} // namespace relief
