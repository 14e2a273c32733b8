#include "triangles/dice_table.h"
#include "shared/rates.h"
#include "triangles/stages.h"

#include <cmath>
#include <numeric>

namespace relief {
namespace {

/// Slots around a face for the vertices of corners: corner s is slot s, the middle of side s slot 4 + s.
constexpr std::uint32_t kSlots = 8;

class TableBuilder {
public:
    explicit TableBuilder(const SurfaceModel& model)
        : model_(model), incidences_(edgeIncidences(model.faces, model.sideCount, model.edges.size())),
          parents_(model.faces.size() * kSlots) {
        std::iota(parents_.begin(), parents_.end(), 0);
    }

    DiceTable build() {
        joinCorners();
        table_.faceRuns.resize(model_.faces.size());
        addCornerRuns();
        addEdgeRuns();
        for (std::uint32_t run = 0; run < table_.firstSmoothRun; ++run)
            table_.bicubicSpans.push_back(findBicubicSpan(table_.runs[run]));
        return std::move(table_);
    }

private:
    /// True when faces along the edge need vertices of their own.
    [[nodiscard]] bool isSplit(std::uint32_t edge) const {
        const Edge& e = model_.edges[edge];
        return incidences_.of(edge).size() > 1 && (e.incidenceCount > 0 || (e.flags & kOnSeam) != 0);
    }

    /// 1 for the second edge of a split side.
    [[nodiscard]] std::uint32_t halfOf(const Incidence& incidence, std::uint32_t edge) const {
        return edge - (model_.faces[incidence.face].sides[incidence.side] & kSideEdgeMask);
    }

    [[nodiscard]] std::uint32_t slotAt(const Incidence& incidence, float x) const {
        const auto sides = std::uint32_t(model_.sideCount);
        return incidence.face * kSlots + (x == 0   ? incidence.side
                                          : x == 1 ? (incidence.side + 1) % sides
                                                   : 4 + incidence.side);
    }

    std::uint32_t rootOf(std::uint32_t slot) {
        while (parents_[slot] != slot) slot = parents_[slot] = parents_[parents_[slot]];
        return slot;
    }

    void joinCorners() {
        for (std::uint32_t edge = 0; edge < model_.edges.size(); ++edge) {
            if (isSplit(edge)) continue;
            for (const Incidence& incidence : incidences_.of(edge))
                for (const bool atEnd : {false, true}) {
                    const auto slot = [&](const Incidence& t) { return rootOf(slotAt(t, atEnd ? t.end : t.start)); };
                    parents_[slot(incidence)] = slot(incidences_.of(edge).front());
                }
        }
    }

    void addCornerRuns() {
        std::vector<std::uint32_t> runOfRoot(parents_.size(), kNoPatch);
        for (std::uint32_t edge = 0; edge < model_.edges.size(); ++edge)
            for (const Incidence& incidence : incidences_.of(edge))
                for (const bool atEnd : {false, true}) {
                    const float x = atEnd ? incidence.end : incidence.start;
                    const std::uint32_t slot = slotAt(incidence, x);
                    std::uint32_t& run = runOfRoot[rootOf(slot)];
                    if (run == kNoPatch) {
                        run = std::uint32_t(table_.runs.size());
                        table_.runs.push_back(
                            {{incidence.face, incidence.side, x, x}, model_.edges[edge].corners[atEnd ? 1 : 0], 1});
                    }
                    FaceRuns& runs = table_.faceRuns[incidence.face];
                    const std::uint32_t number = slot % kSlots;
                    (number < 4 ? runs.corners[number] : runs.middles[number - 4]) = run;
                }
        table_.cornerRunCount = std::uint32_t(table_.runs.size());
    }

    void addEdgeRuns() {
        for (std::uint32_t edge = 0; edge < model_.edges.size(); ++edge)
            if (!isSmooth(edge)) addRunsOf(edge);
        table_.firstSmoothRun = std::uint32_t(table_.runs.size());
        for (std::uint32_t edge = 0; edge < model_.edges.size(); ++edge)
            if (isSmooth(edge)) addRunsOf(edge);
    }

    /// True for an edge with one run of vertices, all of them evaluated in one patch of the owner.
    /// With a height function each vertex has an invocation of its own (kMostFunctionTurns).
    [[nodiscard]] bool isSmooth(std::uint32_t edge) const {
        if (model_.function) return false;
        const Edge& record = model_.edges[edge];
        if (model_.isTriangles() || record.incidenceCount > 0 || incidences_.of(edge).empty() || isSplit(edge))
            return false;
        const std::uint32_t root = model_.faces[record.owner.face].root;
        return incidences_.of(edge).front().face == record.owner.face && root != kNoPatch && (root & kLeafBit) != 0 &&
               model_.patchIsRegular[root & ~kLeafBit];
    }

