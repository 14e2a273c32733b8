// What the vertices of a triangle mesh carry for fragments that bend normals.
#include <cmath>

#include "model/model.h"

namespace relief {
namespace {

/// grad s = (p_t x n) / (n . (p_s x p_t)), grad t = (n x p_s) / (n . (p_s x p_t))
std::pair<vec3, vec3> gradientsOf(const vec3& normal, const vec3& ps, const vec3& pt) {
    const float length = glm::length(normal);
    const vec3 n = length > 0 ? normal / length : vec3(0); // without a direction there are no gradients
    const float area = glm::dot(n, glm::cross(ps, pt)), factor = area != 0 ? 1 / area : 0;
    return {factor * glm::cross(pt, n), factor * glm::cross(n, ps)};
}

/// Two edges of a triangle and its unit normal.
glm::dmat3 frameOf(const dvec3& a, const dvec3& b, const dvec3& c) {
    const dvec3 across = glm::cross(b - a, c - a);
    const double area = glm::length(across);
    return {b - a, c - a, area > 0 ? across / area : dvec3(0)};
}

/// The gradient of rest positions along a mesh, per vertex: the mean over its triangles, by their angles, of what takes
/// edges to edges at rest and normals to normals. 0 where no triangle has an area.
std::vector<mat3> computeRestGradients(const DenseMesh& mesh, std::span<const vec3> restPositions) {
    std::vector<glm::dmat3> sums(mesh.positions.size(), glm::dmat3(0));
    std::vector<double> weights(mesh.positions.size(), 0);
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const std::uint32_t* corners = &mesh.indices[i];
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = corners[k], b = corners[(k + 1) % 3], c = corners[(k + 2) % 3];
            const glm::dmat3 now = frameOf(mesh.positions[a], mesh.positions[b], mesh.positions[c]);
            const glm::dmat3 rest = frameOf(restPositions[a], restPositions[b], restPositions[c]);
            const double angle = std::atan2(glm::length(glm::cross(now[0], now[1])), glm::dot(now[0], now[1]));
            if (!(glm::determinant(now) > 0)) continue;
            sums[a] += angle * (rest * glm::inverse(now));
            weights[a] += angle;
        }
    }
    std::vector<mat3> gradients;
    gradients.reserve(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i)
        gradients.emplace_back(weights[i] > 0 ? mat3(sums[i] / weights[i]) : mat3(0));
    return gradients;
}

} // namespace

std::vector<vec4> toTexGradients(const DenseMesh& mesh, const Tangents* tangents, std::span<const vec3> restPositions) {
    const std::size_t count = mesh.positions.size();
    std::vector<mat3> restGradients;
    if (!restPositions.empty()) {
        RELIEF_CHECK(restPositions.size() == count);
        restGradients = computeRestGradients(mesh, restPositions);
    }
    if (tangents != nullptr) RELIEF_CHECK(tangents->ps.size() == count);
    std::vector<vec4> texels;
    texels.reserve((restPositions.empty() ? kGradientTexels : kRestGradientTexels) * count);
    for (std::size_t i = 0; i < count; ++i) {
        std::pair<vec3, vec3> gradients{vec3(0), vec3(0)};
        if (tangents != nullptr) gradients = gradientsOf(mesh.normals[i], tangents->ps[i], tangents->pt[i]);
        texels.emplace_back(gradients.first, 0.0f);
        texels.emplace_back(gradients.second, 0.0f);
        if (restGradients.empty()) continue;
        for (int column = 0; column < 3; ++column)
            texels.emplace_back(restGradients[i][column], restPositions[i][column]);
    }
    return texels;
}

} // namespace relief
