#include <algorithm>
#include <cmath>
#include <numeric>

#include "doctor/doctor.h"

namespace relief {
namespace {

constexpr double kCells = 20000;

/// Faces that continue each other in texture space, by the forest of Galler and Fischer (1964).
class IslandFinder {
public:
    explicit IslandFinder(std::size_t faceCount) : parents_(faceCount) {
        std::iota(parents_.begin(), parents_.end(), 0u);
    }

    std::uint32_t rootOf(std::uint32_t face) {
        while (parents_[face] != face) face = parents_[face] = parents_[parents_[face]];
        return face;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        parents_[std::max(rootOf(a), rootOf(b))] = std::min(rootOf(a), rootOf(b));
    }

private:
    std::vector<std::uint32_t> parents_;
};

/// The island of each face, numbered from 0 in the order of their first faces.
std::vector<std::uint32_t> findIslands(const Surface& surface, const ReferenceSurface& reference) {
    constexpr double kSame = 1e-9; // two patches in double precision
    IslandFinder finder(surface.faces.size());
    const auto textureOf = [&](const Incidence& incidence, double t) {
        const double x = std::lerp(double(incidence.start), double(incidence.end), t);
        return reference.texture(int(incidence.face), sidePoint(surface.sideCount, int(incidence.side), x)).st;
    };
    const EdgeIncidences incidences = edgeIncidences(surface);
    for (std::size_t edge = 0; edge < surface.edges.size(); ++edge) {
        const std::span<const Incidence> faces = incidences.of(edge);
        for (const Incidence& other : faces.subspan(std::min<std::size_t>(1, faces.size())))
            if (glm::length(textureOf(faces[0], 0.25) - textureOf(other, 0.25)) < kSame &&
                glm::length(textureOf(faces[0], 0.75) - textureOf(other, 0.75)) < kSame)
                finder.join(faces[0].face, other.face);
    }
    std::vector<std::uint32_t> islands(surface.faces.size());
    std::uint32_t count = 0;
    for (std::uint32_t face = 0; face < islands.size(); ++face) {
        const std::uint32_t root = finder.rootOf(face);
        islands[face] = root == face ? count++ : islands[root];
    }
    return islands;
}

/// p_s and p_t by the chain rule: [p_u p_v] = [p_s p_t] J.
glm::dmat2x3 texTangents(const LimitFrame& frame, const TexFrame& tex) {
    const dmat2& J = tex.jacobian;
    const double determinant = J[0].x * J[1].y - J[1].x * J[0].y;
    if (determinant == 0) return glm::dmat2x3(dvec3(INFINITY), dvec3(INFINITY));
    return glm::dmat2x3((J[1].y * frame.pu - J[0].y * frame.pv) / determinant,
                        (J[0].x * frame.pv - J[1].x * frame.pu) / determinant);
}

LayoutCell makeCell(const ReferenceSurface& reference, int face, const std::array<dvec2, 4>& uvs, double uvArea) {
    LayoutCell cell{.corners = {}};
    const dvec2 uv = 0.25 * (uvs[0] + uvs[1] + uvs[2] + uvs[3]);
    for (std::size_t k = 0; k < 4; ++k) cell.corners[k] = reference.texture(face, uvs[k]).st;
    const LimitFrame frame = reference.limit(face, uv);
    const TexFrame tex = reference.texture(face, uv);
    cell.at = {std::uint32_t(face), vec2(uv)};
    cell.area = uvArea * glm::length(glm::cross(frame.pu, frame.pv));
    cell.st = tex.st;
    cell.tangents = texTangents(frame, tex);
    // In end caps the patch only approximates the surface, and its curvature may be far off.
    if (!reference.isApproximate(face, uv) && frame.hasTangentPlane()) cell.curvature = principalCurvatures(frame);
    return cell;
}

} // namespace

SurfaceLayout makeLayout(const Surface& surface, const ReferenceSurface& reference) {
    SurfaceLayout layout{.hasTexCoords = surface.hasTexCoords(), .lower = dvec2(INFINITY), .upper = dvec2(-INFINITY)};
    const std::vector<std::uint32_t> islands = findIslands(surface, reference);
    layout.islandFaces.resize(islands.empty() ? 0 : 1 + std::ranges::max(islands));
    // As many cells per face as give about kCells in all.
    const int n = int(std::clamp(std::sqrt(kCells / double(surface.faces.size())), 2.0, 16.0));
    for (int face = 0; face < int(surface.faces.size()); ++face) {
        if (reference.isHole(face)) continue;
        ++layout.islandFaces[islands[std::size_t(face)]];
        // Squares of the domain; of a triangular face those that its long side cuts are triangles.
        for (int j = 0; j < n; ++j)
            for (int i = 0; i < n; ++i) {
                if (surface.sideCount == 3 && i + j >= n) continue;
                const bool isCut = surface.sideCount == 3 && i + j == n - 1;
                const dvec2 a(double(i) / n, double(j) / n), step(1.0 / n);
                const dvec2 across = isCut ? a + 0.5 * step : a + step;
                const std::array<dvec2, 4> uvs = {a, a + dvec2(step.x, 0), across, a + dvec2(0, step.y)};
                LayoutCell cell = makeCell(reference, face, uvs, (isCut ? 0.5 : 1) / (n * n));
                cell.island = islands[std::size_t(face)];
                for (const dvec2& st : cell.corners)
                    layout.lower = glm::min(layout.lower, st), layout.upper = glm::max(layout.upper, st);
                layout.cells.push_back(cell);
            }
    }
    return layout;
}

} // namespace relief
