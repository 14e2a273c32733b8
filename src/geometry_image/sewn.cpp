// Geometry images as meshes: the grid's triangles, with one vertex for the samples that are sewn.
#include <algorithm>
#include <array>
#include <numeric>

#include "geometry_image/grid.h"

namespace relief {
namespace {

/// A directed edge as one number.
std::uint64_t keyOfEdge(std::uint32_t from, std::uint32_t to) { return (std::uint64_t(from) << 32) | to; }

/// Which samples are one vertex: a tree per vertex, whose root is the first of its samples.
class Sewer {
public:
    Sewer(const Sewing& sewing, int size) : parents_(std::size_t(size) * std::size_t(size)) {
        std::iota(parents_.begin(), parents_.end(), 0u);
        const int scale = (size - 1) / sewing.sideSegments;
        std::vector<int> firsts;
        int at = sewing.first;
        for (const Sewing::Path& path : sewing.paths) firsts.push_back(scale * at), at += path.segments;
        for (std::size_t p = 0; p < sewing.paths.size(); ++p) {
            const auto mate = std::size_t(sewing.paths[p].mate);
            if (mate <= p) continue;
            const int count = scale * sewing.paths[p].segments;
            for (int k = 0; k <= count; ++k)
                join(borderSample(firsts[p] + k, size), borderSample(firsts[mate] + count - k, size));
        }
    }
    std::uint32_t rootOf(std::size_t sample) {
        auto root = std::uint32_t(sample);
        while (parents_[root] != root) root = parents_[root] = parents_[parents_[root]];
        return root;
    }

private:
    void join(std::size_t a, std::size_t b) {
        const std::uint32_t first = rootOf(a), second = rootOf(b);
        parents_[std::max(first, second)] = std::min(first, second);
    }
    std::vector<std::uint32_t> parents_;
};

/// A sample of a quad, in double precision.
struct QuadCorner {
    dvec3 position, normal;
};

/// The smallest cosine between the normal of a triangle and those of its corners.
double worstCosine(const QuadCorner& a, const QuadCorner& b, const QuadCorner& c) {
    const dvec3 normal = glm::cross(b.position - a.position, c.position - a.position);
    const double length = glm::length(normal);
    if (!(length > 0)) return -1;
    return std::min({glm::dot(normal, a.normal), glm::dot(normal, b.normal), glm::dot(normal, c.normal)}) / length;
}

/// Whether a quad is cut from its upper left to its lower right corner: along the shorter diagonal, unless its
/// triangles face away from the normals and those of the other do not, as where the grid is sheared on a bent surface.
bool cutsFalling(const QuadCorner& topLeft, const QuadCorner& topRight, const QuadCorner& bottomLeft,
                 const QuadCorner& bottomRight) {
    const dvec3 falling = bottomRight.position - topLeft.position, rising = topRight.position - bottomLeft.position;
    const bool isShorter = glm::dot(falling, falling) <= glm::dot(rising, rising);
    const double withFalling =
        std::min(worstCosine(topLeft, bottomLeft, bottomRight), worstCosine(topLeft, bottomRight, topRight));
    const double withRising =
        std::min(worstCosine(bottomLeft, bottomRight, topRight), worstCosine(bottomLeft, topRight, topLeft));
    constexpr double kGood = 0.9;
    return std::min(withFalling, withRising) > kGood ? isShorter : withFalling >= withRising;
}

/// Chooses the diagonals of a grid, at the border one that no other edge equals.
class Diagonals {
public:
    Diagonals(const GeometryImage& image, const SewnGrid& grid, int size)
        : grid_(grid), size_(std::size_t(size)), falls_((size_ - 1) * (size_ - 1)) {
        for (std::size_t j = 0; j + 1 < size_; ++j)
            for (std::size_t i = 0; i + 1 < size_; ++i) {
                const auto at = [&](std::size_t x, std::size_t y) {
                    const std::uint32_t sample = grid.samples[grid.vertices[(j + y) * size_ + i + x]];
                    return QuadCorner{dvec3(image.positions[sample]), dvec3(image.normals[sample])};
                };
                falls_[j * (size_ - 1) + i] = char(cutsFalling(at(0, 0), at(1, 0), at(0, 1), at(1, 1)));
            }
    }

