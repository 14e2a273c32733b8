#include "bake/sculpt.h"

#include <algorithm>
#include <cmath>

#include "base/unique_points.h"
#include "cage/cage.h"

namespace relief {
namespace {

/// A side of a triangle, by its ends in ascending order.
struct Side {
    std::uint32_t low, high;
    std::uint32_t triangle; ///< times two, plus 1 where the triangle runs from `high` to `low`

    [[nodiscard]] bool isReversed() const { return (triangle & 1) != 0; }
    [[nodiscard]] bool isAt(const Side& other) const { return low == other.low && high == other.high; }
};

std::vector<Side> sortedSides(const TriangleMesh& mesh) {
    const UniquePoints unique = findUniquePoints(mesh.positions);
    std::vector<Side> sides;
    sides.reserve(mesh.indices.size());
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = unique.indices[mesh.indices[i + k]],
                                b = unique.indices[mesh.indices[i + (k + 1) % 3]];
            if (a == b) continue;
            sides.push_back({std::min(a, b), std::max(a, b), std::uint32_t(i / 3 * 2) + (a > b ? 1 : 0)});
        }
    std::ranges::sort(sides, [](const Side& a, const Side& b) {
        return std::pair(std::uint64_t(a.low) << 32 | a.high, a.triangle) <
               std::pair(std::uint64_t(b.low) << 32 | b.high, b.triangle);
    });
    return sides;
}

/// Two triangles along one edge.
struct Link {
    std::uint32_t triangle, other;
    bool runsAlike; ///< one of them is to be turned
};

/// Calls `take` with all sides along each edge.
template <typename Take>
void forEachEdge(std::span<const Side> sides, const Take& take) {
    for (std::size_t first = 0; first < sides.size();) {
        std::size_t end = first + 1;
        while (end < sides.size() && sides[end].isAt(sides[first])) ++end;
        take(sides.subspan(first, end - first));
        first = end;
    }
}

bool runAlike(std::span<const Side> pair) { return pair[0].isReversed() == pair[1].isReversed(); }

/// Counts edges; returns how many have two triangles that run along them in one direction.
std::uint64_t countEdges(std::span<const Side> sides, SculptFaults& faults) {
    std::uint64_t alikeCount = 0;
    forEachEdge(sides, [&](std::span<const Side> edge) {
        if (edge.size() == 1) ++faults.boundaryCount;
        if (edge.size() > 2) ++faults.nonManifoldCount;
        if (edge.size() == 2 && runAlike(edge)) ++alikeCount;
    });
    return alikeCount;
}

/// Neighbours of triangles along edges of two.
std::vector<Link> findLinks(std::span<const Side> sides) {
    std::vector<Link> links;
    links.reserve(sides.size());
    forEachEdge(sides, [&](std::span<const Side> edge) {
        if (edge.size() != 2) return;
        links.push_back({edge[0].triangle / 2, edge[1].triangle / 2, runAlike(edge)});
        links.push_back({edge[1].triangle / 2, edge[0].triangle / 2, runAlike(edge)});
    });
    return links;
}

/// Walks over each connected part once; of its two kinds of triangles the larger one stays as it is.
std::vector<bool> chooseTurned(std::size_t triangleCount, std::vector<Link> links, SculptFaults& faults) {
    std::ranges::sort(links, {}, &Link::triangle);
    std::vector<std::uint32_t> firsts(triangleCount + 1, 0);
    for (const Link& link : links) ++firsts[link.triangle + 1];
    for (std::size_t i = 0; i < triangleCount; ++i) firsts[i + 1] += firsts[i];

    std::vector<bool> isSeen(triangleCount), isTurned(triangleCount);
    std::vector<std::uint32_t> part;
    for (std::uint32_t start = 0; start < triangleCount; ++start) {
        if (isSeen[start]) continue;
        part.assign(1, start);
        isSeen[start] = true;
        std::size_t turned = 0;
        for (std::size_t next = 0; next < part.size(); ++next) {
            const std::uint32_t triangle = part[next];
            turned += isTurned[triangle] ? 1 : 0;
            for (std::uint32_t i = firsts[triangle]; i < firsts[triangle + 1]; ++i) {
                const std::uint32_t other = links[i].other;
                const bool turnsOther = isTurned[triangle] != links[i].runsAlike;
                if (isSeen[other]) {
                    faults.nonOrientableCount += isTurned[other] != turnsOther && triangle < other ? 1 : 0;
                    continue;
                }
                isSeen[other] = true, isTurned[other] = turnsOther;
                part.push_back(other);
            }
        }
        if (2 * turned > part.size())
            for (const std::uint32_t triangle : part) isTurned[triangle] = !isTurned[triangle];
    }
    return isTurned;
}

TriangleMesh triangulate(const Cage& cage) {
    TriangleMesh mesh{.positions = cage.positions, .indices = {}, .coordinates = cage.coordinates};
    std::size_t first = 0;
    for (const std::uint32_t size : cage.faceSizes) {
        for (std::uint32_t i = 2; i < size; ++i)
            for (const std::size_t corner : {first, first + i - 1, first + i})
                mesh.indices.push_back(cage.corners[corner]);
        first += size;
    }
    return mesh;
}

} // namespace

