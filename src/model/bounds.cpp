#include "model/bounds.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

constexpr int kBlock = 8; ///< texels a side of the smallest squares

Range joined(const Range& a, const Range& b) {
    return {std::min(a.lowest, b.lowest), std::max(a.highest, b.highest), std::max(a.slopeS, b.slopeS),
            std::max(a.slopeT, b.slopeT)};
}

/// Where control points of one patch lie, in as many dimensions as needed.
template <typename V>
struct Box {
    V lower{1e30f}, upper{-1e30f};

    void add(const V& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
    void add(const Box& box) { lower = glm::min(lower, box.lower), upper = glm::max(upper, box.upper); }
    [[nodiscard]] bool isEmpty() const { return lower.x > upper.x; }
};

/// The hull's box. Beyond a boundary a phantom point 2 a - b takes part, which is never farther than the box is large.
template <typename V>
Box<V> patchBox(std::span<const std::uint32_t> indices, std::span<const V> points, std::uint32_t param1) {
    Box<V> box;
    for (const std::uint32_t index : indices) box.add(points[index]);
    const bool isBoundary = ((param1 >> 7) & 31u) != 0;
    const V phantom = isBoundary ? box.upper - box.lower : V(0);
    return {box.lower - phantom, box.upper + phantom};
}

} // namespace

HeightPyramid::HeightPyramid(const HeightMap& map, float roundOff)
    : size_(map.width, map.height), roundOff_(roundOff), wrap_(map.wrap), mid_(map.mid), scale_(map.scale) {
    Level base{(map.width + kBlock - 1) / kBlock, (map.height + kBlock - 1) / kBlock, {}};
    base.blocks.assign(std::size_t(base.width) * std::size_t(base.height), {INFINITY, -INFINITY, 0, 0});
    const auto texelAt = [&](int x, int y) {
        return map.texels[std::size_t(y) * std::size_t(map.width) + std::size_t(x)];
    };
    // The texel after the last one: the first again, or itself.
    const auto next = [&](int i, int count) { return i + 1 < count ? i + 1 : map.wrap == Wrap::repeat ? 0 : i; };
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const float texel = texelAt(x, y);
            Range& block = base.blocks[std::size_t(y / kBlock) * std::size_t(base.width) + std::size_t(x / kBlock)];
            block = joined(block, {texel, texel, std::abs(texelAt(next(x, map.width), y) - texel),
                                   std::abs(texelAt(x, next(y, map.height)) - texel)});
        }
    levels_.push_back(std::move(base));
    while (levels_.back().blocks.size() > 1) {
        const Level& fine = levels_.back();
        Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
        coarse.blocks.assign(std::size_t(coarse.width) * std::size_t(coarse.height), {INFINITY, -INFINITY, 0, 0});
        for (int y = 0; y < fine.height; ++y)
            for (int x = 0; x < fine.width; ++x) {
                Range& block = coarse.blocks[std::size_t(y / 2) * std::size_t(coarse.width) + std::size_t(x / 2)];
                block = joined(block, fine.blocks[std::size_t(y) * std::size_t(fine.width) + std::size_t(x)]);
            }
        levels_.push_back(std::move(coarse));
    }
}

Range HeightPyramid::heights(const Range& stored) const {
    const auto a = float(scale_ * (double(stored.lowest) - double(roundOff_) - mid_)),
               b = float(scale_ * (double(stored.highest) + double(roundOff_) - mid_));
    // Two texels of a mip lie twice as far apart or more: what both are off counts once here.
    const dvec2 slope = std::abs(scale_) * dvec2(size_) * (dvec2(stored.slopeS, stored.slopeT) + double(roundOff_));
    return {std::min(a, b), std::max(a, b), float(slope.x), float(slope.y)};
}

Range HeightPyramid::blocksIn(std::size_t number, const ivec2& first, const ivec2& last) const {
    const Level& level = levels_[number];
    const auto wrapped = [&](int i, int count) {
        return wrap_ == Wrap::repeat ? ((i % count) + count) % count : std::clamp(i, 0, count - 1);
    };
    Range range{INFINITY, -INFINITY, 0, 0};
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x)
            range = joined(range, level.blocks[std::size_t(wrapped(y, level.height)) * std::size_t(level.width) +
                                               std::size_t(wrapped(x, level.width))]);
    return range;
}

