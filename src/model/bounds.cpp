#include "model/bounds.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

constexpr int kBlock = 8; ///< texels per side of the smallest squares

/// A box around the control points of one patch, in two or three dimensions.
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

void HeightPyramid::Block::add(const Block& block) {
    lowest = std::min(lowest, block.lowest), highest = std::max(highest, block.highest);
    stepS = std::max(stepS, block.stepS), stepT = std::max(stepT, block.stepT);
}

HeightPyramid::HeightPyramid(const HeightMap& map, float roundOff)
    : size_(map.width, map.height), roundOff_(roundOff), wrap_(map.wrap), mid_(map.mid), scale_(map.scale) {
    Level base{(map.width + kBlock - 1) / kBlock, (map.height + kBlock - 1) / kBlock, {}};
    base.blocks.resize(std::size_t(base.width) * std::size_t(base.height));
    const auto texelAt = [&](int x, int y) {
        return map.texels[std::size_t(y) * std::size_t(map.width) + std::size_t(x)];
    };
    // The texel after the last one: the first again, or itself.
    const auto next = [&](int i, int count) { return i + 1 < count ? i + 1 : map.wrap == Wrap::repeat ? 0 : i; };
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const float texel = texelAt(x, y);
            base.blocks[std::size_t(y / kBlock) * std::size_t(base.width) + std::size_t(x / kBlock)].add(
                {texel, texel, std::abs(texelAt(next(x, map.width), y) - texel),
                 std::abs(texelAt(x, next(y, map.height)) - texel)});
        }
    // Squares of two by two blocks, up to a single one.
    levels_.push_back(std::move(base));
    while (levels_.back().blocks.size() > 1) {
        const Level& fine = levels_.back();
        Level coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}};
        coarse.blocks.resize(std::size_t(coarse.width) * std::size_t(coarse.height));
        for (int y = 0; y < fine.height; ++y)
            for (int x = 0; x < fine.width; ++x)
                coarse.blocks[std::size_t(y / 2) * std::size_t(coarse.width) + std::size_t(x / 2)].add(
                    fine.blocks[std::size_t(y) * std::size_t(fine.width) + std::size_t(x)]);
        levels_.push_back(std::move(coarse));
    }
}

Range HeightPyramid::heights(const Block& stored, const dvec2& stepFactor) const {
    const auto a = float(scale_ * (double(stored.lowest) - double(roundOff_) - mid_)),
               b = float(scale_ * (double(stored.highest) + double(roundOff_) - mid_));
    // Two texels of a mip lie twice as far apart or more: what both are off counts once here.
    const dvec2 steps = stepFactor * dvec2(stored.stepS, stored.stepT) + double(roundOff_);
    const dvec2 slope = std::abs(scale_) * dvec2(size_) * steps;
    return {std::min(a, b), std::max(a, b), float(slope.x), float(slope.y)};
}

HeightPyramid::Block HeightPyramid::blocksIn(std::size_t number, const ivec2& first, const ivec2& last) const {
    const Level& level = levels_[number];
    const auto wrapped = [&](int i, int count) {
        return wrap_ == Wrap::repeat ? ((i % count) + count) % count : std::clamp(i, 0, count - 1);
    };
    Block all;
    for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x)
            all.add(level.blocks[std::size_t(wrapped(y, level.height)) * std::size_t(level.width) +
                                 std::size_t(wrapped(x, level.width))]);
    return all;
}

