// Smoothing the paths of a cut without leaving the surface.
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry_image/cut.h"

namespace relief {
namespace {

/// The point of a triangle that is nearest to p, as weights of its corners (Ericson 2005, section 5.1.5).
dvec3 nearestWeights(const dvec3& p, const dvec3& a, const dvec3& b, const dvec3& c) {
    const dvec3 ab = b - a, ac = c - a, ap = p - a, bp = p - b, cp = p - c;
    const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
    if (d1 <= 0 && d2 <= 0) return {1, 0, 0};
    const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
    if (d3 >= 0 && d4 <= d3) return {0, 1, 0};
    const double vc = d1 * d4 - d3 * d2;
    if (vc <= 0 && d1 >= 0 && d3 <= 0) return {1 - d1 / (d1 - d3), d1 / (d1 - d3), 0};
    const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
    if (d6 >= 0 && d5 <= d6) return {0, 0, 1};
    const double vb = d5 * d2 - d1 * d6;
    if (vb <= 0 && d2 >= 0 && d6 <= 0) return {1 - d2 / (d2 - d6), 0, d2 / (d2 - d6)};
    const double va = d3 * d6 - d5 * d4;
    if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
        const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return {0, 1 - w, w};
    }
    return dvec3(va, vb, vc) / (va + vb + vc);
}

dvec3 normalOf(const CutMesh& mesh, std::uint32_t h) {
    const dvec3& p = mesh.positions[mesh.from(h)];
    return glm::cross(mesh.positions[mesh.to(h)] - p, mesh.positions[mesh.from(previousOf(h))] - p);
}

/// The half-edges that start at a vertex which no boundary meets; empty where one does.
std::vector<std::uint32_t> listStar(const CutMesh& mesh, std::uint32_t h) {
    std::vector<std::uint32_t> star;
    std::uint32_t at = h;
    do {
        star.push_back(at);
        at = mesh.twins[previousOf(at)];
        if (at == kNone) return {};
    } while (at != h);
    return star;
}

/// Moves a vertex towards a point, to the nearest point of the triangles around it. Not where these are not nearly in
/// one plane, before it and after it.
void slideVertex(CutMesh& mesh, std::span<const std::uint32_t> star, const dvec3& target) {
    constexpr double kFlat = 0.94; // cosine of 20 degrees
    const std::uint32_t v = mesh.from(star.front());
    dvec3 normal(0);
    double area = 0;
    for (const std::uint32_t h : star) normal += normalOf(mesh, h);
    for (const std::uint32_t h : star) area += glm::length(normalOf(mesh, h));
    if (!(glm::length(normal) > kFlat * area)) return;
    normal = glm::normalize(normal);
    const auto isFlat = [&] {
        return std::ranges::all_of(star, [&](std::uint32_t h) {
            const dvec3 n = normalOf(mesh, h);
            return glm::dot(n, normal) > kFlat * glm::length(n) && glm::length(n) > 0.02 * area / double(star.size());
        });
    };
    if (!isFlat()) return;
    // The nearest point, and its normal.
    double least = glm::length(target - mesh.positions[v]);
    dvec3 position = mesh.positions[v], interpolated = mesh.normals[v];
    for (const std::uint32_t h : star) {
        const std::array<std::uint32_t, 3> c{v, mesh.to(h), mesh.from(previousOf(h))};
        const dvec3 w = nearestWeights(target, mesh.positions[c[0]], mesh.positions[c[1]], mesh.positions[c[2]]);
        const dvec3 p = w.x * mesh.positions[c[0]] + w.y * mesh.positions[c[1]] + w.z * mesh.positions[c[2]];
        if (glm::length(target - p) >= least) continue;
        least = glm::length(target - p), position = p;
        interpolated = w.x * mesh.normals[c[0]] + w.y * mesh.normals[c[1]] + w.z * mesh.normals[c[2]];
    }
    const dvec3 before = mesh.positions[v];
    mesh.positions[v] = position;
    if (!isFlat())
        mesh.positions[v] = before;
    else if (glm::dot(interpolated, interpolated) > 1e-24)
        mesh.normals[v] = glm::normalize(interpolated);
}

} // namespace

void smoothPaths(CutMesh& mesh) {
    constexpr int kSweeps = 30;
    const std::vector<BorderPath> paths = walkBorder(mesh, cutOpen(mesh));
    for (std::size_t p = 0; p < paths.size(); ++p) {
        if (paths[p].mate <= p) continue;
        const std::vector<std::uint32_t>& edges = paths[p].halfEdges;
        std::vector<std::vector<std::uint32_t>> stars;
        stars.reserve(edges.size());
        for (const std::uint32_t h : edges) stars.push_back(listStar(mesh, h));
        for (int sweep = 0; sweep < kSweeps; ++sweep)
            for (std::size_t i = 1; i < edges.size(); ++i) {
                if (stars[i].empty()) continue;
                const dvec3 middle =
                    0.5 * (mesh.positions[mesh.from(edges[i - 1])] + mesh.positions[mesh.to(edges[i])]);
                slideVertex(mesh, stars[i], middle);
            }
    }
}

} // namespace relief
