#include "triangles/dice_work.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "shared/dice.h"
#include "shared/rates.h"

namespace relief {
namespace {

constexpr std::uint32_t kTileSamples = 1024; ///< of the insides of faces: enough for one load of control points
/// With a height function. Mesa 22.3's CPU driver gives all loops of an invocation together 65,535 turns: those over
/// the samples of a tile are to leave kMostFunctionTurns for each evaluation.
constexpr std::uint32_t kFunctionTileSamples = 64;

std::uint32_t packed(std::uint32_t low, std::uint32_t high) { return low | high << 16; }

/// The smallest i with i / n >= cell / 2^depth, and at least 1: the border of a face belongs to its edges.
std::uint32_t firstIn(std::uint32_t cell, std::uint32_t depth, std::uint32_t n) {
    const std::uint64_t scale = std::uint64_t(1) << depth;
    return std::max(std::uint32_t((std::uint64_t(cell) * n + scale - 1) / scale), 1u);
}

class WorkBuilder {
public:
    WorkBuilder(const SurfaceModel& model, const DiceTable& table, const EdgeRates& rates, bool makesPieces,
                std::uint64_t pieceTriangles)
        : model_(model), table_(table), rates_(rates), makesPieces_(makesPieces), pieceTriangles_(pieceTriangles) {}

    DiceWork build() {
        addRuns();
        work_.pieces.emplace_back();
        for (std::uint32_t face = 0; face < model_.faces.size(); ++face) {
            work_.firstTriangles.push_back(std::uint32_t(work_.triangleCount));
            work_.faceRates.push_back(0);
            work_.firstInsides.push_back(0);
            if (model_.faces[face].root != kNoPatch) addFace(face);
        }
        work_.firstTriangles.push_back(std::uint32_t(work_.triangleCount));
        sortInsides();
        return std::move(work_);
    }

private:
    [[nodiscard]] DicePiece& piece() { return work_.pieces.back(); }
    /// Of the piece: those on edges come first.
    [[nodiscard]] std::uint64_t nextVertex() { return work_.runVertexCount + piece().insideVertexCount; }

    void addInsideVertices(std::uint64_t count) {
        piece().insideVertexCount += count;
        work_.vertexCount += count;
        work_.sampleCount += count;
    }

    /// The tiles of regular patches come first, each kind in the order of pieces.
    void sortInsides() {
        const auto others = std::stable_partition(work_.insides.begin(), work_.insides.end(),
                                                  [&](const InsideTile& tile) { return isRegular(tile); });
        std::size_t regular = 0, other = std::size_t(others - work_.insides.begin()), ring = 0, cell = 0;
        for (DicePiece& each : work_.pieces) {
            each.regularInsides.first = std::exchange(regular, regular + each.regularInsides.count);
            each.otherInsides.first = std::exchange(other, other + each.otherInsides.count);
            each.rings.first = std::exchange(ring, ring + each.rings.count);
            each.cells.first = std::exchange(cell, cell + each.cells.count);
        }
    }

    void addRuns() {
        for (const VertexRun& run : table_.runs) {
            work_.runFirsts.push_back(std::uint32_t(work_.vertexCount));
            work_.vertexCount += run.isCorner != 0 ? 1 : rates_.segments(run.element) - 1;
        }
        for (std::uint32_t run = 0; run < table_.firstSmoothRun; ++run) splitRun(run);
        work_.runFirsts.push_back(std::uint32_t(work_.vertexCount));
        work_.runVertexCount = work_.vertexCount;
        work_.sampleCount = model_.cornerFlags.size();
        for (std::uint32_t edge = 0; edge < model_.edges.size(); ++edge) work_.sampleCount += rates_.segments(edge) - 1;
    }

    /// The samples of a run in bicubic patches become a piece, the others are listed.
    void splitRun(std::uint32_t run) {
        const std::uint32_t edge = table_.runs[run].element, vertex = work_.runFirsts[run];
        if (table_.runs[run].isCorner != 0) return work_.otherVertices.push_back(vertex);
        const std::uint32_t n = rates_.segments(edge);
        const auto [first, end] =
            makesPieces_ ? samplesIn(table_.bicubicSpans[run], n, rates_.rates[edge]) : std::pair{n, n};
        if (first < end) work_.edgePieces.push_back({run, first, end, 0});
        for (std::uint32_t k = 1; k < n; ++k)
            if (k < first || k >= end) work_.otherVertices.push_back(vertex + k - 1);
    }

