// Internal: a triangle mesh with half-edges, the edges that it is cut along, and the disk that this makes of it.
#pragma once

#include "geometry_image/geometry_image.h"

namespace relief {

/// Half-edge h = 3 t + k runs from corner k of triangle t to the next one.
constexpr std::uint32_t nextOf(std::uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
constexpr std::uint32_t previousOf(std::uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }
inline constexpr std::uint32_t kNone = ~0u;

/// An oriented manifold of triangles.
struct CutMesh {
    std::vector<dvec3> positions, normals;
    std::vector<std::uint32_t> corners; ///< three vertices per triangle
    std::vector<std::uint32_t> twins;   ///< per half-edge: the one that runs the other way; kNone at a boundary
    std::vector<char> isCut;            ///< per half-edge: the surface is cut here; not set at boundaries
    std::vector<char> isCorner;         ///< per vertex: the boundary turns here, and there are few such vertices

    [[nodiscard]] std::uint32_t halfEdgeCount() const { return std::uint32_t(corners.size()); }
    [[nodiscard]] bool isBorder(std::uint32_t h) const { return twins[h] == kNone || isCut[h] != 0; }
    [[nodiscard]] std::uint32_t from(std::uint32_t h) const { return corners[h]; }
    [[nodiscard]] std::uint32_t to(std::uint32_t h) const { return corners[nextOf(h)]; }
    [[nodiscard]] double length(std::uint32_t h) const { return glm::length(positions[to(h)] - positions[from(h)]); }
    void setCut(std::uint32_t h, bool cut) { isCut[h] = isCut[twins[h]] = char(cut); }
    /// Splits an edge at `fraction` of h with the triangles at it; h is then its first half. Returns the second half.
    std::uint32_t split(std::uint32_t h, double fraction);
};

/// Joins triangles along their edges. Throws as SpreadSurface does.
CutMesh makeCutMesh(const DenseMesh& mesh, const std::string& name);
/// Counts the closed chains of boundary edges.
int countBoundaries(const CutMesh& mesh);

/// A mesh cut open: each vertex has one copy for each sector between edges that are cut.
struct Disk {
    std::vector<std::uint32_t> corners;    ///< per half-edge: the copy at its start
    std::vector<std::uint32_t> sources;    ///< per copy: the vertex of the mesh
    std::vector<std::uint32_t> firstEdges; ///< per copy, and one more: where its half-edges start in `edges`
    std::vector<std::uint32_t> edges;      ///< half-edges that start at each copy
    std::vector<char> isOnBorder;          ///< per copy

    [[nodiscard]] std::uint32_t vertexCount() const { return std::uint32_t(sources.size()); }
    [[nodiscard]] std::span<const std::uint32_t> edgesFrom(std::uint32_t v) const {
        return std::span(edges).subspan(firstEdges[v], firstEdges[v + 1] - firstEdges[v]);
    }
};
Disk cutOpen(const CutMesh& mesh);

/// A part of the border between two nodes: the vertices where cuts meet or end, and corners of boundaries.
struct BorderPath {
    std::vector<std::uint32_t> halfEdges; ///< in the order of the border, counterclockwise
    std::uint32_t mate = 0;               ///< the path of the twins; itself at a boundary
    double length = 0;
};
/// The border of a disk in order, starting at a node. Throws Failure::internal where it is not one closed chain.
std::vector<BorderPath> walkBorder(const CutMesh& mesh, const Disk& disk);

} // namespace relief
