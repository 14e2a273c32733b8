// Internal: what a dicing has to do, counted before anything is allocated.
#pragma once

#include "triangles/dice_table.h"

namespace relief {

/// What one dicing dispatches.
struct DiceWork {
    std::vector<std::uint32_t> runFirsts; ///< one more at the end: where the insides begin
    std::vector<InsideTile> insides;      ///< those of regular patches first
    std::size_t regularCount = 0;
    std::vector<EdgePiece> pieces;            ///< of edges in bicubic patches
    std::vector<std::uint32_t> otherVertices; ///< on corners and edges, neither in pieces nor on smooth edges
    std::vector<TriangleTile> rings, cells;   ///< triangles at edges, triangles between inner samples
    std::vector<std::uint32_t> firstTriangles, faceRates;
    std::vector<std::uint32_t> firstInsides; ///< vertex of each face
    std::uint64_t vertexCount = 0, triangleCount = 0, sampleCount = 0;
    std::uint32_t maxRate = 0;
};

/// Tiles and counts of a model at these rates. `makesPieces`: whether dice_edges.comp has code for pieces of edges,
/// which it has not where tables are storage buffers (SwiftShader takes long to compile it).
DiceWork planDicing(const SurfaceModel& model, const DiceTable& table, const EdgeRates& rates, bool makesPieces);

} // namespace relief
