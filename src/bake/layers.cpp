#include "bake/layers.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/unique_points.h"

namespace relief {
namespace {

/// The weights of a triangle's corners at a point of its plane.
dvec3 cornerWeights(const dvec3 (&corners)[3], const dvec3& q) {
    const dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double square = glm::dot(normal, normal);
    const auto part = [&](int i, int j) {
        return glm::dot(glm::cross(corners[i] - q, corners[j] - q), normal) / square;
    };
    const dvec3 weights = glm::max(dvec3(part(1, 2), part(2, 0), part(0, 1)), dvec3(0));
    return weights / (weights.x + weights.y + weights.z);
}

/// A normal along p_s made perpendicular to n, the side of p_t, and n (src/README.md, "Normal maps").
dvec3 toTangentSpace(const LimitFrame& frame, const dmat2& jacobian, const dvec3& n, const dvec3& normal) {
    const double determinant = glm::determinant(jacobian);
    if (!(std::abs(determinant) > 1e-14)) return {0, 0, 1};
    const dvec3 ps = (frame.pu * jacobian[1].y - frame.pv * jacobian[0].y) / determinant,
                pt = (frame.pv * jacobian[0].x - frame.pu * jacobian[1].x) / determinant;
    const dvec3 flat = ps - glm::dot(ps, n) * n;
    if (!(glm::length(flat) > 0)) return {0, 0, 1};
    const dvec3 tangent = glm::normalize(flat), across = glm::cross(n, tangent);
    const double side = glm::dot(across, pt) < 0 ? -1 : 1;
    return {glm::dot(normal, tangent), side * glm::dot(normal, across), glm::dot(normal, n)};
}

/// Two vectors perpendicular to a unit vector and to each other (Duff et al. 2017, "Building an orthonormal basis").
std::pair<dvec3, dvec3> basisOf(const dvec3& n) {
    const double sign = std::copysign(1.0, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    return {{1 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

} // namespace

SculptDetail computeSculptDetail(const TriangleView& triangles, Facing facing) {
    // Vertices at one position are one point, so that split vertices leave no seam. Normals are weighed by area.
    const UniquePoints unique = findUniquePoints(triangles.positions);
    std::vector<dvec3> sums(unique.count(), dvec3(0));
    const auto pointOf = [&](std::size_t i) { return unique.indices[triangles.indices[i]]; };
    const auto at = [&](std::uint32_t point) { return dvec3(triangles.positions[unique.firsts[point]]); };
    const double sign = facing == Facing::back ? -1 : 1;
    for (std::size_t i = 0; i + 2 < triangles.indices.size(); i += 3) {
        const dvec3 a = at(pointOf(i)), area = sign * glm::cross(at(pointOf(i + 1)) - a, at(pointOf(i + 2)) - a);
        for (std::size_t k = 0; k < 3; ++k) sums[pointOf(i + k)] += area;
    }
    for (dvec3& sum : sums) sum = glm::length(sum) > 0 ? glm::normalize(sum) : dvec3(0, 0, 1);

    // Each edge is met once per triangle, which is as good as once for a mean.
    std::vector<dvec2> bends(unique.count(), dvec2(0));
    for (std::size_t i = 0; i < triangles.indices.size(); ++i) {
        const std::uint32_t a = pointOf(i), b = pointOf(i % 3 == 2 ? i - 2 : i + 1);
        const dvec3 step = at(b) - at(a);
        const double square = glm::dot(step, step);
        if (!(square > 0)) continue;
        const dvec2 bend(glm::dot(sums[b] - sums[a], step) / square, 1);
        bends[a] += bend, bends[b] += bend;
    }
    SculptDetail detail;
    for (const std::uint32_t point : unique.indices) {
        detail.normals.emplace_back(sums[point]);
        detail.curvatures.push_back(bends[point].y > 0 ? float(bends[point].x / bends[point].y) : 0);
    }
    return detail;
}

int LayerSampler::channelCount() const {
    int count = 0;
    for (const SculptLayer layer : options_.layers) count += channelsOf(layer);
    return count;
}

/// Directions by the cosine of their angle, of the R2 sequence from a start that differs from sample to sample.
double LayerSampler::openShare(const dvec3& q, const dvec3& normal, std::uint32_t seed) const {
    constexpr double kPlastic = 1.32471795724474602596;
    const auto [along, across] = basisOf(normal);
    const std::uint32_t mixed = (seed * 2654435761u) ^ (seed >> 15) * 2246822519u;
    const dvec2 start(double(mixed & 0xffffu) / 65536, double(mixed >> 16) / 65536);
    int openCount = 0;
    for (int i = 0; i < options_.occlusionLines; ++i) {
        const dvec2 point = glm::fract(start + double(i + 1) * dvec2(1 / kPlastic, 1 / (kPlastic * kPlastic)));
        const double angle = 2 * std::numbers::pi * point.x, radius = std::sqrt(point.y);
        const dvec3 direction = radius * (std::cos(angle) * along + std::sin(angle) * across) +
                                std::sqrt(std::max(0.0, 1 - point.y)) * normal;
        openCount += sculpt_.isBlocked(q, direction, options_.occlusionReach) ? 0 : 1;
    }
    return double(openCount) / options_.occlusionLines;
}

void LayerSampler::evaluate(const TexelSample& sample, const LimitFrame& frame, const dvec3& normal, const LineHit& hit,
                            std::span<double> channels) const {
    const dvec3 q = frame.p + hit.height * normal;
    dvec3 sculptNormal = normal;
    double curvature = 0;
    if (options_.detail != nullptr) {
        const TriangleView triangles = sculpt_.triangles();
        const std::uint32_t* corner = &triangles.indices[3 * std::size_t(hit.triangle)];
        const dvec3 corners[] = {triangles.positions[corner[0]], triangles.positions[corner[1]],
                                 triangles.positions[corner[2]]};
        const dvec3 weights = cornerWeights(corners, q);
        sculptNormal = dvec3(0);
        for (int k = 0; k < 3; ++k) {
            sculptNormal += weights[k] * dvec3(options_.detail->normals[corner[k]]);
            curvature += weights[k] * double(options_.detail->curvatures[corner[k]]);
        }
        sculptNormal = glm::length(sculptNormal) > 0 ? glm::normalize(sculptNormal) : normal;
    }
    std::size_t next = 0;
    const auto put = [&](const dvec3& value) {
        for (int k = 0; k < 3; ++k) channels[next++] = value[k];
    };
    for (const SculptLayer layer : options_.layers) switch (layer) {
        case SculptLayer::tangentNormal:
            put(toTangentSpace(frame, surface_.texture(sample.face, dvec2(sample.uv)).jacobian, normal, sculptNormal));
            break;
        case SculptLayer::objectNormal: put(sculptNormal); break;
        case SculptLayer::position: put(q); break;
        case SculptLayer::vector: put(hit.height * normal); break;
        case SculptLayer::occlusion: channels[next++] = openShare(q, sculptNormal, sample.texel); break;
        case SculptLayer::curvature: channels[next++] = curvature; break;
        }
}

} // namespace relief
