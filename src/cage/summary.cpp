#include "cage/cage.h"

#include <algorithm>
#include <span>

#include "cage/edges.h"

namespace relief {

namespace {

/// What is known of each vertex once all edges are counted.
struct Neighbourhood {
    std::vector<std::uint32_t> valence; ///< edges
    std::vector<bool> isOnBoundary;
};

bool isNonManifold(std::span<const EdgeUse> uses) {
    return uses.size() > 2 || (uses.size() == 2 && uses[0].runsUp == uses[1].runsUp);
}

/// True when the two faces name different texture coordinates at an end of the edge.
bool isSeam(const Cage& cage, std::span<const EdgeUse> uses) {
    if (!cage.hasTexCoords() || uses.size() != 2) return false;
    const auto ends = [&](const EdgeUse& use) {
        const std::uint32_t from = cage.texCorners[use.corner], to = cage.texCorners[use.next];
        return use.runsUp ? std::pair(from, to) : std::pair(to, from);
    };
    return ends(uses[0]) != ends(uses[1]);
}

void countEdge(const Cage& cage, std::span<const EdgeUse> uses, CageSummary& summary, Neighbourhood& around) {
    ++summary.edgeCount;
    if (isNonManifold(uses)) ++summary.nonManifoldEdgeCount;
    if (isSeam(cage, uses)) ++summary.seamEdgeCount;
    for (const std::uint32_t vertex : {cage.corners[uses[0].corner], cage.corners[uses[0].next]}) {
        ++around.valence[vertex];
        if (uses.size() == 1) around.isOnBoundary[vertex] = true;
    }
    if (uses.size() == 1) ++summary.boundaryEdgeCount;
}

void countEdges(const Cage& cage, CageSummary& summary, Neighbourhood& around) {
    const std::vector<EdgeUse> uses = sortedEdgeUses(cage);
    for (std::size_t i = 0; i < uses.size();) {
        std::size_t end = i + 1;
        while (end < uses.size() && uses[end].key == uses[i].key) ++end;
        countEdge(cage, std::span(uses).subspan(i, end - i), summary, around);
        i = end;
    }
}

void countFaces(const Cage& cage, CageSummary& summary) {
    for (const std::uint32_t size : cage.faceSizes) {
        if (size == 3) ++summary.triangleCount;
        if (size == 4) ++summary.quadCount;
        if (size > 4) ++summary.otherFaceCount;
    }
}

} // namespace

CageSummary summarize(const Cage& cage) {
    CageSummary summary{.vertexCount = cage.positions.size(),
                        .faceCount = cage.faceCount(),
                        .cornerCount = cage.corners.size(),
                        .creasedEdgeCount = cage.creaseSharpness.size(),
                        .sharpVertexCount = cage.sharpVertices.size(),
                        .holeCount = cage.holes.size(),
                        .texCoordCount = cage.texCoords.size()};
    // Faces, and edges with what they make known of their vertices.
    countFaces(cage, summary);
    Neighbourhood around{.valence = std::vector<std::uint32_t>(cage.positions.size()),
                         .isOnBoundary = std::vector<bool>(cage.positions.size())};
    countEdges(cage, summary, around);

    // Vertices: those that no face uses, often at the origin, do not count for the bounds.
    const std::uint32_t regular = cage.isAllTriangles() ? 6 : 4;
    for (std::size_t vertex = 0; vertex < cage.positions.size(); ++vertex) {
        const std::uint32_t valence = around.valence[vertex];
        if (valence == 0) {
            ++summary.unusedVertexCount;
            continue;
        }
        summary.bounds.add(dvec3(cage.positions[vertex]));
        summary.maxValence = std::max<std::uint64_t>(summary.maxValence, valence);
        if (valence != regular && !around.isOnBoundary[vertex]) ++summary.irregularVertexCount;
    }
    summary.bounds = cage.coordinates.toWorld(summary.bounds);
    return summary;
}

} // namespace relief
