// Internal: points of a surface as rows of weights over the cage's points.
#pragma once

#include <limits>
#include <optional>

#include "surface/far.h"

namespace relief {

/// Each point's weights over the cage's points. Blending rows as OpenSubdiv blends points keeps one copy of them; its
/// own stencil tables are copied to append the local points.
///
/// A refined point of many weights is shared: rows that need it name it instead of its weights. All points around a
/// vertex of n faces need that vertex, and with it all n, at every level: memory would grow with the square of n times
/// the number of levels.
class RowTable {
public:
    /// `refinedCount`: points of the cage and refined ones; local points follow.
    RowTable(std::size_t cagePointCount, std::size_t refinedCount, std::size_t pointCount)
        : cagePointCount_(cagePointCount), refinedCount_(refinedCount), rows_(pointCount), sums_(cagePointCount) {
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
    /// Points of the cage and shared rows: what entries name.
    [[nodiscard]] std::size_t namedCount() const { return sums_.size(); }

    /// Appends a weighted sum of rows; returns the index of the new row.
    std::size_t append(std::span<const Entry> terms) {
        close();
        rows_.emplace_back();
        open(rows_.size() - 1);
        for (const Entry& term : terms) add(term.index, term.weight);
        close();
        return rows_.size() - 1;
    }

    /// The weights of a row: of points of the cage, and from `cagePointCount` on of shared rows.
    [[nodiscard]] std::span<const Entry> row(std::size_t index) const {
        return std::span(entries_).subspan(rows_[index].first, rows_[index].count);
    }

    /// The shared rows, which name points of the cage alone.
    [[nodiscard]] const std::vector<std::vector<Entry>>& sharedRows() const { return sharedRows_; }

    /// The shared row that is this point, if there is one.
    [[nodiscard]] std::optional<std::uint32_t> sharedRowOf(std::size_t index) const {
        const std::span<const Entry> entries = row(index);
        if (entries.size() != 1 || entries[0].index < cagePointCount_) return {};
        return std::uint32_t(entries[0].index - cagePointCount_);
    }

    /// Moves the open row's sums into the table.
    void close() {
        if (open_ == kNone) return;
        const std::size_t index = open_, first = entries_.size();
        takeSums(entries_);
        rows_[index] = {first, entries_.size() - first};
        open_ = kNone;
        if (index < refinedCount_ && rows_[index].count > kMostWeights) share(index);
    }

private:
    static constexpr std::size_t kUsualWeights = 16; ///< per row
    static constexpr std::size_t kMostWeights = 64;  ///< of a point that is not shared: that of a vertex of 31 faces
    static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
    struct Range {
        std::size_t first = 0, count = 0;
    };

    void open(std::size_t index) {
        close();
        open_ = index;
    }

    void add(std::size_t other, double w) {
        if (w != 0) addEntries(row(other), w);
    }

    void addEntries(std::span<const Entry> entries, double w) {
        for (const Entry& entry : entries) {
            double& sum = sums_[entry.index];
            if (sum == 0) used_.push_back(entry.index); // twice where a sum crosses 0: takeSums clears it at the first
            sum += w * entry.weight;
        }
    }

    void takeSums(std::vector<Entry>& entries) {
        for (const std::uint32_t i : used_) {
            if (sums_[i] != 0) entries.push_back({i, sums_[i]});
            sums_[i] = 0;
        }
        used_.clear();
    }

    /// Replaces the latest row by its name.
    void share(std::size_t index) {
        for (const Entry& entry : row(index))
            if (entry.index < cagePointCount_)
                addEntries({&entry, 1}, 1);
            else
                addEntries(sharedRows_[entry.index - cagePointCount_], entry.weight);
        std::vector<Entry> shared;
        takeSums(shared);
        entries_.resize(rows_[index].first);
        rows_[index].count = 1;
        entries_.push_back({std::uint32_t(sums_.size()), 1});
        sums_.push_back(0);
        sharedRows_.push_back(std::move(shared));
    }

    std::size_t cagePointCount_, refinedCount_;
    std::vector<Range> rows_;
    std::vector<Entry> entries_;
    std::vector<std::vector<Entry>> sharedRows_;
    std::vector<double> sums_;        ///< of the open row, one per cage point and shared row
    std::vector<std::uint32_t> used_; ///< those that the open row has
    std::size_t open_ = kNone;
};

/// Finds the straight corners of the patches (see shared/surface.h), marks them in Patch::straightCorners and appends
/// two points per straight corner to the patch's points, with their rows to the table.
void addStraightCorners(Surface& surface, RowTable& rows);

} // namespace relief
