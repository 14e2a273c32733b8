// Pieces that cages are made of: grids of quads, tubes drawn out of a loop, square caps that close a ring.
#pragma once

#include <functional>

#include "cage_builder.h"

namespace relief::meshes {

using Loop = std::vector<std::uint32_t>;

/// Texture coordinates by row and column: `at(row, column)`, added when first asked for. Columns count modulo `period`;
/// without one a closed strip has a seam.
class TexGrid {
public:
    TexGrid(CageBuilder& builder, std::function<dvec2(int row, int column)> at, int period = 1 << 30)
        : builder_(builder), at_(std::move(at)), period_(period) {}
    std::uint32_t operator()(int row, int column) {
        column %= period_;
        auto [entry, isNew] = known_.insert({{row, column}, 0});
        if (isNew) entry->second = builder_.tex(at_(row, column));
        return entry->second;
    }

private:
    CageBuilder& builder_;
    std::function<dvec2(int, int)> at_;
    int period_;
    std::map<std::pair<int, int>, std::uint32_t> known_;
};

/// Quads between closed loops of equal length, counter-clockwise as seen from outside when a loop runs
/// counter-clockwise around the direction in which the loops follow each other. Texture columns run 0..n from the
/// loop's point `seam`.
inline void joinLoops(CageBuilder& builder, const std::vector<Loop>& loops, TexGrid& tex, std::size_t seam = 0) {
    std::size_t n = loops.front().size();
    for (std::size_t row = 0; row + 1 < loops.size(); ++row)
        for (std::size_t column = 0; column < n; ++column) {
            std::size_t a = (seam + column) % n, b = (a + 1) % n;
            int r = int(row), c = int(column);
            builder.quad({loops[row][a], tex(r, c)}, {loops[row][b], tex(r, c + 1)},
                         {loops[row + 1][b], tex(r + 1, c + 1)}, {loops[row + 1][a], tex(r + 1, c)});
        }
}

/// Where perimeter point i of a side x side grid lies, counter-clockwise from (0,0).
inline ivec2 perimeterPoint(int i, int side) {
    int along = i % side;
    switch (i / side % 4) {
    case 0: return {along, 0};
    case 1: return {side, along};
    case 2: return {side - along, side};
    default: return {0, side - along};
    }
}

/// Fills a loop of 4 * side points with side x side quads, or only up to a square of `open` x `open` in the middle,
/// whose loop it returns. `at(ring, turn)` places the points inside: `ring` falls from 1 on the loop to 0 in the
/// middle, `turn` in [0,1) runs with the loop from its first point. `layout` takes [-1,1]^2.
inline Loop capLoop(CageBuilder& builder, const Loop& loop, const std::function<dvec3(double ring, double turn)>& at,
                    const std::function<dvec2(dvec2)>& layout, int open = 0) {
    int side = int(loop.size()) / 4;
    std::map<std::pair<int, int>, Corner> corners;
    Loop inside;
    auto add = [&](ivec2 ij, std::uint32_t point) {
        corners[{ij.x, ij.y}] = {point, builder.tex(layout(2.0 * dvec2(ij) / double(side) - 1.0))};
    };
    for (int i = 0; i < 4 * side; ++i) add(perimeterPoint(i, side), loop[i]);
    for (int inner = side - 2; inner >= open; inner -= 2)
        for (int i = 0; i < std::max(1, 4 * inner); ++i) {
            ivec2 ij = ivec2((side - inner) / 2) + (inner ? perimeterPoint(i, inner) : ivec2(0));
            std::uint32_t point = builder.point(at(double(inner) / side, inner ? i / (4.0 * inner) : 0));
            add(ij, point);
            if (inner == open && open) inside.push_back(point);
        }
    int low = (side - open) / 2, high = low + open;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
            if (i < low || i >= high || j < low || j >= high)
                builder.quad(corners[{i, j}], corners[{i + 1, j}], corners[{i + 1, j + 1}], corners[{i, j + 1}]);
    return inside;
}

/// Six points around `center`, counter-clockwise as seen against side x up, from the lower left one (210 degrees); the
/// limit tube through such loops has the radii `across` along `side` and `thick` along `up`.
struct SixLoop {
    dvec3 center, side, up;
    double across, thick;
};
inline Loop addSixLoop(CageBuilder& builder, const SixLoop& six) {
    constexpr double kLimitOfHexagon = 5.0 / 6;
    Loop loop;
    for (int k = 0; k < 6; ++k) {
        double a = radians(210 + 60 * k);
        dvec3 offset = six.across * std::cos(a) * six.side + six.thick * std::sin(a) * six.up;
        loop.push_back(builder.point(six.center + offset / kLimitOfHexagon));
    }
    return loop;
}

inline dvec3 centerOf(const CageBuilder& builder, const Loop& loop) {
    dvec3 sum(0);
    for (std::uint32_t point : loop) sum += builder.position(point);
    return sum / double(loop.size());
}

/// Closes a loop of six points, counter-clockwise from outside, with two quads that share the edge between points 1
/// and 4. Their texture coordinates are a flap: points 0, 1, 2 take `tex` of row `row` at columns `left`, left+1,
/// left+2, the others the row after.
inline void closeSix(CageBuilder& builder, const Loop& loop, TexGrid& tex, int row, int left) {
    auto near = [&](int i) { return Corner{loop[i], tex(row, left + i)}; };
    auto far = [&](int i) { return Corner{loop[i], tex(row + 1, left + 5 - i)}; };
    builder.quad(near(0), near(1), far(4), far(5));
    builder.quad(near(1), near(2), far(3), far(4));
}

} // namespace relief::meshes
