#include "model/dice_table.h"
#include "model/stages.h"

#include <numeric>

namespace relief {
namespace {

/// One face's use of an edge: half `half` of its side, running along `touch`.
struct EdgeUse {
    Touch touch;
    std::uint32_t half;
};

/// The places around a face where vertices of corners sit: corner s is slot s, the middle of side s slot 4 + s.
constexpr std::uint32_t kSlots = 8;

class TableBuilder {
public:
    explicit TableBuilder(const Model& model)
        : model_(model), uses_(model.edges().size()), parents_(model.faces().size() * kSlots) {
        std::iota(parents_.begin(), parents_.end(), 0);
    }

    DiceTable build() {
        gatherUses();
        joinCorners();
        table_.faceRuns.resize(model_.faces().size());
        addCornerRuns();
        addEdgeRuns();
        return std::move(table_);
    }

private:
    void gatherUses() {
        for (std::uint32_t f = 0; f < model_.faces().size(); ++f) {
            const Face& face = model_.faces()[f];
            if (face.root == kNoPatch) continue;
            for (std::uint32_t side = 0; side < std::uint32_t(model_.sideCount()); ++side) {
                const std::uint32_t entry = face.sides[side], edge = entry & kSideEdgeMask;
                const std::uint32_t halves = (entry & kSideSplit) != 0 ? 2 : 1;
                for (std::uint32_t half = 0; half < halves; ++half) {
                    Touch touch{f, side, float(half) / float(halves), float(half + 1) / float(halves)};
                    if ((entry & kSideReversed) != 0) touch.start = 1 - touch.start, touch.end = 1 - touch.end;
                    uses_[edge + half].push_back({touch, half});
                }
            }
        }
    }

    /// True when faces along the edge need vertices of their own.
    [[nodiscard]] bool isParted(std::uint32_t edge) const {
        const Edge& e = model_.edges()[edge];
        return uses_[edge].size() > 1 && (e.touchCount > 0 || (e.flags & kPlaceOnSeam) != 0);
    }

    [[nodiscard]] std::uint32_t slotAt(const Touch& touch, float x) const {
        const auto sides = std::uint32_t(model_.sideCount());
        return touch.face * kSlots + (x == 0 ? touch.side : x == 1 ? (touch.side + 1) % sides : 4 + touch.side);
    }

    std::uint32_t rootOf(std::uint32_t slot) {
        while (parents_[slot] != slot) slot = parents_[slot] = parents_[parents_[slot]];
        return slot;
    }

    void joinCorners() {
        for (std::uint32_t edge = 0; edge < uses_.size(); ++edge) {
            if (isParted(edge)) continue;
            for (const EdgeUse& use : uses_[edge])
                for (const bool atEnd : {false, true}) {
                    const auto slot = [&](const Touch& t) { return rootOf(slotAt(t, atEnd ? t.end : t.start)); };
                    parents_[slot(use.touch)] = slot(uses_[edge].front().touch);
                }
        }
    }

    void addCornerRuns() {
        std::vector<std::uint32_t> runOfRoot(parents_.size(), kNoPatch);
        for (std::uint32_t edge = 0; edge < uses_.size(); ++edge)
            for (const EdgeUse& use : uses_[edge])
                for (const bool atEnd : {false, true}) {
                    const float x = atEnd ? use.touch.end : use.touch.start;
                    const std::uint32_t slot = slotAt(use.touch, x);
                    std::uint32_t& run = runOfRoot[rootOf(slot)];
                    if (run == kNoPatch) {
                        run = std::uint32_t(table_.runs.size());
                        table_.runs.push_back(
                            {{use.touch.face, use.touch.side, x, x}, model_.edges()[edge].corners[atEnd ? 1 : 0], 1});
                    }
                    FaceRuns& runs = table_.faceRuns[use.touch.face];
                    const std::uint32_t place = slot % kSlots;
                    (place < 4 ? runs.corners[place] : runs.middles[place - 4]) = run;
                }
        table_.cornerRunCount = std::uint32_t(table_.runs.size());
    }

