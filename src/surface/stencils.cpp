// Stencils of refined and local points, cut down to the points that some patch uses.
#include <algorithm>
#include <array>
#include <cmath>

#include "surface/rows.h"

namespace relief {
namespace {

RowTable makeRows(const FarTables& tables) {
    RowTable rows(tables.refiner->GetLevel(0).GetNumVertices(), tables.refiner->GetNumVerticesTotal(),
                  pointCount(tables));
    blendPoints(tables, [&](int first) { return RowTable::Rows{&rows, std::size_t(first)}; });
    rows.close();
    return rows;
}

/// The limit points of end caps, which follow the table's points.
void addLimitRows(const EndCaps& caps, RowTable& rows) {
    for (const EndCaps::Limit& limit : caps.limits) {
        std::vector<RowTable::Entry> terms;
        for (std::size_t i = 0; i < limit.points.size(); ++i)
            terms.push_back({std::uint32_t(limit.points[i]), limit.weights[Eigen::Index(i)]});
        rows.append(terms);
    }
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

/// The lowest points of a row, in rising order.
using LowestPoints = std::array<std::uint32_t, 6>;

LowestPoints lowestPoints(std::span<const RowTable::Entry> row) {
    LowestPoints lowest;
    lowest.fill(kNoPatch);
    for (const RowTable::Entry& entry : row) {
        if (entry.index >= lowest.back()) continue;
        auto at = lowest.end() - 1;
        for (; at != lowest.begin() && *(at - 1) > entry.index; --at) *at = *(at - 1);
        *at = entry.index;
    }
    return lowest;
}

/// Brings points with rows of their own into an order where neighbours are made of nearly the same points. A device
/// makes them in this order, many at a time of a few points, and writes them one behind another.
void sortByRows(std::vector<std::uint32_t>& points, const RowTable& rows) {
    std::vector<std::pair<LowestPoints, std::uint32_t>> keyed;
    keyed.reserve(points.size());
    for (const std::uint32_t point : points) keyed.emplace_back(lowestPoints(rows.row(point)), keyed.size());
    std::ranges::sort(keyed);
    const std::vector<std::uint32_t> old = points;
    std::ranges::transform(keyed, points.begin(), [&](const auto& key) { return old[key.second]; });
}

/// Shared rows come first and stand for all points that are one. Returns the points with rows of their own, in order.
std::vector<std::uint32_t> renumberRows(Surface& surface, const RowTable& rows,
                                        const std::vector<std::uint32_t>& used) {
    std::vector<std::uint32_t> ownRows;
    for (const std::uint32_t point : used)
        if (!rows.sharedRowOf(point)) ownRows.push_back(point);
    sortByRows(ownRows, rows);
    std::vector<std::uint32_t> newRows(rows.size(), kNoPatch); // by the points' old indices
    for (std::uint32_t row = 0; row < ownRows.size(); ++row)
        newRows[ownRows[row]] = std::uint32_t(rows.sharedRows().size()) + row;
    for (std::uint32_t& point : surface.patchPoints) {
        if (point < surface.controlPointCount) continue;
        const std::uint32_t old = used[point - surface.controlPointCount];
        point = surface.controlPointCount + rows.sharedRowOf(old).value_or(newRows[old]);
    }
    return ownRows;
}

void addRow(Stencils& stencils, std::span<const RowTable::Entry> row) {
    double size = 0;
    for (const RowTable::Entry& entry : row) size += std::abs(entry.weight);
    const int scale = std::ilogb(std::max(size, 1.0)) + 1 - 31;
    stencils.scales.push_back(std::int8_t(scale));
    for (const RowTable::Entry& entry : row) {
        stencils.indices.push_back(entry.index);
        stencils.weights.push_back(std::int32_t(std::lround(std::ldexp(entry.weight, -scale))));
    }
    stencils.offsets.push_back(std::uint32_t(stencils.indices.size()));
}

} // namespace

void fillStencils(Surface& surface, FarTables tables) {
    RowTable rows = makeRows(tables);
    surface.controlPointCount = tables.refiner->GetLevel(0).GetNumVertices();
    addLimitRows(tables.caps, rows);
    addStraightCorners(surface, rows);
    const auto used = compact(surface.patchPoints, surface.controlPointCount, rows.size());
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

std::vector<dvec3> refinePoints(const Surface& surface, std::span<const vec3> cagePositions) {
    if (cagePositions.size() != surface.controlPointCount)
        fail(Failure::input, "{} positions were given for a cage of {} points", cagePositions.size(),
             surface.controlPointCount);
    const Stencils& stencils = surface.stencils;
    RELIEF_CHECK(stencils.indices.size() == stencils.weights.size());
    RELIEF_CHECK((stencils.rowCount() == 0 || stencils.offsets.back() == stencils.indices.size()));
    std::vector<dvec3> points(cagePositions.begin(), cagePositions.end());
    points.reserve(points.size() + stencils.rowCount());
    for (std::size_t row = 0; row < stencils.rowCount(); ++row) {
        // A row's weights sum to 1; taken as offsets from one of its points, their rounding scales with the row's
        // extent and not with its distance from the origin.
        const std::uint32_t first = stencils.offsets[row];
        const dvec3 origin = points[stencils.indices[first]];
        dvec3 offset(0);
        for (std::uint32_t k = first + 1; k < stencils.offsets[row + 1]; ++k)
            offset += stencils.weight(row, k) * (points[stencils.indices[k]] - origin);
        points.emplace_back(origin + offset);
    }
    return points;
}

} // namespace relief
