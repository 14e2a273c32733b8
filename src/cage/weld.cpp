// Joins the vertices of a cage that are at the same position: what an exporter has split becomes one surface again.
#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

#include "base/point_tree.h"
#include "cage/edges.h"
#include "cage/faces.h"

namespace relief {

namespace {

/// The ends of edges that one face has alone, each once, in index order.
std::vector<std::uint32_t> boundaryVertices(const Cage& cage) {
    const std::vector<EdgeUse> uses = sortedEdgeUses(cage);
    std::vector<std::uint32_t> vertices;
    for (std::size_t i = 0; i < uses.size(); ++i) {
        const bool isLone =
            (i == 0 || uses[i - 1].key != uses[i].key) && (i + 1 == uses.size() || uses[i + 1].key != uses[i].key);
        if (isLone) vertices.insert(vertices.end(), {cage.corners[uses[i].corner], cage.corners[uses[i].next]});
    }
    std::ranges::sort(vertices);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
}

/// For each vertex the one that it joins: itself, or a boundary vertex of a lower index within the distance. A vertex
/// that others join joins none, so that chains of vertices do not run together.
std::vector<std::uint32_t> findTargets(const Cage& cage, double distance) {
    std::vector<std::uint32_t> targets(cage.positions.size());
    std::iota(targets.begin(), targets.end(), 0u);
    const std::vector<std::uint32_t> vertices = boundaryVertices(cage);
    std::vector<dvec3> points;
    points.reserve(vertices.size());
    for (const std::uint32_t vertex : vertices) points.emplace_back(cage.positions[vertex]);
    const PointTree tree(std::move(points));
    std::vector<bool> isTaken(vertices.size(), false);
    for (std::uint32_t i = 0; i < vertices.size(); ++i) {
        if (isTaken[i]) continue;
        const auto boxDistance = [&](const Bounds& box) { return box.distanceTo(tree[i]); };
        tree.search(boxDistance, distance, [&](std::uint32_t other) {
            if (other <= i || isTaken[other] || glm::length(tree[other] - tree[i]) > distance) return;
            isTaken[other] = true;
            targets[vertices[other]] = vertices[i];
        });
    }
    return targets;
}

/// Texture coordinates that are equal where vertices were joined become one, so that no seam is left there.
void joinTexCoords(Cage& cage, const std::vector<std::uint32_t>& oldCorners) {
    std::vector<bool> isJoined(cage.positions.size(), false);
    for (std::size_t corner = 0; corner < cage.corners.size(); ++corner)
        if (cage.corners[corner] != oldCorners[corner]) isJoined[cage.corners[corner]] = true;
    std::map<std::tuple<std::uint32_t, float, float>, std::uint32_t> firsts;
    for (std::size_t corner = 0; corner < cage.texCorners.size(); ++corner) {
        if (!isJoined[cage.corners[corner]]) continue;
        std::uint32_t& index = cage.texCorners[corner];
        const vec2 st = cage.texCoords[index];
        index = firsts.try_emplace({cage.corners[corner], st.x, st.y}, index).first->second;
    }
}

/// One crease per edge and one sharpness per vertex: the largest of those that came together.
void joinTags(Cage& cage) {
    // Creases: the first one of an edge stays in its place.
    std::map<std::uint64_t, std::size_t> creases;
    std::size_t count = 0;
    for (std::size_t i = 0; i < cage.creaseSharpness.size(); ++i) {
        const std::uint32_t a = cage.creaseEdges[2 * i], b = cage.creaseEdges[2 * i + 1];
        const auto [crease, isNew] = creases.try_emplace(edgeKey(a, b), count);
        const float sharpness = cage.creaseSharpness[i];
        float& kept = cage.creaseSharpness[crease->second];
        kept = isNew ? sharpness : std::max(kept, sharpness);
        if (!isNew) continue;
        cage.creaseEdges[2 * count] = a;
        cage.creaseEdges[2 * count++ + 1] = b;
    }
    cage.creaseEdges.resize(2 * count);
    cage.creaseSharpness.resize(count);

    // Sharp vertices, in the order of their numbers.
    std::map<std::uint32_t, float> corners;
    for (std::size_t i = 0; i < cage.sharpVertices.size(); ++i) {
        float& sharpness = corners[cage.sharpVertices[i]];
        sharpness = std::max(sharpness, cage.vertexSharpness[i]);
    }
    cage.sharpVertices.clear();
    cage.vertexSharpness.clear();
    for (const auto& [vertex, sharpness] : corners) {
        cage.sharpVertices.push_back(vertex);
        cage.vertexSharpness.push_back(sharpness);
    }
}

void renumber(Cage& cage, const std::vector<std::uint32_t>& newIndices) {
    for (auto* indices : {&cage.corners, &cage.creaseEdges, &cage.sharpVertices})
        for (std::uint32_t& index : *indices) index = newIndices[index];
}

/// Removes the vertices that join others and puts the new indices of those that are left into `targets`. Returns the
/// old ones.
std::vector<std::uint32_t> removeJoined(Cage& cage, std::vector<std::uint32_t>& targets) {
    std::vector<std::uint32_t> sources;
    for (std::uint32_t vertex = 0; vertex < targets.size(); ++vertex) {
        if (targets[vertex] != vertex) continue;
        targets[vertex] = std::uint32_t(sources.size());
        cage.positions[sources.size()] = cage.positions[vertex];
        sources.push_back(vertex);
    }
    cage.positions.resize(sources.size());
    return sources;
}

} // namespace

std::uint64_t countCoincidentVertices(const Cage& cage) {
    const std::vector<std::uint32_t> targets = findTargets(cage, 0);
    std::uint64_t count = 0;
    for (std::uint32_t vertex = 0; vertex < targets.size(); ++vertex) count += targets[vertex] != vertex ? 1 : 0;
    return count;
}

WeldedCage weld(Cage cage, double distance) {
    if (!(distance >= 0)) fail(Failure::usage, "a distance to weld is 0 or more, not {}", distance);
    std::vector<std::uint32_t> targets = findTargets(cage, distance);
    const std::vector<std::uint32_t> oldCorners = cage.corners;
    renumber(cage, targets);
    joinTexCoords(cage, oldCorners);
    std::vector<std::uint32_t> sources = removeJoined(cage, targets);
    renumber(cage, targets);
    joinTags(cage);
    removeDegenerateFaces(cage);
    return {std::move(cage), std::move(sources)};
}

} // namespace relief