namespace {

/// In coordinates of the file's own, or in those that are asked for.
TriangleMesh readAnyTriangles(const std::string& path, const Coordinates& coordinates, const Warn& warn) {
    if (isTriangleFile(path)) return readTriangles(path, coordinates);
    const bool isObj = lowerExtension(path) == ".obj";
    return triangulate(isObj ? parseObj(readFile(path), path, warn, coordinates) : readCage(path, warn));
}

bool hasArea(const TriangleMesh& mesh) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const auto at = [&](std::size_t k) { return dvec3(mesh.positions[mesh.indices[i + k]]); };
        if (glm::cross(at(1) - at(0), at(2) - at(0)) != dvec3(0)) return true;
    }
    return false;
}

} // namespace

TriangleMesh readSculpt(const std::string& path, const Coordinates& coordinates, const Warn& warn) {
    TriangleMesh mesh = readAnyTriangles(path, coordinates, warn);
    if (mesh.indices.empty()) fail(Failure::input, "{}: there are no triangles", path);
    if (!hasArea(mesh)) fail(Failure::input, "{}: none of its {} triangles has an area", path, mesh.indices.size() / 3);
    if (mesh.coordinates != coordinates)
        for (vec3& p : mesh.positions) p = vec3(coordinates.toLocal(mesh.coordinates.toWorld(dvec3(p))));
    mesh.coordinates = coordinates;
    return mesh;
}

SculptFaults windAlike(TriangleMesh& mesh) {
    SculptFaults faults;
    // Links take twice the memory of a mesh: most need none.
    std::vector<Link> links;
    {
        const std::vector<Side> sides = sortedSides(mesh);
        if (countEdges(sides, faults) == 0) return faults;
        links = findLinks(sides);
    }
    const std::vector<bool> isTurned = chooseTurned(mesh.indices.size() / 3, std::move(links), faults);
    for (std::size_t i = 0; i < isTurned.size(); ++i)
        if (isTurned[i]) ++faults.turnedCount, std::swap(mesh.indices[3 * i + 1], mesh.indices[3 * i + 2]);
    return faults;
}

SculptSides findSides(const ReferenceSurface& surface, const MeasuredSurface& sculpt, const LineSearch& lines) {
    const SculptLines along(surface, sculpt, lines);
    constexpr int kPoints = 4096;
    const int perSide = std::clamp(int(std::ceil(std::sqrt(double(kPoints) / surface.faceCount()))), 1, 16);
    const int step = std::max(1, surface.faceCount() / kPoints);
    SculptSides sides;
    for (int face = 0; face < surface.faceCount(); face += step) {
        if (surface.isHole(face)) continue;
        for (int i = 0; i < perSide * perSide; ++i) {
            dvec2 uv = (dvec2(i % perSide, i / perSide) + 0.5) / double(perSide);
            if (surface.sideCount() == 3 && uv.x + uv.y > 1) continue;
            const SculptLines::Line line = along.lineAt(face, uv);
            ++sides.lineCount;
            const std::optional<LineHit> any = along.find(line, Facing::any);
            if (!any) continue;
            const std::optional<LineHit> front = along.find(line, Facing::front);
            ++(front && front->height == any->height ? sides.frontCount : sides.backCount);
        }
    }
    return sides;
}

} // namespace relief