Range HeightPyramid::range(const TexBox& box, int level) const {
    if (levels_.empty()) return {};
    // A texel of the mip level is the mean of `side` x `side` texels. Where these do not divide the map, `rest` columns
    // and rows take no part, and what the level shows is shifted by up to as much.
    const int side = 1 << std::clamp(level, 0, int(kMostMapLevels) - 1);
    const dvec2 rest(size_ % side);
    // Neighbours on the level lie `side` texels apart, where it repeats also `rest` more.
    const dvec2 stepFactor = 1.0 + rest / double(side);
    const Range all = heights(levels_.back().blocks.front(), stepFactor);

    // Lookups read up to two texels beyond the one that they fall in; t points up, rows go down.
    dvec2 low = dvec2(box.lower.x, 1 - box.upper.y) * dvec2(size_);
    dvec2 high = dvec2(box.upper.x, 1 - box.lower.y) * dvec2(size_);
    if (wrap_ == Wrap::clamp && level > 0)
        low = glm::clamp(low, dvec2(0), dvec2(size_)), high = glm::clamp(high, dvec2(0), dvec2(size_));
    const dvec2 margin = 3.0 * side + rest;
    low -= margin, high += margin;
    if (!(high.x - low.x < size_.x && high.y - low.y < size_.y)) return all; // all of it, or not finite

    // Where blocks stick out of a repeating map their grid does not repeat with it.
    const bool isInside = low.x >= 0 && low.y >= 0 && high.x < size_.x && high.y < size_.y;
    if (wrap_ == Wrap::repeat && !isInside && (size_.x % kBlock != 0 || size_.y % kBlock != 0)) return all;

    // The finest level of the pyramid of which three by three blocks are enough. Coarser grids repeat with the map
    // while their width is even; else the level stays.
    ivec2 first(glm::floor(low / double(kBlock))), last(glm::floor(high / double(kBlock)));
    std::size_t number = 0;
    while (std::max(last.x - first.x, last.y - first.y) > 2 && number + 1 < levels_.size() &&
           (isInside || (levels_[number].width % 2 == 0 && levels_[number].height % 2 == 0))) {
        first = ivec2(glm::floor(dvec2(first) / 2.0)), last = ivec2(glm::floor(dvec2(last) / 2.0));
        ++number;
    }
    return heights(blocksIn(number, first, last), stepFactor);
}

std::vector<TexBox> faceTexBoxes(const Surface& surface) {
    std::vector<TexBox> boxes;
    boxes.reserve(surface.faces.size());
    for (const Face& face : surface.faces) {
        Box<vec2> box;
        if (!surface.hasTexCoords() && face.root != kNoPatch) box = {vec2(0), vec2(1)};
        for (const TreeLeaf& leaf : leavesOf(surface.tree, face.root)) {
            if (!surface.hasTexCoords()) break;
            const Patch& patch = surface.patches[leaf.patchIndex];
            const auto indices =
                std::span(surface.texPatchPoints).subspan(patch.texFirstPoint, patch.texPointCount);
            box.add(patchBox<vec2>(indices, surface.texPoints, patch.texParam1));
        }
        boxes.push_back({box.lower, box.upper});
    }
    return boxes;
}

float heightBound(const HeightPyramid& pyramid, const TexBox& box, int level) {
    if (box.isEmpty()) return 0;
    const Range range = pyramid.range(box, level);
    return std::max(std::abs(range.lowest), std::abs(range.highest));
}

std::vector<float> faceHeightBounds(const HeightPyramid& pyramid, std::span<const TexBox> boxes) {
    std::vector<float> bounds;
    bounds.reserve(boxes.size());
    for (const TexBox& box : boxes) bounds.push_back(heightBound(pyramid, box));
    return bounds;
}

