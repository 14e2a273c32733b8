// Stencils of refined and local points, cut down to the points that some patch uses.
#include <limits>
#include <optional>

#include "surface/far.h"

namespace relief {
namespace {

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

    /// Of points of the cage, and from `cagePointCount` on of shared rows.
    [[nodiscard]] std::span<const Entry> row(std::size_t index) const {
        return std::span(entries_).subspan(rows_[index].first, rows_[index].count);
    }

    /// Rows of points of the cage alone.
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
    static constexpr std::size_t kUsualWeights = 16; ///< a row
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
    std::vector<double> sums_;        ///< of the open row, one a cage point and shared row
    std::vector<std::uint32_t> used_; ///< those that the open row has
    std::size_t open_ = kNone;
};

RowTable makeRows(const FarTables& tables) {
    RowTable rows(tables.refiner->GetLevel(0).GetNumVertices(), tables.refiner->GetNumVerticesTotal(),
                  pointCount(tables));
    blendPoints(tables, [&](int first) { return RowTable::Rows{&rows, std::size_t(first)}; });
    rows.close();
    return rows;
}

/// Renumbers `indices` at or past `first` in order of their first use; returns the old index of each new one.
std::vector<std::uint32_t> compact(std::vector<std::uint32_t>& indices, std::uint32_t first, std::size_t count) {
    std::vector<std::uint32_t> newIndex(count, kNoPatch), oldIndex;
    for (std::uint32_t& index : indices) {
        if (index < first) continue;
        std::uint32_t& renamed = newIndex[index - first];
        if (renamed == kNoPatch) {
            renamed = first + std::uint32_t(oldIndex.size());
            oldIndex.push_back(index);
        }
        index = renamed;
    }
    return oldIndex;
}

/// Shared rows come first and stand for all points that are one. Returns the points with rows of their own, in order.
std::vector<std::uint32_t> renumberRows(Surface& surface, const RowTable& rows,
                                        const std::vector<std::uint32_t>& used) {
    std::vector<std::uint32_t> ownRows, newRows;
    for (const std::uint32_t point : used) {
        const std::optional<std::uint32_t> shared = rows.sharedRowOf(point);
        newRows.push_back(shared ? *shared : std::uint32_t(rows.sharedRows().size() + ownRows.size()));
        if (!shared) ownRows.push_back(point);
    }
    for (std::uint32_t& point : surface.patchPoints)
        if (point >= surface.controlPointCount)
            point = surface.controlPointCount + newRows[point - surface.controlPointCount];
    return ownRows;
}

void addRow(Stencils& stencils, std::span<const RowTable::Entry> row) {
    for (const RowTable::Entry& entry : row) {
        stencils.indices.push_back(entry.index);
        stencils.weights.push_back(float(entry.weight));
    }
    stencils.offsets.push_back(std::uint32_t(stencils.indices.size()));
}

} // namespace

void fillStencils(Surface& surface, FarTables tables) {
    const RowTable rows = makeRows(tables);
    surface.controlPointCount = tables.refiner->GetLevel(0).GetNumVertices();
    const auto used = compact(surface.patchPoints, surface.controlPointCount, pointCount(tables));
    tables = {}; // the largest thing in memory, and not needed beside the arrays that grow below
    const std::vector<std::uint32_t> ownRows = renumberRows(surface, rows, used);

    std::size_t weightCount = 0;
    for (const auto& row : rows.sharedRows()) weightCount += row.size();
    for (const std::uint32_t point : ownRows) weightCount += rows.row(point).size();
    Stencils& stencils = surface.stencils;
    stencils.indices.reserve(weightCount);
    stencils.weights.reserve(weightCount);
    stencils.offsets.reserve(rows.sharedRows().size() + ownRows.size() + 1);
    stencils.offsets.push_back(0);
    for (const auto& row : rows.sharedRows()) addRow(stencils, row);
    for (const std::uint32_t point : ownRows) addRow(stencils, rows.row(point));
    stencils.sharedRowCount = std::uint32_t(rows.sharedRows().size());
}

void fillTexPoints(Surface& surface, const FarTables& tables, const std::vector<vec2>& texCoords) {
    const auto points = refineAllTex(tables, texCoords);
    for (const std::uint32_t used : compact(surface.texPatchPoints, 0, points.size()))
        surface.texPoints.emplace_back(points[used].value);
}

std::vector<vec3> refinePoints(const Surface& surface, std::span<const vec3> cagePositions) {
    if (cagePositions.size() != surface.controlPointCount)
        fail(Failure::input, "{} positions were given for a cage of {} points", cagePositions.size(),
             surface.controlPointCount);
    const Stencils& stencils = surface.stencils;
    std::vector<vec3> points(cagePositions.begin(), cagePositions.end());
    points.reserve(points.size() + stencils.rowCount());
    for (std::size_t row = 0; row < stencils.rowCount(); ++row) {
        // A row's weights sum to 1; taken as offsets from one of its points, their rounding scales with the row's
        // extent and not with its distance from the origin.
        const std::uint32_t first = stencils.offsets[row];
        const dvec3 origin(points[stencils.indices[first]]);
        dvec3 offset(0);
        for (std::uint32_t k = first + 1; k < stencils.offsets[row + 1]; ++k)
            offset += double(stencils.weights[k]) * (dvec3(points[stencils.indices[k]]) - origin);
        points.emplace_back(origin + offset);
    }
    return points;
}

} // namespace relief
