#include "geometry_image/topology.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "base/unique_points.h"

namespace relief {
namespace {

std::uint64_t keyOf(std::uint32_t from, std::uint32_t to) { return (std::uint64_t(from) << 32) | to; }

/// Half-edges by their two vertices; `other` of the same direction would mean a wrong winding.
using EdgeTable = std::vector<std::pair<std::uint64_t, std::uint32_t>>;

EdgeTable listEdges(const CutMesh& mesh) {
    EdgeTable edges(mesh.halfEdgeCount());
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h)
        edges[h] = {keyOf(std::min(mesh.from(h), mesh.to(h)), std::max(mesh.from(h), mesh.to(h))), h};
    std::ranges::sort(edges);
    return edges;
}

std::string describeVertex(const CutMesh& mesh, std::uint32_t v, const Coordinates& coordinates) {
    const dvec3 p = coordinates.toWorld(mesh.positions[v]);
    return fmt::format("({:.6g}, {:.6g}, {:.6g})", p.x, p.y, p.z);
}

void joinTwins(CutMesh& mesh, const std::string& name, const Coordinates& coordinates) {
    const EdgeTable edges = listEdges(mesh);
    std::uint64_t crowded = 0, turned = 0;
    std::uint32_t crowdedAt = 0, turnedAt = 0;
    for (std::size_t i = 0, end = 0; i < edges.size(); i = end) {
        for (end = i; end < edges.size() && edges[end].first == edges[i].first;) ++end;
        const std::uint32_t a = edges[i].second;
        if (end - i > 2 && crowded++ == 0) crowdedAt = a;
        if (end - i != 2) continue;
        const std::uint32_t b = edges[i + 1].second;
        if (mesh.from(a) == mesh.from(b) && turned++ == 0) turnedAt = a;
        mesh.twins[a] = b, mesh.twins[b] = a;
    }
    if (crowded > 0)
        fail(Failure::input,
             "{}: {} edges have more than two triangles, the first is at {}; a geometry image needs a manifold", name,
             crowded, describeVertex(mesh, mesh.from(crowdedAt), coordinates));
    if (turned > 0)
        fail(
            Failure::input,
            "{}: the triangles at {} edges are wound against each other, first at {}; a geometry image needs a surface "
            "with two sides",
            name, turned, describeVertex(mesh, mesh.from(turnedAt), coordinates));
}

/// Each vertex has one fan of triangles: as many half-edges as walking around it meets.
void checkFans(const CutMesh& mesh, const std::string& name, const Coordinates& coordinates) {
    const Disk disk = cutOpen(mesh);
    if (disk.vertexCount() == mesh.positions.size()) return;
    std::vector<char> seen(mesh.positions.size(), 0);
    for (const std::uint32_t v : disk.sources) {
        if (seen[v]++ == 0) continue;
        fail(Failure::input,
             "{}: {} vertices join parts of the surface that share no edge there, the first is at {}; a geometry image "
             "needs a manifold",
             name, disk.vertexCount() - mesh.positions.size(), describeVertex(mesh, v, coordinates));
    }
}

void checkConnected(const CutMesh& mesh, const std::string& name) {
    std::vector<char> seen(mesh.halfEdgeCount() / 3, 0);
    std::vector<std::uint32_t> stack;
    int parts = 0;
    for (std::uint32_t t = 0; t < seen.size(); ++t) {
        if (seen[t] != 0) continue;
        ++parts;
        stack.push_back(t);
        seen[t] = 1;
        while (!stack.empty()) {
            const std::uint32_t top = stack.back();
            stack.pop_back();
            for (std::uint32_t k = 0; k < 3; ++k) {
                const std::uint32_t twin = mesh.twins[3 * top + k];
                if (twin == kNone || seen[twin / 3] != 0) continue;
                seen[twin / 3] = 1;
                stack.push_back(twin / 3);
            }
        }
    }
    if (parts > 1)
        fail(Failure::input, "{}: the surface has {} parts that are not connected; a geometry image holds one", name,
             parts);
}

/// The number of cut and boundary edges at each vertex.
std::vector<std::uint32_t> countBorderEdges(const CutMesh& mesh) {
    std::vector<std::uint32_t> counts(mesh.positions.size(), 0);
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h)
        if (mesh.twins[h] == kNone || (mesh.isCut[h] != 0 && h < mesh.twins[h])) {
            ++counts[mesh.from(h)];
            ++counts[mesh.to(h)];
        }
    return counts;
}

