#include "bake/face_texels.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

constexpr int kMostLog = 12;

/// One step into a face from a side.
dvec2 stepInside(std::uint32_t side) {
    constexpr double kSteps[4][2] = {{0, 1}, {-1, 0}, {0, -1}, {1, 0}};
    return {kSteps[side][0], kSteps[side][1]};
}

} // namespace

FaceTexels::FaceTexels(const Surface& surface, const ReferenceSurface& reference, FaceTexelOptions options)
    : reference_(reference), options_(std::move(options)), links_(linkFaces(surface)) {
    RELIEF_CHECK(options_.segments.size() == surface.faces.size());
    std::uint64_t count = 0;
    for (std::size_t face = 0; face < options_.segments.size(); ++face) {
        firsts_.push_back(std::uint32_t(count));
        const ivec2 nodes = countOf(face) + 1;
        count += std::uint64_t(nodes.x) * std::uint64_t(nodes.y);
        if (count > 1ull << 31)
            fail(Failure::input, "the first {} of {} faces have {} heights already; 2147483648 can be baked", face + 1,
                 options_.segments.size(), count);
    }
    firsts_.push_back(std::uint32_t(count));
    width_ = int(std::clamp<std::uint64_t>(count, 1, 1024));
    height_ = int((count + std::uint64_t(width_) - 1) / std::uint64_t(width_));
}

ivec2 FaceTexels::countOf(std::size_t face) const {
    return {1 << options_.segments[face].x, 1 << options_.segments[face].y};
}

std::size_t FaceTexels::faceOf(std::uint32_t texel) const {
    return std::size_t(std::ranges::upper_bound(firsts_, texel) - firsts_.begin()) - 1;
}

std::uint32_t FaceTexels::texelAt(int face, const dvec2& uv) const {
    const ivec2 count = countOf(std::size_t(face));
    const ivec2 node = glm::clamp(ivec2(glm::round(uv * dvec2(count))), ivec2(0), count);
    return firsts_[std::size_t(face)] + std::uint32_t(node.y * (count.x + 1) + node.x);
}

void FaceTexels::listSamples(int first, int count, std::vector<TexelSample>& samples) const {
    const auto begin = std::uint64_t(first) * std::uint64_t(width_);
    const auto end = std::min<std::uint64_t>(begin + std::uint64_t(count) * std::uint64_t(width_), firsts_.back());
    if (begin >= end) return;
    std::size_t face = faceOf(std::uint32_t(begin));
    for (auto texel = std::uint32_t(begin); texel < end; ++texel) {
        while (texel >= firsts_[face + 1]) ++face;
        if (reference_.isHole(int(face))) continue;
        const int across = countOf(face).x + 1, index = int(texel - firsts_[face]);
        addNode(int(face), {index % across, index / across}, texel, samples);
    }
}

void FaceTexels::addNode(int face, const ivec2& node, std::uint32_t texel, std::vector<TexelSample>& samples) const {
    const ivec2 count = countOf(std::size_t(face));
    // A sculpt may end where the surface does: beside a boundary samples lie a little inside.
    constexpr double kBesideBorder = 1e-4;
    const auto borderOf = [&](std::size_t side) {
        return links_.links[8 * std::size_t(face) + 2 * side].face == kNoPatch ? kBesideBorder : 0.0;
    };
    const dvec2 low(borderOf(3), borderOf(0)), high(1 - borderOf(1), 1 - borderOf(2));
    const auto samplesAlong = [&](int axis) {
        return node[axis] == 0 || node[axis] == count[axis] ? 1 : options_.samplesPerSide;
    };
    const ivec2 grid(samplesAlong(0), samplesAlong(1));
    for (int y = 0; y < grid.y; ++y)
        for (int x = 0; x < grid.x; ++x) {
            const dvec2 off = (dvec2(x, y) + 0.5) / dvec2(grid) - 0.5;
            const dvec2 uv = (dvec2(node) + off) / dvec2(count);
            samples.push_back({.texel = texel, .face = face, .uv = vec2(glm::clamp(uv, low, high))});
        }
}

