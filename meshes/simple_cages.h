// The plain cages: cube, torus, plane, ball.
#pragma once

#include "grid.h"

namespace relief::meshes {

/// A box of 2 units: upright edges infinitely sharp and semi-sharp in turn, a soft rim above, a sharp one below. The
/// sides wrap around the texture four times (s = 0..4), so that a tileable map runs on around the corners.
inline Cage makeCube() {
    CageBuilder cage;
    Loop below, above;
    for (const dvec2& c : {dvec2(-1, 1), dvec2(1, 1), dvec2(1, -1), dvec2(-1, -1)})
        below.push_back(cage.point({c.x, -1, c.y}));
    for (int i = 0; i < 4; ++i) above.push_back(cage.point(cage.position(below[i]) + dvec3(0, 2, 0)));
    TexGrid side(cage, [](int row, int column) { return dvec2(column, row); });
    joinLoops(cage, {below, above}, side);
    auto square = [&](const Loop& loop) {
        TexGrid tex(cage, [](int row, int column) { return dvec2(column, row); });
        cage.quad({loop[0], tex(0, 0)}, {loop[1], tex(0, 1)}, {loop[2], tex(1, 1)}, {loop[3], tex(1, 0)});
    };
    square(above);
    square({below[3], below[2], below[1], below[0]});
    for (int i = 0; i < 4; ++i) {
        int next = (i + 1) % 4;
        cage.crease(below[i], above[i], i % 2 ? 3 : 10);
        cage.crease(above[i], above[next], 2);
        cage.crease(below[i], below[next], 10);
    }
    return cage.finish("cube");
}

/// Radii 1 and 0.42 around the Y axis; s runs around the axis, t around the tube, each with one seam.
inline Cage makeTorus() {
    constexpr int kAround = 16, kTube = 8;
    CageBuilder cage;
    std::vector<Loop> loops(kAround);
    for (int i = 0; i < kAround; ++i)
        for (int j = 0; j < kTube; ++j) {
            double a = 2 * kPi * i / kAround, b = 2 * kPi * j / kTube, radius = 1 + 0.42 * std::cos(b);
            loops[i].push_back(cage.point({radius * std::sin(a), 0.42 * std::sin(b), radius * std::cos(a)}));
        }
    TexGrid tex(cage, [](int row, int column) { return dvec2(double(column) / kAround, double(row) / kTube); });
    for (int i = 0; i < kAround; ++i)
        for (int j = 0; j < kTube; ++j) {
            int in = (i + 1) % kAround, jn = (j + 1) % kTube;
            cage.quad({loops[i][j], tex(j, i)}, {loops[in][j], tex(j, i + 1)}, {loops[in][jn], tex(j + 1, i + 1)},
                      {loops[i][jn], tex(j + 1, i)});
        }
    return cage.finish("torus");
}

/// 2 x 2 units in the XZ plane; its boundary keeps sharp corners.
inline Cage makePlane() {
    constexpr int kSide = 8;
    CageBuilder cage;
    cage.boundaryRule(BoundaryRule::edgeAndCorner);
    std::vector<Corner> corners;
    for (int j = 0; j <= kSide; ++j)
        for (int i = 0; i <= kSide; ++i) {
            dvec2 st = dvec2(i, j) / double(kSide);
            corners.push_back({cage.point({2 * st.x - 1, 0, 1 - 2 * st.y}), cage.tex(st)});
        }
    for (int j = 0; j < kSide; ++j)
        for (int i = 0; i < kSide; ++i) {
            int a = j * (kSide + 1) + i, b = a + kSide + 1;
            cage.quad(corners[a], corners[a + 1], corners[b + 1], corners[b]);
        }
    return cage.finish("plane");
}

/// Moves every point until the limit surface of a closed quad cage passes through the unit sphere above it. Limit mask
/// of a vertex of valence n: (n^2 v + 4 sum of edge neighbours + sum of opposite corners) / (n (n + 5))  (Halstead
/// 1993).
inline void fitToSphere(std::vector<dvec3>& points, const std::vector<std::array<std::uint32_t, 4>>& quads) {
    for (int pass = 0; pass < 60; ++pass) {
        std::vector<dvec3> sum(points.size(), dvec3(0));
        std::vector<int> valence(points.size(), 0);
        for (const auto& quad : quads)
            for (int i = 0; i < 4; ++i) { // every edge is met twice, hence 2 where the mask says 4
                std::uint32_t v = quad[i];
                sum[v] += 2.0 * (points[quad[(i + 1) % 4]] + points[quad[(i + 3) % 4]]) + points[quad[(i + 2) % 4]];
                valence[v]++;
            }
        for (std::size_t v = 0; v < points.size(); ++v) {
            double n = valence[v];
            dvec3 limit = (n * n * points[v] + sum[v]) / (n * (n + 5));
            points[v] += glm::normalize(limit) - limit;
        }
    }
}

/// A quad ball of limit radius 1; six square islands, 3 across and 2 up, with gutters between them.
inline Cage makeBall() {
    constexpr int kSide = 4;
    constexpr double kGutter = 0.008; // half the space between two islands
    CageBuilder cage;
    std::vector<dvec3> points;
    std::map<std::array<int, 3>, std::uint32_t> known;
    std::vector<std::array<std::uint32_t, 4>> quads, texes;
    // Six square grids; points on the edges of the cube belong to two or three of them.
    for (int f = 0; f < 6; ++f) {
        ivec2 island(f % 3, f / 3);
        TexGrid tex(cage, [&](int j, int i) {
            dvec2 st = glm::mix(dvec2(kGutter), dvec2(1.0 / 3, 1.0 / 2) - kGutter, dvec2(i, j) / double(kSide));
            return st + dvec2(island) * dvec2(1.0 / 3, 1.0 / 2);
        });
        auto point = [&](int i, int j) {
            std::array<int, 3> at{};
            int axis = f % 3, sign = f < 3 ? 1 : -1;
            at[axis] = sign * kSide, at[(axis + 1) % 3] = sign * (2 * i - kSide), at[(axis + 2) % 3] = 2 * j - kSide;
            auto [entry, isNew] = known.insert({at, std::uint32_t(points.size())});
            auto bend = [&](int x) { return std::tan(x * kPi / 4 / kSide); }; // equal angles
            if (isNew) points.push_back(glm::normalize(dvec3(bend(at[0]), bend(at[1]), bend(at[2]))));
            return entry->second;
        };
        for (int j = 0; j < kSide; ++j)
            for (int i = 0; i < kSide; ++i) {
                quads.push_back({point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)});
                texes.push_back({tex(j, i), tex(j, i + 1), tex(j + 1, i + 1), tex(j + 1, i)});
            }
    }
    // Then moved until the limit surface, not the cage, has radius 1.
    fitToSphere(points, quads);
    for (const dvec3& p : points) cage.point(p);
    for (std::size_t q = 0; q < quads.size(); ++q)
        cage.quad({quads[q][0], texes[q][0]}, {quads[q][1], texes[q][1]}, {quads[q][2], texes[q][2]},
                  {quads[q][3], texes[q][3]});
    return cage.finish("ball");
}

} // namespace relief::meshes
