// Internal: points of a surface as rows of weights over the cage's points.
#pragma once

#include <limits>

#include "surface/far.h"

namespace relief {

/// Each point's weights over the cage's points. Blending rows as OpenSubdiv blends points keeps one copy of them; its
/// own stencil tables are copied to append the local points.
class RowTable {
public:
    RowTable(std::size_t cagePointCount, std::size_t pointCount) : rows_(pointCount), sums_(cagePointCount) {
        entries_.reserve(kUsualWeights * pointCount);
        for (std::size_t i = 0; i < cagePointCount; ++i) {
            rows_[i] = {entries_.size(), 1};
            entries_.push_back({std::uint32_t(i), 1});
        }
    }

    struct Entry {
        std::uint32_t index;
        double weight;
    };

    /// One row as a value that OpenSubdiv can blend.
    struct Row {
        RowTable* table;
        std::size_t index;

        void Clear() { table->open(index); }                                           // NOLINT(*-identifier-naming)
        void AddWithWeight(const Row& other, double w) { table->add(other.index, w); } // NOLINT(*-identifier-naming)
    };

    /// The rows from `first` on.
    struct Rows {
        RowTable* table;
        std::size_t first;
        Row operator[](int i) const { return {table, first + i}; }
    };

    [[nodiscard]] std::size_t size() const { return rows_.size(); }
    [[nodiscard]] std::span<const Entry> row(std::size_t index) const {
        return std::span(entries_).subspan(rows_[index].first, rows_[index].count);
    }

    /// Appends a weighted sum of rows; returns the index of the new row.
    std::size_t append(std::span<const Entry> terms) {
        close();
        rows_.emplace_back();
        open(rows_.size() - 1);
        for (const Entry& term : terms) add(term.index, term.weight);
        close();
        return rows_.size() - 1;
    }

    /// Moves the open row's sums into the table.
    void close() {
        if (open_ == kNone) return;
        const std::size_t first = entries_.size();
        for (const std::uint32_t i : used_) {
            if (sums_[i] != 0) entries_.push_back({i, sums_[i]});
            sums_[i] = 0;
        }
        rows_[open_] = {first, entries_.size() - first};
        used_.clear();
        open_ = kNone;
    }

private:
    static constexpr std::size_t kUsualWeights = 16; ///< per row
    static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    struct Range {
        std::size_t first = 0, count = 0;
    };

    void open(std::size_t index) {
        close();
        open_ = index;
    }

    void add(std::size_t other, double w) {
        if (w == 0) return;
        for (const Entry& entry : row(other)) {
            double& sum = sums_[entry.index];
            if (sum == 0) used_.push_back(entry.index); // twice where a sum crosses 0: close() clears it at the first
            sum += w * entry.weight;
        }
    }

    std::vector<Range> rows_;
    std::vector<Entry> entries_;
    std::vector<double> sums_;        ///< of the open row, one per cage point
    std::vector<std::uint32_t> used_; ///< cage points that the open row has
    std::size_t open_ = kNone;
};

/// Finds the straight corners of the patches (see shared/surface.h), marks them in Patch::straightCorners and appends
/// two points per straight corner to the patch's points, with their rows to the table.
void addStraightCorners(Surface& surface, RowTable& rows);

} // namespace relief