TexelNeighbours FaceTexels::neighboursOf(std::uint32_t texel) const {
    TexelNeighbours neighbours;
    if (texel >= firsts_.back()) return neighbours;
    // Nodes are counted through all faces, row by row.
    const std::size_t face = faceOf(texel);
    const ivec2 count = countOf(face);
    const int across = count.x + 1, index = int(texel - firsts_[face]), i = index % across, j = index / across;
    const dvec2 uv = dvec2(i, j) / dvec2(count);
    // Below, right, above, left: in the face, or across the side 0 to 3 whose direction is counterclockwise.
    if (j > 0)
        neighbours.add(texel - std::uint32_t(across));
    else
        addAcross(face, 0, uv.x, neighbours);
    if (i < count.x)
        neighbours.add(texel + 1);
    else
        addAcross(face, 1, uv.y, neighbours);
    if (j < count.y)
        neighbours.add(texel + std::uint32_t(across));
    else
        addAcross(face, 2, 1 - uv.x, neighbours);
    if (i > 0)
        neighbours.add(texel - 1);
    else
        addAcross(face, 3, 1 - uv.y, neighbours);
    return neighbours;
}

/// The node of the face across a side, one row behind it.
void FaceTexels::addAcross(std::size_t face, int side, double x, TexelNeighbours& neighbours) const {
    for (std::size_t k = 0; k < 2; ++k) {
        const FaceLink& link = links_.links[8 * face + 2 * std::size_t(side) + k];
        if (link.face == kNoPatch) continue;
        const double low = std::min(link.ownStart, link.ownEnd), high = std::max(link.ownStart, link.ownEnd);
        if (x < low || x > high) continue;
        const double t = (x - double(link.ownStart)) / (double(link.ownEnd) - double(link.ownStart));
        const ivec2 count = countOf(link.face);
        const double depth = 1.0 / (link.side % 2 == 0 ? count.y : count.x);
        const dvec2 uv = sidePoint(4, int(link.side), std::lerp(double(link.start), double(link.end), t)) +
                         depth * stepInside(link.side);
        return neighbours.add(texelAt(int(link.face), uv));
    }
}

std::vector<ivec2> chooseSegments(const ReferenceSurface& reference, double length) {
    constexpr int kSteps = 8;
    std::vector<ivec2> segments(std::size_t(reference.faceCount()), ivec2(0));
    for (int face = 0; face < reference.faceCount(); ++face) {
        if (reference.isHole(face)) continue;
        dvec2 lengths(0); // along u and v, means of three lines
        for (int line = 0; line <= 2; ++line)
            for (int axis = 0; axis < 2; ++axis)
                for (int k = 0; k < kSteps; ++k) {
                    const auto at = [&](int i) {
                        const double x = double(i) / kSteps, y = 0.5 * line;
                        return reference.limit(face, axis == 0 ? dvec2(x, y) : dvec2(y, x)).p;
                    };
                    lengths[axis] += glm::distance(at(k), at(k + 1)) / 3;
                }
        const dvec2 counts = glm::max(lengths / length, dvec2(1));
        segments[std::size_t(face)] = ivec2(glm::clamp(glm::round(glm::log2(counts)), 0.0, double(kMostLog)));
    }
    return segments;
}

double computeArea(const ReferenceSurface& reference) {
    constexpr int kSteps = 4;
    double area = 0;
    for (int face = 0; face < reference.faceCount(); ++face)
        for (int i = 0; i < kSteps * kSteps && !reference.isHole(face); ++i) {
            const dvec2 uv = (dvec2(i % kSteps, i / kSteps) + 0.5) / double(kSteps);
            area += glm::length(reference.areaNormal(face, uv)) / (kSteps * kSteps);
        }
    return area;
}

} // namespace relief
