#include <algorithm>
#include <cmath>
#include <numeric>

#include "pose/stages.h"

namespace relief {
namespace {

std::span<const std::uint32_t> pointsOf(const Stencils& stencils, std::uint32_t row) {
    return std::span(stencils.indices)
        .subspan(stencils.offsets[row], stencils.offsets[row + 1] - stencils.offsets[row]);
}

/// Rows from `firstRow` to before `endRow` by their points, each row's in rising order: neighbours have most of them in
/// common.
std::vector<std::uint32_t> rowsByPoints(const Stencils& stencils, std::uint32_t firstRow, std::uint32_t endRow) {
    std::vector<std::uint32_t> sorted = stencils.indices;
    std::vector<std::uint32_t> rows(endRow - firstRow);
    std::iota(rows.begin(), rows.end(), firstRow);
    const auto range = [&](std::uint32_t row) {
        return std::pair(sorted.begin() + stencils.offsets[row], sorted.begin() + stencils.offsets[row + 1]);
    };
    for (const std::uint32_t row : rows) std::sort(range(row).first, range(row).second);
    std::ranges::stable_sort(rows, [&](std::uint32_t a, std::uint32_t b) {
        const auto [a0, a1] = range(a);
        const auto [b0, b1] = range(b);
        return std::lexicographical_compare(a0, a1, b0, b1);
    });
    return rows;
}

std::uint32_t roundedUp(std::size_t count) {
    return std::uint32_t((count + kEntriesTogether - 1) / kEntriesTogether * kEntriesTogether);
}

/// Rows that make a block, and the points that they use.
struct Draft {
    std::vector<std::uint32_t> rows, points;
};

/// Brings the point with the largest weights to the front: rows lie near it, so that offsets from it are short.
void bringHeaviestToFront(const Stencils& stencils, Draft& draft, std::vector<double>& weightOf) {
    for (const std::uint32_t point : draft.points) weightOf[point] = 0;
    for (const std::uint32_t row : draft.rows)
        for (std::uint32_t k = stencils.offsets[row]; k < stencils.offsets[row + 1]; ++k)
            weightOf[stencils.indices[k]] += std::abs(stencils.weight(row, k));
    std::iter_swap(draft.points.begin(),
                   std::ranges::max_element(draft.points, {}, [&](std::uint32_t p) { return weightOf[p]; }));
}

/// Splits rows in order into blocks. A row that would need more points than suits the block begins the next one.
std::vector<Draft> drafts(const Stencils& stencils, std::uint32_t firstRow, std::uint32_t endRow) {
    constexpr std::uint32_t kUsualEntries = 24;
    std::vector<Draft> all;
    std::vector<std::size_t> latest; ///< the draft that has each point
    const auto isIn = [&](std::uint32_t point) { return latest[point] == all.size(); };
    latest.resize(1 + (stencils.indices.empty() ? 0 : *std::ranges::max_element(stencils.indices)), 0);
    for (const std::uint32_t row : rowsByPoints(stencils, firstRow, endRow)) {
        const std::span<const std::uint32_t> points = pointsOf(stencils, row);
        if (!all.empty()) {
            const auto more = std::size_t(std::ranges::count_if(points, [&](std::uint32_t p) { return !isIn(p); }));
            const std::size_t most = std::max(kUsualEntries, roundedUp(points.size()));
            if (all.back().rows.size() == kBlockRows || all.back().points.size() + more > most) all.emplace_back();
        } else {
            all.emplace_back();
        }
        all.back().rows.push_back(row);
        for (const std::uint32_t point : points)
            if (!isIn(point)) {
                latest[point] = all.size();
                all.back().points.push_back(point);
            }
    }
    std::vector<double> weightOf(latest.size());
    for (Draft& draft : all) bringHeaviestToFront(stencils, draft, weightOf);
    return all;
}

/// Appends a block of that many entries. `indexInBlock`: scratch memory, per point its index within the block.
void addBlock(const Stencils& stencils, const Draft& draft, std::uint32_t entryCount,
              std::vector<std::uint32_t>& indexInBlock, StencilBlocks& blocks) {
    const std::size_t first = blocks.entries.size();
    for (std::size_t i = 0; i < draft.points.size(); ++i) indexInBlock[draft.points[i]] = std::uint32_t(i);
    blocks.entries.insert(blocks.entries.end(), draft.points.begin(), draft.points.end());
    blocks.entries.resize(first + entryCount, draft.points.front());
    blocks.weights.resize(blocks.entries.size() * kBlockRows, 0);
    for (std::size_t lane = 0; lane < kBlockRows; ++lane) {
        blocks.targets.push_back(lane < draft.rows.size() ? draft.rows[lane] : kNoPatch);
        if (lane >= draft.rows.size()) continue;
        const std::uint32_t row = draft.rows[lane];
        for (std::uint32_t k = stencils.offsets[row]; k < stencils.offsets[row + 1]; ++k) {
            const std::size_t entry = first + indexInBlock[stencils.indices[k]], vector = entry / 4 * kBlockRows + lane;
            blocks.weights[4 * vector + entry % 4] = stencils.weights[k];
        }
    }
    blocks.firsts.push_back(std::uint32_t(blocks.entries.size()));
}

/// The entries of each draft's block, for drafts in rising order of their points. A few blocks get as many as the next
/// larger ones have: a dispatch of their own takes more time than their weights of 0.
std::vector<std::uint32_t> entryCounts(std::span<const Draft> drafts) {
    constexpr std::size_t kFewBlocks = 1000;
    std::vector<std::uint32_t> counts;
    for (const Draft& draft : drafts) counts.push_back(roundedUp(draft.points.size()));
    for (auto first = counts.begin(); first != counts.end();) {
        const auto end = std::upper_bound(first, counts.end(), *first);
        if (std::size_t(end - first) < kFewBlocks && end != counts.end() && *end <= kStraightEntries)
            std::fill(first, end, *end);
        else
            first = end;
    }
    return counts;
}

} // namespace

StencilBlocks stencilBlocks(const Stencils& stencils) {
    StencilBlocks blocks;
    blocks.firsts.push_back(0);
    std::vector<std::uint32_t> indexInBlock;
    indexInBlock.resize(1 + (stencils.indices.empty() ? 0 : *std::ranges::max_element(stencils.indices)));
    for (const Draft& draft : drafts(stencils, 0, stencils.sharedRowCount))
        addBlock(stencils, draft, roundedUp(draft.points.size()), indexInBlock, blocks);
    blocks.sharedBlockCount = std::uint32_t(blocks.blockCount());

    std::vector<Draft> all = drafts(stencils, stencils.sharedRowCount, std::uint32_t(stencils.rowCount()));
    std::ranges::stable_sort(all, {}, [](const Draft& draft) { return roundedUp(draft.points.size()); });
    const std::vector<std::uint32_t> counts = entryCounts(all);
    for (std::size_t i = 0; i < all.size(); ++i) {
        const std::uint32_t entryCount = counts[i];
        if (blocks.classes.empty() || blocks.classes.back().entryCount != entryCount)
            blocks.classes.push_back({entryCount, std::uint32_t(blocks.blockCount()), 0});
        ++blocks.classes.back().blockCount;
        addBlock(stencils, all[i], entryCount, indexInBlock, blocks);
    }
    return blocks;
}

} // namespace relief