std::vector<Bounds> faceBounds(const Surface& surface, std::span<const vec3> points,
                               std::span<const float> heightBounds) {
    RELIEF_CHECK(heightBounds.size() == surface.faces.size());
    std::vector<Bounds> bounds(surface.faces.size());
    for (std::size_t f = 0; f < bounds.size(); ++f) {
        Box<vec3> box;
        for (const TreeLeaf& leaf : leavesOf(surface.tree, surface.faces[f].root)) {
            const Patch& patch = surface.patches[leaf.patchIndex];
            box.add(patchBox<vec3>(std::span(surface.patchPoints).subspan(patch.firstPoint, patch.pointCount),
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

/// The longest derivatives of a patch.
void addLengths(FaceNormals& face, const ControlPoints<dvec3>& control) {
    const auto grow = [](double& most, const dvec3& x) { most = std::max(most, glm::length(x)); };
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 4; ++column) {
            if (column < 3) grow(face.u, control.du(row, column));
            if (row < 3) grow(face.v, control.dv(row, column));
            if (column < 2) grow(face.uu, control.du(row, column + 1) - control.du(row, column));
            if (row < 2) grow(face.vv, control.dv(row + 1, column) - control.dv(row, column));
            if (column < 3 && row < 3) grow(face.uv, control.du(row + 1, column) - control.du(row, column));
        }
}

/// The steepest derivatives of a patch of texture coordinates.
void addTextureSlopes(FaceNormals& face, const ControlPoints<dvec2>& control) {
    face.su = face.sv = face.tu = face.tv = 0;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 3; ++column) {
            const dvec2 u = glm::abs(control.du(row, column)), v = glm::abs(control.dv(column, row));
            face.su = std::max(face.su, u.x), face.tu = std::max(face.tu, u.y);
            face.sv = std::max(face.sv, v.x), face.tv = std::max(face.tv, v.y);
        }
}

/// p_u x p_v is a convex combination of the products of all differences along u with all along v.
std::vector<dvec3> areaVectors(const ControlPoints<dvec3>& control) {
    std::vector<dvec3> vectors;
    vectors.reserve(144);
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j) vectors.push_back(glm::cross(control.du(i / 3, i % 3), control.dv(j % 3, j / 3)));
    return vectors;
}

/// Bounds of vectors: along their mean direction, and across it.
NormalBounds boundsOf(const std::vector<dvec3>& vectors) {
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
    bounds.along = std::max(bounds.along, 0.0);
    return bounds;
}

/// How far displacement moves q_u x q_v from p_u x p_v: q_u = p_u + h_u n + h n_u, where |n_u| is at most
/// (|p_uu||p_v| + |p_u||p_uv|) / |p_u x p_v|.
double displacementBall(const FaceNormals& f, const Range& heights) {
    const double leastArea = f.limit.along;
    if (!(leastArea > 0)) return INFINITY;
    const double h = std::max(std::abs(double(heights.lowest)), std::abs(double(heights.highest)));
    const double ru = heights.slopeS * f.su + heights.slopeT * f.tu + h * (f.uu * f.v + f.u * f.uv) / leastArea;
    const double rv = heights.slopeS * f.sv + heights.slopeT * f.tv + h * (f.uv * f.v + f.u * f.vv) / leastArea;
    return f.u * rv + f.v * ru + ru * rv;
}

/// Bicubic, and no phantom points beyond a boundary.
bool isPlain(std::uint32_t type, std::uint32_t param1) { return type == kPatchRegular && ((param1 >> 7) & 31u) == 0; }

FaceNormals normalsOfPatch(const Surface& surface, const Patch& patch, std::span<const vec3> points) {
    if (!isPlain(patch.type, patch.param1)) return {};
    FaceNormals face;
    const auto control = controlPoints<dvec3>(std::span(surface.patchPoints).subspan(patch.firstPoint, 16), points);
    face.limit = boundsOf(areaVectors(control));
    addLengths(face, control);
    if (!surface.hasTexCoords()) return face;
    face.hasTextureSlopes = isPlain(patch.texType, patch.texParam1);
    if (face.hasTextureSlopes)
        addTextureSlopes(face, controlPoints<dvec2>(std::span(surface.texPatchPoints).subspan(patch.texFirstPoint, 16),
                                                    std::span<const vec2>(surface.texPoints)));
    return face;
}

} // namespace

std::vector<FaceNormals> faceNormals(const Surface& surface, std::span<const vec3> points) {
    std::vector<FaceNormals> normals;
    normals.reserve(surface.faces.size());
    for (const Face& face : surface.faces) {
        const bool isOnePatch = face.root != kNoPatch && (face.root & kLeafBit) != 0;
        normals.push_back(isOnePatch ? normalsOfPatch(surface, surface.patches[face.root & ~kLeafBit], points)
                                     : FaceNormals{});
    }
    return normals;
}

NormalBounds displacedNormals(const FaceNormals& face, const Range& heights) {
    if (!face.hasTextureSlopes) return {};
    const double ball = displacementBall(face, heights);
    return {face.limit.axis, std::max(face.limit.along - ball, 0.0), face.limit.across + ball};
}

std::vector<NormalBounds> normalBounds(std::span<const FaceNormals> faces, std::span<const TexBox> boxes,
                                       const HeightPyramid& pyramid) {
    RELIEF_CHECK(faces.size() == boxes.size());
    std::vector<NormalBounds> bounds;
    bounds.reserve(faces.size());
    for (std::size_t f = 0; f < faces.size(); ++f)
        bounds.push_back(pyramid.isEmpty() ? faces[f].limit : displacedNormals(faces[f], pyramid.range(boxes[f])));
    return bounds;
}

} // namespace relief