    /// Turns diagonals at the border that join a vertex to itself or are edges already.
    void avoidDoubles() {
        constexpr int kRounds = 6;
        for (int round = 0; round < kRounds; ++round) {
            const std::vector<std::uint64_t> doubles = listDoubles();
            if (doubles.empty()) return;
            bool isTurned = false;
            for (std::size_t quad = 0; quad < falls_.size(); ++quad) {
                if (!isAtBorder(quad)) continue;
                const auto [a, b] = diagonalOf(quad, falls_[quad] != 0);
                const auto [c, d] = diagonalOf(quad, falls_[quad] == 0);
                const auto isDouble = [&](std::uint32_t x, std::uint32_t y) {
                    return x == y || std::ranges::binary_search(doubles, keyOfEdge(std::min(x, y), std::max(x, y)));
                };
                if (!isDouble(a, b) || c == d) continue;
                falls_[quad] = char(falls_[quad] == 0);
                isTurned = true;
            }
            if (!isTurned) return;
        }
    }

    [[nodiscard]] std::vector<std::uint32_t> listCorners() const {
        std::vector<std::uint32_t> corners;
        corners.reserve(6 * falls_.size());
        for (std::size_t quad = 0; quad < falls_.size(); ++quad) {
            const std::array<std::uint32_t, 6> own = cornersOf(quad);
            corners.insert(corners.end(), own.begin(), own.end());
        }
        return corners;
    }

private:
    /// The samples at the corners of the two triangles of a quad.
    [[nodiscard]] std::array<std::uint32_t, 6> cornersOf(std::size_t quad) const {
        const auto topLeft = std::uint32_t(quad / (size_ - 1) * size_ + quad % (size_ - 1));
        const std::uint32_t topRight = topLeft + 1, bottomLeft = topLeft + std::uint32_t(size_),
                            bottomRight = bottomLeft + 1;
        if (falls_[quad] != 0) return {topLeft, bottomLeft, bottomRight, topLeft, bottomRight, topRight};
        return {bottomLeft, bottomRight, topRight, bottomLeft, topRight, topLeft};
    }
    [[nodiscard]] bool isAtBorder(std::size_t quad) const {
        const std::size_t n = size_ - 1, i = quad % n, j = quad / n;
        return i == 0 || j == 0 || i + 1 == n || j + 1 == n;
    }
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> diagonalOf(std::size_t quad, bool falls) const {
        const std::size_t topLeft = quad / (size_ - 1) * size_ + quad % (size_ - 1);
        if (falls) return {grid_.vertices[topLeft], grid_.vertices[topLeft + size_ + 1]};
        return {grid_.vertices[topLeft + 1], grid_.vertices[topLeft + size_]};
    }
    /// The edges that run more than once in one direction, each from its lower vertex to the other, sorted.
    [[nodiscard]] std::vector<std::uint64_t> listDoubles() const {
        // Those of the quads at the border: others cannot be double.
        std::vector<std::uint64_t> edges, doubles;
        for (std::size_t quad = 0; quad < falls_.size(); ++quad) {
            if (!isAtBorder(quad)) continue;
            const std::array<std::uint32_t, 6> corners = cornersOf(quad);
            for (std::size_t h = 0; h < corners.size(); ++h)
                edges.push_back(
                    keyOfEdge(grid_.vertices[corners[h]], grid_.vertices[corners[h % 3 == 2 ? h - 2 : h + 1]]));
        }
        std::ranges::sort(edges);
        for (std::size_t i = 1; i < edges.size(); ++i) {
            const auto from = std::uint32_t(edges[i] >> 32), to = std::uint32_t(edges[i]);
            if (edges[i] == edges[i - 1]) doubles.push_back(keyOfEdge(std::min(from, to), std::max(from, to)));
        }
        for (const std::uint64_t edge : edges)
            if (std::uint32_t(edge >> 32) == std::uint32_t(edge)) doubles.push_back(edge);
        std::ranges::sort(doubles);
        return doubles;
    }