    void addEdgeRuns() {
        for (std::uint32_t edge = 0; edge < uses_.size(); ++edge)
            if (!isSmooth(edge)) addRunsOf(edge);
        table_.firstSmoothRun = std::uint32_t(table_.runs.size());
        for (std::uint32_t edge = 0; edge < uses_.size(); ++edge)
            if (isSmooth(edge)) addRunsOf(edge);
    }

    /// One run of vertices, all in one patch of the owner, which alone decides where they lie.
    [[nodiscard]] bool isSmooth(std::uint32_t edge) const {
        const Edge& record = model_.edges()[edge];
        if (model_.isTriangles() || record.touchCount > 0 || uses_[edge].empty() || isParted(edge)) return false;
        const std::uint32_t root = model_.faces()[record.owner.face].root;
        return uses_[edge].front().touch.face == record.owner.face && root != kNoPatch && (root & kLeafBit) != 0 &&
               model_.isRegular(root & ~kLeafBit);
    }

    void addRunsOf(std::uint32_t edge) {
        for (std::size_t i = 0; i < uses_[edge].size(); ++i) {
            const EdgeUse& use = uses_[edge][i];
            if (i == 0 || isParted(edge)) table_.runs.push_back({use.touch, edge, 0});
            table_.faceRuns[use.touch.face].sides[2 * use.touch.side + use.half] =
                std::uint32_t(table_.runs.size() - 1);
        }
    }

    const Model& model_;
    std::vector<std::vector<EdgeUse>> uses_; ///< of each edge, by face index: the owner first
    std::vector<std::uint32_t> parents_;     ///< of slots that share a vertex (union-find)
    DiceTable table_;
};

void addLeaves(const Model& model, std::uint32_t entry, const LeafSquare& at, std::vector<LeafSquare>& leaves) {
    if (entry == kNoPatch) return;
    if ((entry & kLeafBit) != 0) {
        leaves.push_back({entry & ~kLeafBit, at.depth, at.u, at.v});
        return;
    }
    for (std::uint32_t child = 0; child < 4; ++child)
        addLeaves(model, model.tree()[entry + child], {0, at.depth + 1, 2 * at.u + child % 2, 2 * at.v + child / 2},
                  leaves);
}

} // namespace

DiceTable makeDiceTable(Device& device, const Model& model) {
    DiceTable table = TableBuilder(model).build();
    std::vector<std::uint32_t> words;
    appendRecords<kRunTexels>(words, table.runs);
    table.firstFaceRuns = appendRecords<kFaceRunsTexels>(words, table.faceRuns);
    table.texels =
        uploadTexels(device, {.name = "dice table"}, VK_FORMAT_R32G32B32A32_UINT, std::as_bytes(std::span(words)));
    return table;
}

const DiceTable& Model::diceTable(Device& device) const {
    if (!diceTable_) diceTable_ = std::make_unique<DiceTable>(makeDiceTable(device, *this));
    return *diceTable_;
}

std::vector<char> boundaryVertices(Device& device, const Model& model, const DicedMesh& mesh) {
    const DiceTable& table = model.diceTable(device);
    std::vector<char> isOnBoundary(mesh.vertexCount, 0);
    for (std::size_t i = 0; i < table.runs.size(); ++i) {
        const VertexRun& run = table.runs[i];
        const std::uint32_t flags = run.isCorner != 0 ? model.cornerFlags()[run.place] : model.edges()[run.place].flags;
        if ((flags & kPlaceOnBoundary) == 0) continue;
        for (std::uint32_t v = mesh.runFirsts[i]; v < mesh.runFirsts[i + 1]; ++v) isOnBoundary[v] = 1;
    }
    return isOnBoundary;
}

std::vector<LeafSquare> leavesOf(const Model& model, std::uint32_t face) {
    std::vector<LeafSquare> leaves;
    addLeaves(model, model.faces()[face].root, {}, leaves);
    return leaves;
}

} // namespace relief