Range HeightPyramid::range(const vec2& lower, const vec2& upper) const {
    if (levels_.empty()) return {};
    const Range all = heights(levels_.back().blocks.front());
    // Lookups read up to two texels beyond the one that they fall in; t points up, rows go down.
    const dvec2 low = dvec2(lower.x, 1 - upper.y) * dvec2(size_) - 3.0;
    const dvec2 high = dvec2(upper.x, 1 - lower.y) * dvec2(size_) + 3.0;
    if (!(high.x - low.x < size_.x && high.y - low.y < size_.y)) return all; // all of it, or not finite
    // Where blocks stick out of a repeating map their grid does not repeat with it.
    const bool isInside = low.x >= 0 && low.y >= 0 && high.x < size_.x && high.y < size_.y;
    if (wrap_ == Wrap::repeat && !isInside && (size_.x % kBlock != 0 || size_.y % kBlock != 0)) return all;
    ivec2 first(glm::floor(low / double(kBlock))), last(glm::floor(high / double(kBlock)));
    std::size_t level = 0;
    // Coarser grids repeat with the map while their width is even; else the level stays.
    while (std::max(last.x - first.x, last.y - first.y) > 2 && level + 1 < levels_.size() &&
           (isInside || (levels_[level].width % 2 == 0 && levels_[level].height % 2 == 0))) {
        first = ivec2(glm::floor(dvec2(first) / 2.0)), last = ivec2(glm::floor(dvec2(last) / 2.0));
        ++level;
    }
    return heights(blocksIn(level, first, last));
}

std::vector<float> faceHeightBounds(const Surface& surface, const HeightMap* map, const HeightPyramid& pyramid) {
    std::vector<float> heightBounds(surface.faces.size(), 0);
    if (map == nullptr) return heightBounds;
    for (std::size_t f = 0; f < heightBounds.size(); ++f) {
        Box<vec2> texture;
        if (!surface.hasTexCoords()) texture = {vec2(0), vec2(1)}; // every face takes the whole map
        for (const TreeLeaf& leaf : leavesOf(surface.tree, surface.faces[f].root)) {
            if (!surface.hasTexCoords()) continue;
            const Patch& patch = surface.patches[leaf.patchIndex];
            const auto indices =
                std::span(surface.texPatchPoints).subspan(patch.texFirstPoint, patchSize(patch.texType));
            texture.add(patchBox<vec2>(indices, surface.texPoints, patch.texParam1));
        }
        if (texture.isEmpty()) continue;
        const Range range = pyramid.range(texture.lower, texture.upper);
        heightBounds[f] = std::max(std::abs(range.lowest), std::abs(range.highest));
    }
    return heightBounds;
}

std::vector<Bounds> faceBounds(const Surface& surface, std::span<const vec3> points,
                               std::span<const float> heightBounds) {
    std::vector<Bounds> bounds(surface.faces.size());
    for (std::size_t f = 0; f < bounds.size(); ++f) {
        Box<vec3> box;
        for (const TreeLeaf& leaf : leavesOf(surface.tree, surface.faces[f].root)) {
            const Patch& patch = surface.patches[leaf.patchIndex];
            box.add(patchBox<vec3>(std::span(surface.patchPoints).subspan(patch.firstPoint, patchSize(patch.type)),
                                   points, patch.param1));
        }
        if (box.isEmpty()) continue;
        bounds[f].add(dvec3(box.lower) - double(heightBounds[f]));
        bounds[f].add(dvec3(box.upper) + double(heightBounds[f]));
    }
    return bounds;
}

namespace {

/// Control points of a bicubic patch by row and column; first and second differences are those of its derivatives.
template <typename V>
struct ControlPoints {
    V points[4][4];

    [[nodiscard]] V du(int row, int column) const { return points[row][column + 1] - points[row][column]; }
    [[nodiscard]] V dv(int row, int column) const { return points[row + 1][column] - points[row][column]; }
};

template <typename V, typename P>
ControlPoints<V> controlPoints(std::span<const std::uint32_t> indices, std::span<const P> points) {
    ControlPoints<V> control;
    for (std::size_t i = 0; i < 16; ++i) control.points[i / 4][i % 4] = V(points[indices[i]]);
    return control;
}

/// Longest vectors of each kind over a control.
struct Lengths {
    double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
};

Lengths lengthsOf(const ControlPoints<dvec3>& control) {
    Lengths l;
    const auto grow = [](double& most, const dvec3& x) { most = std::max(most, glm::length(x)); };
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
            if (column < 3) grow(l.u, control.du(row, column));
            if (row < 3) grow(l.v, control.dv(row, column));
            if (column < 2) grow(l.uu, control.du(row, column + 1) - control.du(row, column));
            if (row < 2) grow(l.vv, control.dv(row + 1, column) - control.dv(row, column));
            if (column < 3 && row < 3) grow(l.uv, control.du(row + 1, column) - control.du(row, column));
        }
    return l;
}