    const SewnGrid& grid_;
    std::size_t size_;
    std::vector<char> falls_; ///< per quad: its diagonal runs from the upper left to the lower right
};

} // namespace

int GeometryImage::mipCount() const {
    int count = 1;
    for (int side = size - 1; side > sewing.sideSegments && side % 2 == 0; side /= 2) ++count;
    return count;
}

SewnGrid sewGrid(const GeometryImage& image, int mip) {
    if (mip < 0 || mip >= image.mipCount())
        fail(Failure::usage, "the geometry image has the mips 0 to {}, not {}", image.mipCount() - 1, mip);
    const int size = image.sizeAt(mip);
    const std::size_t n = std::size_t(size), step = std::size_t(1) << mip;
    Sewer sewer(image.sewing, size);
    SewnGrid grid;
    grid.vertices.resize(n * n);
    for (std::size_t sample = 0; sample < n * n; ++sample) {
        const std::uint32_t root = sewer.rootOf(sample);
        if (root == sample) {
            grid.vertices[sample] = std::uint32_t(grid.samples.size());
            grid.samples.push_back(std::uint32_t(sample / n * step * std::size_t(image.size) + sample % n * step));
        } else {
            grid.vertices[sample] = grid.vertices[root]; // roots come first
        }
    }
    Diagonals diagonals(image, grid, size);
    diagonals.avoidDoubles();
    grid.corners = diagonals.listCorners();
    return grid;
}

DenseMesh toMesh(const GeometryImage& image, int mip) {
    const SewnGrid grid = sewGrid(image, mip);
    DenseMesh mesh{.coordinates = image.coordinates};
    for (const std::uint32_t sample : grid.samples) {
        mesh.positions.push_back(image.positions[sample]);
        mesh.normals.push_back(image.normals[sample]);
    }
    mesh.indices.reserve(grid.corners.size());
    for (const std::uint32_t corner : grid.corners) mesh.indices.push_back(grid.vertices[corner]);
    return mesh;
}

MeshFaults findFaults(std::span<const std::uint32_t> indices) {
    MeshFaults faults;
    // Edges by their lower vertex, then the higher one, then the direction.
    std::vector<std::uint64_t> edges;
    edges.reserve(indices.size());
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
        const std::uint32_t a = indices[i], b = indices[i + 1], c = indices[i + 2];
        if (a == b || b == c || c == a) ++faults.degenerateTriangles;
        for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)})
            edges.push_back(2 * keyOfEdge(std::min(from, to), std::max(from, to)) + std::uint64_t(from > to));
    }
    std::ranges::sort(edges);
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        for (end = i; end < edges.size() && edges[end] / 2 == edges[i] / 2;) ++end;
        if (end - i == 1)
            ++faults.openEdges;
        else if (end - i > 2 || edges[i] == edges[i + 1])
            ++faults.otherEdges;
    }
    return faults;
}

std::uint64_t countTurned(const DenseMesh& mesh) {
    std::uint64_t count = 0;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto at = [&](std::size_t k) { return dvec3(mesh.positions[mesh.indices[i + k]]); };
        dvec3 normal(0);
        for (std::size_t k = 0; k < 3; ++k) normal += dvec3(mesh.normals[mesh.indices[i + k]]);
        if (glm::dot(glm::cross(at(1) - at(0), at(2) - at(0)), normal) < 0) ++count;
    }
    return count;
}

} // namespace relief