    void addFace(std::uint32_t face) {
        const FaceSegments f = faceSegments(model_, rates_, face);
        work_.faceRates.back() = std::uint32_t(std::ceil(f.largestRate));
        work_.maxRate = std::max(work_.maxRate, work_.faceRates.back());
        const std::uint64_t triangles = dicedTriangles({f.sides, std::size_t(model_.sideCount)});
        if (piece().triangleCount > 0 && piece().triangleCount + triangles > pieceTriangles_)
            work_.pieces.emplace_back();
        const auto firstVertex = std::uint32_t(nextVertex());
        work_.firstInsides.back() = firstVertex;
        const auto sides = std::uint32_t(model_.sideCount);
        const uvec2 lattice = formulas::latticeSegments(sides, f.sides[0], f.sides[1], f.sides[2], f.sides[3]);
        // A face of one segment per side has no lattice: all its triangles are at edges.
        const std::uint64_t cells = std::max(f.u, f.v) == 1 ? 0 : formulas::cellTriangles(sides, lattice);
        const std::uint64_t atEdges = triangles - cells;
        // Triangles at edges and those of the lattice go to two passes, in tiles of one work group each.
        const auto addTiles = [&](std::vector<TriangleTile>& tiles, DiceRange& range, std::uint64_t first,
                                  std::uint64_t end) {
            for (; first < end; first += kTrianglesPerTile, ++range.count)
                tiles.push_back(
                    {face, std::uint32_t(first), std::uint32_t(piece().triangleCount + first), firstVertex});
        };
        addTiles(work_.rings, piece().rings, 0, atEdges);
        addTiles(work_.cells, piece().cells, atEdges, triangles);
        piece().triangleCount += triangles;
        work_.triangleCount += triangles;
        // Samples inside the face; those on edges and in corners are added per edge and corner.
        if (std::max(f.u, f.v) == 1) return;
        if (model_.isTriangles())
            addTriangleInside(face, formulas::atLeastInner(3, f.u));
        else
            addQuadInside(face, f);
    }

    void addTriangleInside(std::uint32_t face, std::uint32_t n) {
        addTiles({face, 0, 0, 0, packed(n, n), 0, 0, std::uint32_t(nextVertex())}, {1, 1}, {n - 1, n - 1});
        addInsideVertices(std::uint64_t(n - 1) * (n - 2) / 2);
    }

    void addQuadInside(std::uint32_t face, const FaceSegments& f) {
        const std::uint32_t m = formulas::atLeastInner(4, f.u), n = formulas::atLeastInner(4, f.v);
        for (const TreeLeaf& leaf : leavesOf(model_.tree, model_.faces[face].root)) {
            // Fractional samples are not at i/m: which leaf they fall in is found by looking.
            const std::uint32_t i0 = firstSample(leaf.u, leaf.depth, m, f.rateU),
                                i1 = firstSample(leaf.u + 1, leaf.depth, m, f.rateU);
            const std::uint32_t j0 = firstSample(leaf.v, leaf.depth, n, f.rateV),
                                j1 = firstSample(leaf.v + 1, leaf.depth, n, f.rateV);
            addTiles({face, leaf.patchIndex, 0, 0, packed(m, n), leaf.depth, packed(leaf.u, leaf.v),
                      std::uint32_t(nextVertex())},
                     {i0, j0}, {i1, j1});
        }
        addInsideVertices(std::uint64_t(m - 1) * (n - 1));
    }

    [[nodiscard]] bool isRegular(const InsideTile& tile) const {
        return !model_.isTriangles() && model_.patchIsRegular[tile.patchIndex];
    }

    /// Tiles of the samples from `first` up to `end`, as wide as possible.
    void addTiles(InsideTile tile, const uvec2& first, const uvec2& end) {
        if (first.x >= end.x) return;
        const std::uint32_t most = model_.function ? kFunctionTileSamples : kTileSamples;
        const std::uint32_t columns = std::min(end.x - first.x, most), rows = std::max(most / columns, 1u);
        for (std::uint32_t j = first.y; j < end.y; j += rows)
            for (std::uint32_t i = first.x; i < end.x; i += columns) {
                tile.firstIJ = packed(i, j);
                tile.sizeIJ = packed(std::min(columns, end.x - i), std::min(rows, end.y - j));
                work_.insides.push_back(tile);
                ++(isRegular(tile) ? piece().regularInsides : piece().otherInsides).count;
            }
    }

    /// The first inner sample at or past cell / 2^depth, at most n.
    [[nodiscard]] std::uint32_t firstSample(std::uint32_t cell, std::uint32_t depth, std::uint32_t n,
                                            float rate) const {
        if (rates_.spacing == Spacing::equal) return std::min(firstIn(cell, depth, n), n);
        const float bound = std::ldexp(float(cell), -int(depth));
        std::uint32_t i = 1;
        while (i < n && formulas::sampleParameter(i, n, rate) < bound) ++i;
        return i;
    }

    const SurfaceModel& model_;
    const DiceTable& table_;
    const EdgeRates& rates_;
    bool makesPieces_;
    std::uint64_t pieceTriangles_;
    DiceWork work_;
};

} // namespace

std::uint64_t DiceWork::mostVertices() const {
    std::uint64_t most = 0;
    for (const DicePiece& piece : pieces) most = std::max(most, piece.insideVertexCount);
    return runVertexCount + most;
}

std::uint64_t DiceWork::mostTriangles() const {
    std::uint64_t most = 0;
    for (const DicePiece& piece : pieces) most = std::max(most, piece.triangleCount);
    return most;
}

DiceWork planDicing(const SurfaceModel& model, const DiceTable& table, const EdgeRates& rates, bool makesPieces,
                    std::uint64_t pieceTriangles) {
    return WorkBuilder(model, table, rates, makesPieces, pieceTriangles).build();
}

} // namespace relief
