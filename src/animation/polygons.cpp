// Normals of plain polygons that move: caches and skins have none, so they are turned with the faces around them.
#include <cmath>
#include <unordered_map>

#include "animation/animation.h"

namespace relief {
namespace {

/// Two sides of a face at a corner, and the unit normal between them; zero where they are parallel.
struct CornerFrame {
    dvec3 a, b, area, normal;

    CornerFrame(const dvec3& before, const dvec3& corner, const dvec3& next)
        : a(next - corner), b(before - corner), area(glm::cross(a, b)), normal(0) {
        if (glm::dot(area, area) > 0) normal = glm::normalize(area);
    }
};

/// A normal under the map F that takes the sides at rest to those of the pose and the unit normal to t times its own,
/// t the square root of the growth of the area: F^-T n, which keeps the product of n with each side. Rotations and
/// scalings come out exactly. Zero where one of the two has no area.
dvec3 turned(const dvec3& n, const CornerFrame& rest, const CornerFrame& posed) {
    const double restArea = glm::length(rest.area), posedArea = glm::length(posed.area);
    if (!(restArea > 0) || !(posedArea > 0)) return dvec3(0);
    const dvec3 alongA = glm::cross(posed.b, posed.normal) / posedArea;
    const dvec3 alongB = glm::cross(posed.normal, posed.a) / posedArea;
    const dvec3 sum = glm::dot(n, rest.a) * alongA + glm::dot(n, rest.b) * alongB +
                      glm::dot(n, rest.normal) * std::sqrt(restArea / posedArea) * posed.normal;
    const double length = glm::length(sum);
    return length > 0 ? sum / length : dvec3(0);
}

} // namespace

void turnNormals(Cage& cage, std::span<const vec3> restPositions) {
    if (cage.normalCorners.empty()) return;
    // A normal that faces share at a point stays shared; where they share it at several points, each has its own.
    std::unordered_map<std::uint64_t, std::uint32_t> numbers; // by point and normal
    std::vector<dvec3> sums;
    std::vector<vec3> given;
    std::size_t first = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        for (std::uint32_t i = 0; i < size; ++i) {
            const std::size_t corner = first + i;
            const std::uint32_t before = cage.corners[first + (i + size - 1) % size], point = cage.corners[corner],
                                next = cage.corners[first + (i + 1) % size];
            std::uint32_t& normal = cage.normalCorners[corner];
            const auto [number, isNew] =
                numbers.try_emplace(std::uint64_t(point) << 32 | normal, std::uint32_t(sums.size()));
            if (isNew) sums.emplace_back(0), given.push_back(cage.normals[normal]);
            normal = number->second;
            const auto frame = [&](const auto& p) { return CornerFrame(p[before], p[point], p[next]); };
            const CornerFrame posed = frame(cage.positions);
            sums[normal] += glm::length(posed.area) * turned(given[normal], frame(restPositions), posed);
        }
        first += size;
    }
    // Where all faces have collapsed, the given ones are as good as any.
    for (std::size_t i = 0; i < sums.size(); ++i)
        if (glm::dot(sums[i], sums[i]) > 0) given[i] = glm::normalize(sums[i]);
    cage.normals = std::move(given);
}

} // namespace relief
