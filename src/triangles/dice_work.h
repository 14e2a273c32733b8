// Internal: what a dicing has to do, counted before anything is allocated.
#pragma once

#include "triangles/dice_table.h"

namespace relief {

/// A part of a list.
struct DiceRange {
    std::size_t first = 0, count = 0;
};

/// Faces that are diced together: of each list of DiceWork their part.
struct DicePiece {
    DiceRange regularInsides, otherInsides, rings, cells;
    std::uint64_t insideVertexCount = 0, triangleCount = 0;
};

/// What one dicing dispatches. Vertices on edges are the same for all pieces; insides and triangles are numbered anew
/// per piece.
struct DiceWork {
    std::vector<DicePiece> pieces;            ///< one or more
    std::uint64_t runVertexCount = 0;         ///< on edges and corners
    std::vector<std::uint32_t> runFirsts;     ///< one more at the end: where the insides begin
    std::vector<InsideTile> insides;          ///< those of regular patches first
    std::vector<EdgePiece> edgePieces;        ///< of edges in bicubic patches
    std::vector<std::uint32_t> otherVertices; ///< on corners and edges, neither in pieces nor on smooth edges
    std::vector<TriangleTile> rings, cells;   ///< triangles at edges, triangles between inner samples
    std::vector<std::uint32_t> firstTriangles, faceRates;
    std::vector<std::uint32_t> firstInsides;                           ///< per face, a vertex of its piece
    std::uint64_t vertexCount = 0, triangleCount = 0, sampleCount = 0; ///< of all pieces
    std::uint32_t maxRate = 0;

    /// Vertices and triangles of the largest piece, with those on edges.
    [[nodiscard]] std::uint64_t mostVertices() const;
    [[nodiscard]] std::uint64_t mostTriangles() const;
};

/// Tiles and counts of a model at these rates. `makesPieces`: whether dice_edges.comp has code for pieces of edges,
/// which it has not where tables are storage buffers (SwiftShader takes long to compile it). `pieceTriangles`: of a
/// piece of the mesh at most, where a face has no more; default: all are one piece.
DiceWork planDicing(const SurfaceModel& model, const DiceTable& table, const EdgeRates& rates, bool makesPieces,
                    std::uint64_t pieceTriangles = ~std::uint64_t(0));

} // namespace relief
