#include "geometry_image/grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace relief {
namespace {

/// Where a triangle is met: its first half-edge and the weights of its corners.
struct GridHit {
    std::uint32_t triangle = kNone;
    dvec3 weights{0};
    double inside = -std::numeric_limits<double>::infinity(); ///< the smallest weight
};

/// A triangle of the disk on the grid: columns and rows as numbers.
struct GridTriangle {
    std::array<dvec2, 3> corners;
    double area = 0; ///< twice

    [[nodiscard]] dvec3 weightsAt(const dvec2& p) const {
        const auto cross = [](const dvec2& a, const dvec2& b) { return a.x * b.y - a.y * b.x; };
        const dvec3 parts(cross(corners[1] - p, corners[2] - p), cross(corners[2] - p, corners[0] - p),
                          cross(corners[0] - p, corners[1] - p));
        return parts / area;
    }
};

GridTriangle triangleOn(const Disk& disk, std::span<const dvec2> st, std::uint32_t h, int size) {
    GridTriangle triangle;
    for (std::size_t k = 0; k < 3; ++k) {
        const dvec2& at = st[disk.corners[h + k]];
        triangle.corners[k] = dvec2(at.x, 1 - at.y) * double(size - 1);
    }
    const dvec2 a = triangle.corners[1] - triangle.corners[0], b = triangle.corners[2] - triangle.corners[0];
    triangle.area = a.x * b.y - a.y * b.x;
    return triangle;
}

void take(GridHit& hit, const GridTriangle& triangle, std::uint32_t h, const dvec2& p) {
    const dvec3 weights = triangle.weightsAt(p);
    const double inside = std::min({weights.x, weights.y, weights.z});
    if (inside > hit.inside) hit = {h, weights, inside};
}

/// Between triangles that have shrunk to nothing: the first corner of the one whose first corner is nearest.
GridHit findNearest(const Disk& disk, std::span<const dvec2> st, int size, const dvec2& p) {
    GridHit hit{.weights = {1, 0, 0}};
    double least = std::numeric_limits<double>::infinity();
    for (std::uint32_t h = 0; h < disk.corners.size(); h += 3) {
        const dvec2& at = st[disk.corners[h]];
        const double distance = glm::length(dvec2(at.x, 1 - at.y) * double(size - 1) - p);
        if (distance < least) least = distance, hit.triangle = h;
    }
    return hit;
}

} // namespace

std::vector<SurfaceSample> sampleGrid(const CutMesh& mesh, const Disk& disk, std::span<const dvec2> st, int size) {
    // Of the triangles that cover a sample, rounding included, the one that it lies deepest in.
    const auto n = std::size_t(size);
    std::vector<GridHit> hits(n * n);
    constexpr double kSlack = 1e-6;
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); h += 3) {
        const GridTriangle triangle = triangleOn(disk, st, h, size);
        if (triangle.area == 0) continue;
        const auto [c0, c1, c2] = triangle.corners;
        const dvec2 lower = glm::ceil(glm::min(c0, glm::min(c1, c2)) - kSlack);
        const dvec2 upper = glm::floor(glm::max(c0, glm::max(c1, c2)) + kSlack);
        for (int j = std::max(1, int(lower.y)); j <= std::min(size - 2, int(upper.y)); ++j)
            for (int i = std::max(1, int(lower.x)); i <= std::min(size - 2, int(upper.x)); ++i)
                take(hits[std::size_t(j) * n + std::size_t(i)], triangle, h, dvec2(i, j));
    }
    std::vector<SurfaceSample> samples(n * n);
    for (std::size_t j = 1; j + 1 < n; ++j)
        for (std::size_t i = 1; i + 1 < n; ++i) {
            GridHit& hit = hits[j * n + i];
            if (hit.triangle == kNone) hit = findNearest(disk, st, size, dvec2(i, j));
            const dvec3 weights = glm::max(hit.weights, 0.0);
            const double sum = weights.x + weights.y + weights.z;
            SurfaceSample& sample = samples[j * n + i];
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t v = mesh.corners[hit.triangle + k];
                sample.position += weights[int(k)] / sum * mesh.positions[v];
                sample.normal += weights[int(k)] / sum * mesh.normals[v];
            }
        }
    return samples;
}

} // namespace relief