    /// Samples of a run can be told by the patch alone where they belong to the owner and share no direction with other
    /// faces.
    [[nodiscard]] BicubicSpan findBicubicSpan(const VertexRun& run) const {
        if (run.isCorner != 0 || model_.isTriangles() || model_.function) return {};
        const Edge& edge = model_.edges[run.element];
        const Incidence& owner = edge.owner;
        const std::uint32_t root = model_.faces[owner.face].root;
        if (edge.incidenceCount > 0 || run.incidence.face != owner.face || run.incidence.side != owner.side ||
            root == kNoPatch)
            return {};
        // What lies between the other patches at both ends: they are there, around extraordinary vertices.
        constexpr float kMargin = 1e-5f; // a device may round t otherwise
        BicubicSpan span{-1, 2};
        for (const TreeLeaf& leaf : leavesOf(model_.tree, root)) {
            if (model_.patchIsRegular[leaf.patchIndex] || !meetsSide(leaf, owner.side)) continue;
            const float from = toEdge(owner, firstAlong(leaf, owner.side)), size = std::ldexp(1.0f, -int(leaf.depth)),
                        to = from + size / std::abs(owner.end - owner.start);
            if (to <= 0 || from >= 1) continue;
            if (from <= 0)
                span.low = std::max(span.low, to + kMargin);
            else
                span.high = std::min(span.high, from - kMargin);
        }
        return span;
    }

    static bool meetsSide(const TreeLeaf& leaf, std::uint32_t side) {
        const std::uint32_t last = (1u << leaf.depth) - 1;
        return side == 0 ? leaf.v == 0 : side == 1 ? leaf.u == last : side == 2 ? leaf.v == last : leaf.u == 0;
    }

    /// Where a leaf begins along a side of its face, in the side's direction.
    static float firstAlong(const TreeLeaf& leaf, std::uint32_t side) {
        const std::uint32_t last = (1u << leaf.depth) - 1;
        const std::uint32_t cell = side == 0 ? leaf.u : side == 1 ? leaf.v : side == 2 ? last - leaf.u : last - leaf.v;
        return std::ldexp(float(cell), -int(leaf.depth));
    }

    /// t of an edge at x of its owner's side.
    static float toEdge(const Incidence& owner, float x) { return (x - owner.start) / (owner.end - owner.start); }

    void addRunsOf(std::uint32_t edge) {
        for (std::size_t i = 0; i < incidences_.of(edge).size(); ++i) {
            const Incidence& incidence = incidences_.of(edge)[i];
            if (i == 0 || isSplit(edge)) table_.runs.push_back({incidence, edge, 0});
            table_.faceRuns[incidence.face].sides[2 * incidence.side + halfOf(incidence, edge)] =
                std::uint32_t(table_.runs.size() - 1);
        }
    }

    const SurfaceModel& model_;
    EdgeIncidences incidences_;
    std::vector<std::uint32_t> parents_; ///< of slots that share a vertex (union-find)
    DiceTable table_;
};

} // namespace

std::pair<std::uint32_t, std::uint32_t> samplesIn(const BicubicSpan& span, std::uint32_t n, float rate) {
    if (span.low >= span.high) return {1, 1};
    std::uint32_t first = 1;
    while (first < n && formulas::sampleParameter(first, n, rate) <= span.low) ++first;
    std::uint32_t end = first;
    while (end < n && formulas::sampleParameter(end, n, rate) < span.high) ++end;
    return {first, end};
}

DiceTable makeDiceTable(Device& device, const SurfaceModel& model) {
    DiceTable table = TableBuilder(model).build();
    std::vector<std::uint32_t> words;
    appendRecords<kRunTexels>(words, table.runs);
    table.firstFaceRuns = appendRecords<kFaceRunsTexels>(words, table.faceRuns);
    table.texels =
        uploadTexels(device, {.name = "dice table"}, VK_FORMAT_R32G32B32A32_UINT, std::as_bytes(std::span(words)));
    return table;
}

namespace {

/// First vertices in place of the numbers of runs. Slots that a face does not use hold run 0.
FaceRuns firstVertices(FaceRuns runs, std::span<const std::uint32_t> runFirsts) {
    for (uint& run : runs.corners) run = runFirsts[run];
    for (uint& run : runs.middles) run = runFirsts[run];
    for (uint& run : runs.sides) run = runFirsts[run];
    return runs;
}

} // namespace

std::vector<DicedFacePush> facePushes(const DiceTable& table, const SurfaceModel& model, const EdgeRates& rates,
                                      std::span<const std::uint32_t> runFirsts,
                                      std::span<const std::uint32_t> firstInsides) {
    std::vector<DicedFacePush> pushes(model.faces.size());
    for (std::uint32_t face = 0; face < pushes.size(); ++face) {
        DicedFacePush& push = pushes[face];
        push = {
            .face = face, .firstInside = firstInsides[face], .runs = firstVertices(table.faceRuns[face], runFirsts)};
        for (int side = 0; side < model.sideCount; ++side) {
            const std::uint32_t entry = model.faces[face].sides[side], edge = entry & kSideEdgeMask;
            const std::uint32_t halves = (entry & kSideSplit) != 0 ? 2 : 1;
            push.sides[side] = entry;
            push.segments[side] = halves * rates.segments(edge);
            push.rates[side] = float(halves) * rates.rates[edge];
        }
    }
    return pushes;
}

std::vector<char> boundaryVertices(const DiceTable& table, const SurfaceModel& model, const DicedMesh& mesh) {
    std::vector<char> isOnBoundary(mesh.vertexCount, 0);
    for (std::size_t i = 0; i < table.runs.size(); ++i) {
        const VertexRun& run = table.runs[i];
        const std::uint32_t flags = run.isCorner != 0 ? model.cornerFlags[run.element] : model.edges[run.element].flags;
        if ((flags & kOnBoundary) == 0) continue;
        for (std::uint32_t v = mesh.runFirsts[i]; v < mesh.runFirsts[i + 1]; ++v) isOnBoundary[v] = 1;
    }
    return isOnBoundary;
}

} // namespace relief