/// Marks the vertices where boundaries turn by more than 45 degrees, unless there are so many that nothing is a corner.
void findCorners(CutMesh& mesh) {
    constexpr int kMostCorners = 16;
    constexpr double kPi = std::numbers::pi;
    std::vector<double> angles(mesh.positions.size(), 0);
    std::vector<char> isBoundary(mesh.positions.size(), 0);
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) {
        const dvec3 &p = mesh.positions[mesh.from(h)], a = mesh.positions[mesh.to(h)] - p;
        const dvec3 b = mesh.positions[mesh.from(previousOf(h))] - p;
        angles[mesh.from(h)] += std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
        if (mesh.twins[h] == kNone) isBoundary[mesh.from(h)] = 1;
    }
    mesh.isCorner.assign(mesh.positions.size(), 0);
    for (std::size_t v = 0; v < angles.size(); ++v)
        mesh.isCorner[v] = char(isBoundary[v] != 0 && std::abs(angles[v] - kPi) > kPi / 4);
    if (std::ranges::count(mesh.isCorner, 1) > kMostCorners) std::ranges::fill(mesh.isCorner, 0);
}

/// Vertices at equal positions become one, and triangles without three vertices are dropped.
void takeVertices(CutMesh& mesh, const DenseMesh& from) {
    const UniquePoints unique = findUniquePoints(from.positions);
    std::vector<std::uint32_t> names(unique.count(), kNone);
    for (std::size_t i = 0; i + 2 < from.indices.size(); i += 3) {
        std::uint32_t c[3];
        for (std::size_t k = 0; k < 3; ++k) c[k] = unique.indices[from.indices[i + k]];
        if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
        for (std::uint32_t& v : c) {
            if (names[v] == kNone) {
                names[v] = std::uint32_t(mesh.positions.size());
                mesh.positions.emplace_back(from.positions[unique.firsts[v]]);
            }
            mesh.corners.push_back(names[v]);
        }
    }
    mesh.normals.assign(mesh.positions.size(), dvec3(0));
    for (std::size_t i = 0; i < from.normals.size(); ++i)
        if (const std::uint32_t v = names[unique.indices[i]]; v != kNone) mesh.normals[v] += dvec3(from.normals[i]);
}

/// Unit normals; where there are none, those of the triangles around a vertex, by their angles.
void completeNormals(CutMesh& mesh, bool hasNormals) {
    if (!hasNormals)
        for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) {
            const dvec3 &p = mesh.positions[mesh.from(h)], a = mesh.positions[mesh.to(h)] - p;
            const dvec3 b = mesh.positions[mesh.from(previousOf(h))] - p, n = glm::cross(a, b);
            const double sine = glm::length(n);
            if (sine > 0) mesh.normals[mesh.from(h)] += n / sine * std::atan2(sine, glm::dot(a, b));
        }
    for (dvec3& n : mesh.normals) n = glm::dot(n, n) > 1e-24 ? glm::normalize(n) : dvec3(0, 0, 1);
}

} // namespace

CutMesh makeCutMesh(const DenseMesh& mesh, const std::string& name) {
    if (mesh.indices.size() / 3 > kMostSourceTriangles)
        fail(Failure::input, "{}: {} triangles are more than the {} that can be spread over a square", name,
             mesh.indices.size() / 3, kMostSourceTriangles);
    CutMesh result;
    takeVertices(result, mesh);
    const auto areaOf = [&](std::uint32_t h) {
        return glm::length(glm::cross(result.positions[result.to(h)] - result.positions[result.from(h)],
                                      result.positions[result.from(previousOf(h))] - result.positions[result.from(h)]));
    };
    double area = 0;
    for (std::uint32_t h = 0; h < result.halfEdgeCount(); h += 3) area += areaOf(h);
    if (!(area > 0)) fail(Failure::input, "{}: the surface has no area", name);
    result.twins.assign(result.corners.size(), kNone);
    result.isCut.assign(result.corners.size(), 0);
    joinTwins(result, name, mesh.coordinates);
    checkConnected(result, name);
    checkFans(result, name, mesh.coordinates);
    completeNormals(result, !mesh.normals.empty());
    findCorners(result);
    return result;
}

