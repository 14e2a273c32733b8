// For other modules: conservative bounds of displaced faces, from control points and from the smallest and largest
// heights of blocks of the map.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "displacement/displacement.h"
#include "surface/surface.h"

namespace relief {

// --- heights ------------------------------------------------------------------------------------------------------

/// Bounds of h over a part of the map.
struct Range {
    float lowest = 0, highest = 0; ///< of h, cage units
    float slopeS = 0, slopeT = 0;  ///< largest |h_s| and |h_t|
};

/// A box of texture coordinates; empty (lower > upper) by default.
struct TexBox {
    vec2 lower{1e30f}, upper{-1e30f};
    std::uint32_t face = 0; ///< that it lies on, which maps per face go by

    [[nodiscard]] bool isEmpty() const { return lower.x > upper.x; }
};

/// Smallest and largest texels of squares of a map, and of squares of those; of sets, of each tile.
class HeightPyramid {
public:
    HeightPyramid() = default;
    /// `roundOff`: how far a mip's texel may be from the mean that it stands for.
    explicit HeightPyramid(const HeightMap& map, float roundOff = 0);

    [[nodiscard]] bool isEmpty() const { return levels_.empty() && tiles_.empty() && faces_.empty(); }

    /// Bounds of what lookups in the mip levels 0..level find in a box of texture coordinates. A lookup reads texels
    /// beyond the box: up to three texels of the level on each side. All 0 for an empty pyramid.
    [[nodiscard]] Range range(const TexBox& box, int level = 0) const;

private:
    /// Stored values: the smallest, the largest, and the largest difference of neighbours along rows and columns.
    struct Block {
        float lowest = INFINITY, highest = -INFINITY;
        float stepS = 0, stepT = 0;

        void add(const Block& block);
    };
    struct Level {
        int width = 0, height = 0;
        std::vector<Block> blocks;
    };
    void addTiles(const HeightMap& map);
    void addFaces(const HeightMap& map);
    [[nodiscard]] Range rangeOfTiles(const TexBox& box, int level) const;
    [[nodiscard]] Block blocksIn(std::size_t level, const ivec2& first, const ivec2& last) const;
    [[nodiscard]] Range heights(const Block& stored, const dvec2& stepFactor) const;

    ivec2 size_{0};
    float roundOff_ = 0;
    Wrap wrap_ = Wrap::repeat;
    double mid_ = 0, scale_ = 1;
    std::vector<Level> levels_; ///< the last one is a single block

    struct Tile;
    std::vector<std::shared_ptr<const Tile>> tiles_; ///< over unit squares
    std::vector<Range> faces_;                       ///< of maps per face, on all of their levels
};

/// A box around the texture coordinates of each face; empty for holes. Without texture coordinates each face takes the
/// whole map.
std::vector<TexBox> faceTexBoxes(const Surface& surface);

/// The largest |h| that lookups in the mip levels 0..level find on a face; 0 for an empty box or pyramid.
float heightBound(const HeightPyramid& pyramid, const TexBox& box, int level = 0);
std::vector<float> faceHeightBounds(const HeightPyramid& pyramid, std::span<const TexBox> boxes);

// --- positions ----------------------------------------------------------------------------------------------------

/// A box around each displaced face (empty for holes): the patches lie in the hull of their control points.
std::vector<Bounds> faceBounds(const Surface& surface, std::span<const vec3> points,
                               std::span<const float> heightBounds);

// --- normals ------------------------------------------------------------------------------------------------------

/// Bounds of the normals m = q_u x q_v of a face, not unit: along `axis` at least `along`, across it at most `across`.
/// A face whose normals are not bounded has along = 0.
struct NormalBounds {
    dvec3 axis{0};
    double along = 0, across = 0;
};

/// Bounds of the limit surface of a face, and what decides how far displacement turns its normals.
struct FaceNormals {
    NormalBounds limit;
    double u = 0, v = 0, uu = 0, uv = 0, vv = 0; ///< longest p_u, p_v, p_uu, p_uv and p_vv
    double su = 1, sv = 0, tu = 0, tv = 1;       ///< largest |s_u|, |s_v|, |t_u| and |t_v|
    bool hasTextureSlopes = true;                ///< else these are not known, and no displaced normal is bounded
};

/// Bounds the derivatives of faces that are one bicubic patch without boundary: their tangents are convex combinations
/// of differences of control points. Other faces are not bounded.
std::vector<FaceNormals> faceNormals(const Surface& surface, std::span<const vec3> points);

/// Makes heights a function of the face's own (u,v).
void goByFace(FaceNormals& face);

/// Bounds of the normals that displacement by such heights leaves.
NormalBounds displacedNormals(const FaceNormals& face, const Range& heights);

/// Bounds the displaced normals of all faces for lookups in level 0; the limit normals where the pyramid is empty.
std::vector<NormalBounds> normalBounds(std::span<const FaceNormals> faces, std::span<const TexBox> boxes,
                                       const HeightPyramid& pyramid);

} // namespace relief
