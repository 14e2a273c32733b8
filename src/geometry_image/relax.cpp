// Moving the points inside of a spread disk one by one, to where the triangles around them are stretched least.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry_image/spread.h"

namespace relief {
namespace {

/// A triangle around a point p1 that moves: area * (|S_s|^2 + |S_t|^2), which is area * N / D^2 with
///   N = |v|^2 |Q1|^2 + |u|^2 |Q2|^2 - 2 (u . v) (Q1 . Q2),  D = u x v,
/// u = p2 - p1, v = p3 - p1 in the plane and Q1, Q2 the same on the surface.
struct StarTriangle {
    dvec2 p2, p3;
    double q1q1 = 0, q2q2 = 0, q1q2 = 0, area = 0;

    /// Infinite where the triangle is turned over.
    [[nodiscard]] double energyAt(const dvec2& p1, dvec2* gradient = nullptr) const {
        const dvec2 u = p2 - p1, v = p3 - p1;
        const double d = u.x * v.y - u.y * v.x;
        if (!(d > 0)) return std::numeric_limits<double>::infinity();
        const double n = glm::dot(v, v) * q1q1 + glm::dot(u, u) * q2q2 - 2 * glm::dot(u, v) * q1q2;
        if (gradient != nullptr) {
            const dvec2 dn = -2.0 * q1q1 * v - 2.0 * q2q2 * u + 2.0 * q1q2 * (u + v), dd(u.y - v.y, v.x - u.x);
            *gradient += area * (dn / (d * d) - 2 * n / (d * d * d) * dd);
        }
        return area * n / (d * d);
    }
};

double energyOf(std::span<const StarTriangle> star, const dvec2& p, dvec2* gradient = nullptr) {
    double sum = 0;
    for (const StarTriangle& triangle : star) sum += triangle.energyAt(p, gradient);
    return sum;
}

/// Moves a point against the gradient, as far as that makes its energy smaller.
dvec2 descend(std::span<const StarTriangle> star, const dvec2& p) {
    dvec2 gradient(0);
    const double energy = energyOf(star, p, &gradient);
    const double slope = glm::length(gradient);
    if (!std::isfinite(energy) || !(slope > 0) || !std::isfinite(slope)) return p;
    double reach = 0;
    for (const StarTriangle& triangle : star) reach = std::max(reach, glm::length(triangle.p2 - p));
    constexpr int kHalvings = 10;
    double step = 0.5 * reach;
    for (int i = 0; i < kHalvings; ++i, step /= 2) {
        const dvec2 moved = p - step / slope * gradient;
        if (energyOf(star, moved) < energy) return moved;
    }
    return p;
}

} // namespace

void relaxInside(const CutMesh& mesh, const Disk& disk, std::vector<dvec2>& st, int sweeps) {
    std::vector<StarTriangle> star;
    for (int sweep = 0; sweep < sweeps; ++sweep)
        for (std::uint32_t i = 0; i < disk.vertexCount(); ++i) {
            const std::uint32_t v = sweep % 2 == 0 ? i : disk.vertexCount() - 1 - i; // there and back
            if (disk.isOnBorder[v] != 0) continue;
            star.clear();
            for (const std::uint32_t h : disk.edgesFrom(v)) {
                const std::uint32_t second = nextOf(h), third = previousOf(h);
                const dvec3& q = mesh.positions[mesh.corners[h]];
                const dvec3 q1 = mesh.positions[mesh.corners[second]] - q, q2 = mesh.positions[mesh.corners[third]] - q;
                star.push_back({.p2 = st[disk.corners[second]],
                                .p3 = st[disk.corners[third]],
                                .q1q1 = glm::dot(q1, q1),
                                .q2q2 = glm::dot(q2, q2),
                                .q1q2 = glm::dot(q1, q2),
                                .area = glm::length(glm::cross(q1, q2))});
            }
            st[v] = descend(star, st[v]);
        }
}

} // namespace relief