std::uint32_t CutMesh::split(std::uint32_t h, double fraction) {
    const auto vertex = std::uint32_t(positions.size());
    positions.push_back(glm::mix(positions[from(h)], positions[to(h)], fraction));
    const dvec3 normal = glm::mix(normals[from(h)], normals[to(h)], fraction);
    normals.push_back(glm::dot(normal, normal) > 1e-24 ? glm::normalize(normal) : normals[from(h)]);
    isCorner.push_back(0);
    // Triangle (a, b, c) becomes (a, m, c) and (m, b, c); the second half of the edge is the first of the new triangle.
    const auto halve = [&](std::uint32_t edge) {
        const std::uint32_t next = nextOf(edge), added = halfEdgeCount();
        corners.insert(corners.end(), {vertex, corners[next], corners[previousOf(edge)]});
        twins.insert(twins.end(), {kNone, twins[next], next});
        isCut.insert(isCut.end(), {isCut[edge], isCut[next], 0});
        if (twins[next] != kNone) twins[twins[next]] = added + 1;
        corners[next] = vertex, twins[next] = added + 2, isCut[next] = 0;
        return added;
    };
    const std::uint32_t twin = twins[h], second = halve(h);
    if (twin == kNone) return second;
    const std::uint32_t secondOfTwin = halve(twin);
    twins[h] = secondOfTwin, twins[secondOfTwin] = h;
    twins[second] = twin, twins[twin] = second;
    return second;
}

int countBoundaries(const CutMesh& mesh) {
    std::vector<char> seen(mesh.halfEdgeCount(), 0);
    int count = 0;
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) {
        if (mesh.twins[h] != kNone || seen[h] != 0) continue;
        ++count;
        for (std::uint32_t at = h; seen[at] == 0;) {
            seen[at] = 1;
            // The next boundary edge, around the vertex at the end.
            for (at = nextOf(at); mesh.twins[at] != kNone;) at = nextOf(mesh.twins[at]);
        }
    }
    return count;
}

Disk cutOpen(const CutMesh& mesh) {
    Disk disk;
    disk.corners.assign(mesh.halfEdgeCount(), kNone);
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) {
        if (disk.corners[h] != kNone) continue;
        // Clockwise to the first half-edge of the sector, then counterclockwise over all of it.
        std::uint32_t first = h;
        bool hasBorder = true;
        while (!mesh.isBorder(first)) {
            first = nextOf(mesh.twins[first]);
            if (first == h) {
                hasBorder = false;
                break;
            }
        }
        const auto copy = std::uint32_t(disk.sources.size());
        disk.sources.push_back(mesh.from(h));
        disk.isOnBorder.push_back(char(hasBorder));
        for (std::uint32_t at = first;;) {
            disk.corners[at] = copy;
            const std::uint32_t before = previousOf(at);
            if (mesh.isBorder(before) || mesh.twins[before] == first) break;
            at = mesh.twins[before];
        }
    }
    // Half-edges by their start.
    disk.firstEdges.assign(disk.sources.size() + 1, 0);
    for (const std::uint32_t v : disk.corners) ++disk.firstEdges[v + 1];
    std::partial_sum(disk.firstEdges.begin(), disk.firstEdges.end(), disk.firstEdges.begin());
    disk.edges.resize(disk.corners.size());
    std::vector<std::uint32_t> fill(disk.firstEdges.begin(), disk.firstEdges.end() - 1);
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) disk.edges[fill[disk.corners[h]]++] = h;
    return disk;
}

std::vector<BorderPath> walkBorder(const CutMesh& mesh, const Disk& disk) {
    // The whole chain: from the end of each border edge around its copy of the vertex to the next one.
    const std::vector<std::uint32_t> counts = countBorderEdges(mesh);
    const auto isNode = [&](std::uint32_t v) { return counts[v] != 2 || mesh.isCorner[v] != 0; };
    std::uint32_t start = kNone, borderCount = 0;
    for (std::uint32_t h = 0; h < mesh.halfEdgeCount(); ++h) {
        if (!mesh.isBorder(h)) continue;
        ++borderCount;
        if (start == kNone || (!isNode(mesh.from(start)) && isNode(mesh.from(h)))) start = h;
    }
    RELIEF_CHECK(start != kNone);
    std::vector<BorderPath> paths;
    std::vector<std::uint32_t> pathOf(mesh.halfEdgeCount(), kNone);
    std::uint32_t at = start, walked = 0;
    do {
        if (paths.empty() || isNode(mesh.from(at))) paths.emplace_back();
        paths.back().halfEdges.push_back(at);
        paths.back().length += mesh.length(at);
        pathOf[at] = std::uint32_t(paths.size() - 1);
        ++walked;
        for (at = nextOf(at); !mesh.isBorder(at);) at = nextOf(mesh.twins[at]);
    } while (at != start && walked <= borderCount);
    RELIEF_CHECK(walked == borderCount);
    RELIEF_CHECK(disk.vertexCount() >= borderCount);
    for (std::uint32_t p = 0; p < paths.size(); ++p) {
        const std::uint32_t twin = mesh.twins[paths[p].halfEdges.front()];
        paths[p].mate = twin == kNone ? p : pathOf[twin];
    }
    return paths;
}

} // namespace relief
