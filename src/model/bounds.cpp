#include "model/bounds.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

constexpr int kBlock = 8; ///< texels a side of the smallest squares

Range joined(const Range& a, const Range& b) { return {std::min(a.lowest, b.lowest), std::max(a.highest, b.highest)}; }

/// Where control points of one patch lie, in as many dimensions as needed.
template <typename V>
struct Box {
    V lower{1e30f}, upper{-1e30f};

    void add(const V& p) { lower = glm::min(lower, p), upper = glm::max(upper, p); }
    void add(const Box& box) { lower = glm::min(lower, box.lower), upper = glm::max(upper, box.upper); }
    [[nodiscard]] bool isEmpty() const { return lower.x > upper.x; }
};

std::uint32_t pointCount(std::uint32_t type) {
    switch (type) {
    case kPatchRegular: return 16;
    case kPatchGregory: return 20;
    case kPatchQuads: return 4;
    case kPatchLoop: return 12;
    case kPatchGregoryTriangle: return 18;
    default: return 3;
    }
}

/// The hull's box. Beyond a boundary a phantom point 2 a - b takes part, which is never farther than the box is large.
template <typename V>
Box<V> patchBox(std::span<const std::uint32_t> indices, std::span<const V> points, std::uint32_t param1) {
    Box<V> box;
    for (const std::uint32_t index : indices) box.add(points[index]);
    const bool isBoundary = ((param1 >> 7) & 31u) != 0;
    const V phantom = isBoundary ? box.upper - box.lower : V(0);
    return {box.lower - phantom, box.upper + phantom};
}

void addLeaves(const Surface& surface, std::uint32_t entry, std::vector<std::uint32_t>& leaves) {
    if (entry == kNoPatch) return;
    if ((entry & kLeafBit) != 0) {
        leaves.push_back(entry & ~kLeafBit);
        return;
    }
    for (std::uint32_t child = 0; child < 4; ++child) addLeaves(surface, surface.tree[entry + child], leaves);
}

} // namespace

HeightPyramid::HeightPyramid(const HeightMap& map)
    : size_(map.width, map.height), wrap_(map.wrap), mid_(map.mid), scale_(map.scale) {
    Level base{(map.width + kBlock - 1) / kBlock, (map.height + kBlock - 1) / kBlock, {}};
    base.blocks.assign(std::size_t(base.width) * std::size_t(base.height), {INFINITY, -INFINITY});
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const float texel = map.texels[std::size_t(y) * std::size_t(map.width) + std::size_t(x)];
            Range& block = base.blocks[std::size_t(y / kBlock) * std::size_t(base.width) + std::size_t(x / kBlock)];
            block = joined(block, {texel, texel});
        }
    levels_.push_back(std::move(base));
    while (levels_.back().blocks.size() > 1) {
        const Level& fine = levels_.back();
        Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
        coarse.blocks.assign(std::size_t(coarse.width) * std::size_t(coarse.height), {INFINITY, -INFINITY});
        for (int y = 0; y < fine.height; ++y)
            for (int x = 0; x < fine.width; ++x) {
                Range& block = coarse.blocks[std::size_t(y / 2) * std::size_t(coarse.width) + std::size_t(x / 2)];
                block = joined(block, fine.blocks[std::size_t(y) * std::size_t(fine.width) + std::size_t(x)]);
            }
        levels_.push_back(std::move(coarse));
    }
}

Range HeightPyramid::heights(const Range& stored) const {
    const auto a = float(scale_ * (double(stored.lowest) - mid_)), b = float(scale_ * (double(stored.highest) - mid_));
    return {std::min(a, b), std::max(a, b)};
}

Range HeightPyramid::blocksIn(std::size_t number, const ivec2& first, const ivec2& last) const {
    const Level& level = levels_[number];
    const auto wrapped = [&](int i, int count) {
        return wrap_ == Wrap::repeat ? ((i % count) + count) % count : std::clamp(i, 0, count - 1);
    };
    Range range{INFINITY, -INFINITY};
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

std::vector<Bounds> faceBounds(const Surface& surface, std::span<const vec3> points, const HeightMap* map,
                               const HeightPyramid& pyramid) {
    std::vector<Bounds> bounds(surface.faces.size());
    std::vector<std::uint32_t> leaves;
    for (std::size_t f = 0; f < bounds.size(); ++f) {
        leaves.clear();
        addLeaves(surface, surface.faces[f].root, leaves);
        Box<vec3> box;
        Box<vec2> texture;
        for (const std::uint32_t leaf : leaves) {
            const Patch& patch = surface.patches[leaf];
            box.add(patchBox<vec3>(std::span(surface.patchPoints).subspan(patch.firstPoint, pointCount(patch.type)),
                                   points, patch.param1));
            if (!surface.hasTexCoords()) continue;
            const auto indices =
                std::span(surface.texPatchPoints).subspan(patch.texFirstPoint, pointCount(patch.texType));
            texture.add(patchBox<vec2>(indices, surface.texPoints, patch.texParam1));
        }
        if (box.isEmpty()) continue;
        float reach = 0;
        if (map != nullptr) {
            if (!surface.hasTexCoords()) texture = {vec2(0), vec2(1)}; // every face takes the whole map
            const Range range = pyramid.range(texture.lower, texture.upper);
            reach = std::max(std::abs(range.lowest), std::abs(range.highest));
        }
        bounds[f].add(dvec3(box.lower) - double(reach));
        bounds[f].add(dvec3(box.upper) + double(reach));
    }
    return bounds;
}

} // namespace relief