/// Most that s and t change along u and along v.
struct TextureSlopes {
    double su = 1, sv = 0, tu = 0, tv = 1; ///< of a face's own (u,v)
};

TextureSlopes slopesOf(const ControlPoints<dvec2>& control) {
    TextureSlopes most{0, 0, 0, 0};
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 3; ++column) {
            const dvec2 u = glm::abs(control.du(row, column)), v = glm::abs(control.dv(column, row));
            most.su = std::max(most.su, u.x), most.tu = std::max(most.tu, u.y);
            most.sv = std::max(most.sv, v.x), most.tv = std::max(most.tv, v.y);
        }
    return most;
}

/// p_u x p_v is a convex combination of the products of all differences along u with all along v.
std::vector<dvec3> areaVectors(const ControlPoints<dvec3>& control) {
    std::vector<dvec3> vectors;
    vectors.reserve(144);
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j) vectors.push_back(glm::cross(control.du(i / 3, i % 3), control.dv(j % 3, j / 3)));
    return vectors;
}

/// Of the vectors, and of all that are no farther than `ball` from them.
NormalBounds boundsOf(const std::vector<dvec3>& vectors, double ball) {
    NormalBounds bounds;
    for (const dvec3& v : vectors) bounds.axis += v;
    const double length = glm::length(bounds.axis);
    if (!(length > 0)) return {};
    bounds.axis /= length;
    bounds.along = 1e300;
    for (const dvec3& v : vectors) {
        const double along = glm::dot(v, bounds.axis);
        bounds.along = std::min(bounds.along, along);
        bounds.across = std::max(bounds.across, glm::length(v - along * bounds.axis));
    }
    bounds.along = std::max(bounds.along - ball, 0.0);
    bounds.across += ball;
    return bounds;
}

/// How far displacement moves q_u x q_v from p_u x p_v: q_u = p_u + h_u n + h n_u, where |n_u| is at most
/// (|p_uu||p_v| + |p_u||p_uv|) / |p_u x p_v|.
double displacementBall(const Lengths& l, double leastArea, const Range& heights, const TextureSlopes& texture) {
    if (!(leastArea > 0)) return INFINITY;
    const double reach = std::max(std::abs(double(heights.lowest)), std::abs(double(heights.highest)));
    const double ru =
        heights.slopeS * texture.su + heights.slopeT * texture.tu + reach * (l.uu * l.v + l.u * l.uv) / leastArea;
    const double rv =
        heights.slopeS * texture.sv + heights.slopeT * texture.tv + reach * (l.uv * l.v + l.u * l.vv) / leastArea;
    return l.u * rv + l.v * ru + ru * rv;
}

/// Bicubic, and no phantom points beyond a boundary.
bool isPlain(std::uint32_t type, std::uint32_t param1) { return type == kPatchRegular && ((param1 >> 7) & 31u) == 0; }

NormalBounds boundsOfPatch(const Surface& surface, const Patch& patch, std::span<const vec3> points,
                           const HeightPyramid* pyramid) {
    if (!isPlain(patch.type, patch.param1)) return {};
    const auto control = controlPoints<dvec3>(std::span(surface.patchPoints).subspan(patch.firstPoint, 16), points);
    const std::vector<dvec3> vectors = areaVectors(control);
    if (pyramid == nullptr) return boundsOf(vectors, 0);
    TextureSlopes texture;
    Box<vec2> box{vec2(0), vec2(1)};
    if (surface.hasTexCoords()) {
        if (!isPlain(patch.texType, patch.texParam1)) return {};
        const auto indices = std::span(surface.texPatchPoints).subspan(patch.texFirstPoint, 16);
        const std::span<const vec2> texPoints = surface.texPoints;
        box = patchBox<vec2>(indices, texPoints, patch.texParam1);
        texture = slopesOf(controlPoints<dvec2>(indices, texPoints));
    }
    const Range heights = pyramid->range(box.lower, box.upper);
    return boundsOf(vectors, displacementBall(lengthsOf(control), boundsOf(vectors, 0).along, heights, texture));
}

} // namespace

std::vector<NormalBounds> normalBounds(const Surface& surface, std::span<const vec3> points,
                                       const HeightPyramid* pyramid) {
    std::vector<NormalBounds> bounds;
    for (const Face& face : surface.faces) {
        const bool isOnePatch = face.root != kNoPatch && (face.root & kLeafBit) != 0;
        bounds.push_back(isOnePatch ? boundsOfPatch(surface, surface.patches[face.root & ~kLeafBit], points, pyramid)
                                    : NormalBounds{});
    }
    return bounds;
}

} // namespace relief
