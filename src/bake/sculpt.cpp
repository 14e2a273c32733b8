#include "bake/sculpt.h"

#include <algorithm>
#include <cmath>

#include "base/unique_points.h"
#include "cage/cage.h"

namespace relief {
namespace {

/// A side of a triangle, listed with the lower of its ends.
struct Side {
    std::uint32_t high;     ///< the other end
    std::uint32_t triangle; ///< times two, plus 1 where the triangle runs from `high` to the lower end

    [[nodiscard]] bool isReversed() const { return (triangle & 1) != 0; }
    auto operator<=>(const Side&) const = default;
};

/// The sides of all triangles by their lower ends: those of an edge are beside each other.
struct Sides {
    std::vector<std::uint32_t> firsts; ///< per lower end, and the end
    std::vector<Side> sides;
};

/// Calls `take(low, side)` for all sides that have a length.
template <typename Take>
void forEachSide(const TriangleMesh& mesh, const UniquePoints& unique, const Take& take) {
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t a = unique.indices[mesh.indices[i + k]],
                                b = unique.indices[mesh.indices[i + (k + 1) % 3]];
            if (a != b) take(std::min(a, b), Side{std::max(a, b), std::uint32_t(i / 3 * 2) + (a > b ? 1 : 0)});
        }
}

Sides sortSides(const TriangleMesh& mesh) {
    // Counted, then put where they belong, then sorted among few: as much memory as the triangles, and no more.
    const UniquePoints unique = findUniquePoints(mesh.positions);
    Sides sorted;
    sorted.firsts.assign(unique.count() + 2, 0);
    forEachSide(mesh, unique, [&](std::uint32_t low, const Side&) { ++sorted.firsts[low + 2]; });
    for (std::size_t i = 2; i < sorted.firsts.size(); ++i) sorted.firsts[i] += sorted.firsts[i - 1];
    sorted.sides.resize(sorted.firsts.back());
    forEachSide(mesh, unique,
                [&](std::uint32_t low, const Side& side) { sorted.sides[sorted.firsts[low + 1]++] = side; });
    sorted.firsts.pop_back();
    for (std::size_t low = 0; low + 1 < sorted.firsts.size(); ++low)
        std::sort(sorted.sides.begin() + sorted.firsts[low], sorted.sides.begin() + sorted.firsts[low + 1]);
    return sorted;
}

/// Two triangles along one edge.
struct Link {
    std::uint32_t triangle, other;
    bool runsAlike; ///< one of them is to be turned
};

/// Calls `take` with all sides along each edge.
template <typename Take>
void forEachEdge(const Sides& sorted, const Take& take) {
    for (std::size_t low = 0; low + 1 < sorted.firsts.size(); ++low)
        for (std::size_t first = sorted.firsts[low]; first < sorted.firsts[low + 1];) {
            std::size_t end = first + 1;
            while (end < sorted.firsts[low + 1] && sorted.sides[end].high == sorted.sides[first].high) ++end;
            take(std::span(sorted.sides).subspan(first, end - first));
            first = end;
        }
}

bool runAlike(std::span<const Side> pair) { return pair[0].isReversed() == pair[1].isReversed(); }

/// Counts edges; returns how many have two triangles that run along them in one direction.
std::uint64_t countEdges(const Sides& sides, SculptFaults& faults) {
    std::uint64_t alikeCount = 0;
    forEachEdge(sides, [&](std::span<const Side> edge) {
        if (edge.size() == 1) ++faults.boundaryCount;
        if (edge.size() > 2) ++faults.nonManifoldCount;
        if (edge.size() == 2 && runAlike(edge)) ++alikeCount;
    });
    return alikeCount;
}

/// Neighbours of triangles along edges of two.
std::vector<Link> findLinks(const Sides& sides) {
    std::vector<Link> links;
    links.reserve(sides.sides.size());
    forEachEdge(sides, [&](std::span<const Side> edge) {
        if (edge.size() != 2) return;
        links.push_back({edge[0].triangle / 2, edge[1].triangle / 2, runAlike(edge)});
        links.push_back({edge[1].triangle / 2, edge[0].triangle / 2, runAlike(edge)});
    });
    return links;
}

/// Walks over each connected part once; of its two kinds of triangles the larger one stays as it is.
std::vector<bool> chooseTurned(std::size_t triangleCount, std::vector<Link> links, SculptFaults& faults) {
    // Links by triangle: those of triangle i are firsts[i] to firsts[i + 1].
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
                // Triangles that run alike along their edge look to different sides: one of them has to be turned.
                const bool turnsOther = isTurned[triangle] != links[i].runsAlike;
                if (isSeen[other]) {
                    faults.nonOrientableCount += isTurned[other] != turnsOther && triangle < other ? 1 : 0;
                    continue;
                }
                isSeen[other] = true, isTurned[other] = turnsOther;
                part.push_back(other);
            }
        }
        // The start was taken as it is, but the larger kind of the part decides.
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
        const Sides sides = sortSides(mesh);
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
