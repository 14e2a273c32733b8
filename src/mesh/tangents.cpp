// Tangents of triangle meshes from texture coordinates (Lengyel 2001; Hart, "3D graphics", eq. 16.12 and 16.13, whose
// printed form exchanges s and t).
#include <algorithm>
#include <cmath>
#include <limits>

#include "mesh/mesh.h"

namespace relief {

namespace {

constexpr double kRounding = 4 * std::numeric_limits<float>::epsilon();
constexpr std::uint32_t kNone = ~0u;

/// The corners of one triangle, in double precision.
struct Corners {
    dvec3 p[3];
    dvec2 st[3];
};

Corners cornersOf(const DenseMesh& mesh, std::size_t triangle) {
    Corners corners;
    for (int k = 0; k < 3; ++k) {
        const std::uint32_t vertex = mesh.indices[3 * triangle + std::size_t(k)];
        corners.p[k] = dvec3(mesh.positions[vertex]);
        corners.st[k] = dvec2(mesh.texCoords[vertex]);
    }
    return corners;
}

/// Twice the signed area in the texture; 0 where it is no more than what rounding of the coordinates makes.
double texAreaOf(const Corners& c) {
    const dvec2 d1 = c.st[1] - c.st[0], d2 = c.st[2] - c.st[0];
    const double area = d1.x * d2.y - d2.x * d1.y;
    double largest = 0;
    for (const dvec2& st : c.st) largest = std::max({largest, std::abs(st.x), std::abs(st.y)});
    const double error = kRounding * largest * (glm::length(d1) + glm::length(d2));
    return std::abs(area) > error ? area : 0;
}

bool hasArea(const Corners& c) {
    const dvec3 e1 = c.p[1] - c.p[0], e2 = c.p[2] - c.p[0];
    double largest = 0;
    for (const dvec3& p : c.p) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return glm::length(glm::cross(e1, e2)) > kRounding * largest * (glm::length(e1) + glm::length(e2));
}

double angleAt(const Corners& c, int corner) {
    const dvec3 a = c.p[(corner + 1) % 3] - c.p[corner], b = c.p[(corner + 2) % 3] - c.p[corner];
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

/// The sums over the triangles around a vertex.
struct TangentSum {
    dvec3 ps{0}, pt{0};
    double weight = 0;
};

std::vector<TangentSum> sumTangents(const DenseMesh& mesh) {
    std::vector<TangentSum> sums(mesh.positions.size());
    for (std::size_t triangle = 0; triangle < mesh.indices.size() / 3; ++triangle) {
        const Corners c = cornersOf(mesh, triangle);
        const double area = texAreaOf(c);
        if (area == 0 || !hasArea(c)) continue;
        const dvec3 e1 = c.p[1] - c.p[0], e2 = c.p[2] - c.p[0];
        const dvec2 d1 = c.st[1] - c.st[0], d2 = c.st[2] - c.st[0];
        const dvec3 ps = (d2.y * e1 - d1.y * e2) / area, pt = (d1.x * e2 - d2.x * e1) / area;
        for (int k = 0; k < 3; ++k) {
            TangentSum& sum = sums[mesh.indices[3 * triangle + std::size_t(k)]];
            const double angle = angleAt(c, k);
            sum.ps += angle * ps;
            sum.pt += angle * pt;
            sum.weight += angle;
        }
    }
    return sums;
}

/// Whether the two span a plane.
bool spanPlane(const dvec3& ps, const dvec3& pt) {
    constexpr double kParallel = 1e-6; // sine of the angle between them
    const double lengths = glm::length(ps) * glm::length(pt);
    return lengths > 0 && glm::length(glm::cross(ps, pt)) > kParallel * lengths;
}

/// A unit vector perpendicular to a normal, which may be 0.
dvec3 perpendicularTo(const dvec3& n) {
    const dvec3 axis = std::abs(n.x) < 0.6 * glm::length(n) ? dvec3(1, 0, 0) : dvec3(0, 1, 0);
    const dvec3 t = axis - n * (glm::dot(n, axis) / std::max(glm::dot(n, n), 1e-30));
    return glm::normalize(t);
}

} // namespace

Tangents computeTangents(const DenseMesh& mesh) {
    RELIEF_CHECK(mesh.texCoords.size() == mesh.positions.size());
    RELIEF_CHECK(mesh.normals.size() == mesh.positions.size());
    const std::vector<TangentSum> sums = sumTangents(mesh);
    Tangents tangents;
    tangents.ps.reserve(sums.size());
    tangents.pt.reserve(sums.size());
    for (std::size_t i = 0; i < sums.size(); ++i) {
        dvec3 ps = sums[i].ps, pt = sums[i].pt;
        if (spanPlane(ps, pt)) {
            ps /= sums[i].weight;
            pt /= sums[i].weight;
        } else {
            const dvec3 n(mesh.normals[i]);
            ps = perpendicularTo(n);
            pt = glm::dot(n, n) > 0 ? glm::normalize(glm::cross(n, ps)) : dvec3(0, 0, 1);
        }
        tangents.ps.push_back(vec3(ps));
        tangents.pt.push_back(vec3(pt));
    }
    return tangents;
}

DenseMesh splitMirrored(DenseMesh mesh) {
    RELIEF_CHECK(mesh.texCoords.size() == mesh.positions.size());
    const std::size_t triangleCount = mesh.indices.size() / 3;
    // Find the vertices that triangles use which are not mirrored.
    std::vector<bool> isMirrored(triangleCount), isUsed(mesh.positions.size(), false);
    for (std::size_t triangle = 0; triangle < triangleCount; ++triangle) {
        const double area = texAreaOf(cornersOf(mesh, triangle));
        isMirrored[triangle] = area < 0;
        for (std::size_t k = 0; area > 0 && k < 3; ++k) isUsed[mesh.indices[3 * triangle + k]] = true;
    }
    // Mirrored triangles take copies of those.
    std::vector<std::uint32_t> copies(mesh.positions.size(), kNone);
    const auto append = [](auto& values, std::uint32_t vertex) {
        if (!values.empty()) values.push_back(values[vertex]);
    };
    for (std::size_t corner = 0; corner < mesh.indices.size(); ++corner) {
        std::uint32_t& vertex = mesh.indices[corner];
        if (!isMirrored[corner / 3] || !isUsed[vertex]) continue;
        std::uint32_t& copy = copies[vertex];
        if (copy == kNone) {
            copy = std::uint32_t(mesh.positions.size());
            append(mesh.positions, vertex);
            append(mesh.normals, vertex);
            append(mesh.texCoords, vertex);
            append(mesh.heights, vertex);
        }
        vertex = copy;
    }
    return mesh;
}

} // namespace relief
