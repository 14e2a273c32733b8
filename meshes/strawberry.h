// A strawberry's control cage: the fruit, a crown of eight sepals and a stem, one closed surface.
#pragma once

#include "grid.h"

namespace relief::meshes {

constexpr int kBerryColumns = 24; ///< three per sepal: a gap, then two under which the sepal begins
constexpr int kBerryRows = 9;     ///< of quads on the fruit, from the tip up to the sepals
constexpr int kSepalRows = 5;
constexpr double kBerryTexUnits = 7.0; ///< cage units to one side of the texture square

struct BerryRing {
    double y, radius;
};
inline constexpr BerryRing kBerryRings[] = {
    {-1.22, 0.30}, {-1.03, 0.46}, {-0.80, 0.62}, {-0.53, 0.77}, {-0.23, 0.89},
    {0.08, 0.95},  {0.38, 0.92},  {0.62, 0.77},  {0.74, 0.56},  {0.74, 0.38}, // the last two hold the sepals' roots
    {0.71, 0.24},
};
constexpr int kSepalRow = 8;

inline dvec3 berryPoint(double column, double radius, double y) {
    double a = 2 * kPi * column / kBerryColumns;
    return {radius * std::sin(a), y, radius * std::cos(a)};
}

struct StrawberryBuilder {
    CageBuilder cage;
    std::vector<Loop> rings;

    void addFruit();
    void addTip();
    void addStem();
    void addSepal(int index);
};

inline void StrawberryBuilder::addFruit() {
    for (const BerryRing& ring : kBerryRings) {
        Loop& loop = rings.emplace_back();
        for (int j = 0; j < kBerryColumns; ++j) loop.push_back(cage.point(berryPoint(j, ring.radius, ring.y)));
    }
    std::vector<double> heights{0};
    for (std::size_t i = 1; i < rings.size(); ++i)
        heights.push_back(heights.back() + std::hypot(kBerryRings[i].y - kBerryRings[i - 1].y,
                                                      kBerryRings[i].radius - kBerryRings[i - 1].radius));
    TexGrid tex(cage, [&](int row, int column) {
        return dvec2(0.012 + 0.73 * column / kBerryColumns, 0.47 + heights[row] / kBerryTexUnits);
    });
    cage.part("fruit");
    for (int row = 0; row + 1 < int(rings.size()); ++row)
        for (int j = 0; j < kBerryColumns; ++j) {
            if (row == kSepalRow && j % 3 != 0) continue;
            int n = (j + 1) % kBerryColumns;
            cage.quad({rings[row][j], tex(row, j)}, {rings[row][n], tex(row, j + 1)},
                      {rings[row + 1][n], tex(row + 1, j + 1)}, {rings[row + 1][j], tex(row + 1, j)});
        }
}

inline void StrawberryBuilder::addTip() {
    Loop loop = rings.front();
    std::reverse(loop.begin() + 1, loop.end());
    cage.part("tip");
    capLoop(
        cage, loop,
        [](double ring, double turn) {
            return berryPoint(-turn * kBerryColumns, kBerryRings[0].radius * ring, -1.36 + 0.14 * ring * ring);
        },
        [](dvec2 p) { return dvec2(0.870, 0.88) + 0.06 * p; });
}

/// The top dips in around the stem, which leaves through the middle of its cap.
inline void StrawberryBuilder::addStem() {
    cage.part("top");
    Loop root = capLoop(
        cage, rings.back(),
        [](double ring, double turn) { return berryPoint(turn * kBerryColumns, 0.24 * ring, 0.70); },
        [](dvec2 p) { return dvec2(0.870, 0.70) + 0.05 * p; }, 2);
    std::vector<Loop> loops{root};
    constexpr BerryRing kStem[] = {{0.80, 0.068}, {0.95, 0.060}, {1.12, 0.058}, {1.24, 0.066}, {1.27, 0.05}};
    for (const BerryRing& ring : kStem) {
        Loop& loop = loops.emplace_back();
        dvec3 lean = dvec3(0.35, 0, 0.15) * (ring.y - 0.70) * (ring.y - 0.70);
        for (int k = 0; k < 8; ++k) loop.push_back(cage.point(lean + berryPoint(3 * k, ring.radius, ring.y)));
    }
    TexGrid tex(cage, [&](int row, int column) { return dvec2(0.77 + 0.07 * column / 8, 0.48 + 0.02 * row); });
    cage.part("stem");
    joinLoops(cage, loops, tex);
    dvec3 top = centerOf(cage, loops.back()) + dvec3(0, 0.005, 0);
    capLoop(
        cage, loops.back(), [&](double, double) { return top; }, [](dvec2 p) { return dvec2(0.90, 0.52) + 0.012 * p; });
}

/// A flat leaf that rises from the shoulder, bows over and points down or up, each a little differently.
inline void StrawberryBuilder::addSepal(int index) {
    constexpr double kWidths[] = {0.21, 0.25, 0.22, 0.15, 0.045}, kCurl[] = {1.0, 0.25, 0.8, -0.1, 1.1, 0.5, 0.05, 0.9};
    // The root: six points of the fruit, around two of its faces.
    std::vector<Loop> loops;
    Loop root;
    for (int k : {0, 1, 2})
        root.push_back(rings[kSepalRow][3 * index + 1 + k == kBerryColumns ? 0 : 3 * index + 1 + k]);
    for (int k : {2, 1, 0})
        root.push_back(rings[kSepalRow + 1][3 * index + 1 + k == kBerryColumns ? 0 : 3 * index + 1 + k]);
    loops.push_back(root);
    // Rings along the leaf, whose pitch turns as the sepal's own curl asks.
    double azimuth = 2 * kPi * (3 * index + 2) / kBerryColumns;
    dvec3 out(std::sin(azimuth), 0, std::cos(azimuth)), side(out.z, 0, -out.x), center = centerOf(cage, root);
    for (int i = 0; i < kSepalRows; ++i) {
        double s = (i + 1.0) / kSepalRows, pitch = radians(38 - 120 * s * kCurl[index] + (index % 3 - 1) * 12);
        dvec3 along = std::cos(pitch) * out + std::sin(pitch) * dvec3(0, 1, 0);
        center += 0.155 * along;
        dvec3 up = glm::cross(along, side);
        loops.push_back(addSixLoop(cage, {center, side, up, kWidths[i], 0.028}));
    }
    // One strip of texture per sepal.
    TexGrid tex(cage, [&](int row, int column) {
        return dvec2(0.012 + 0.122 * index + 0.105 * column / 6,
                     0.015 + 0.07 * std::min(row, kSepalRows) + 0.012 * std::max(0, row - kSepalRows));
    });
    cage.part(fmt::format("sepal {}", index));
    joinLoops(cage, loops, tex, 4);
    closeSix(cage, loops.back(), tex, kSepalRows, 2);
}

inline Cage makeStrawberry() {
    StrawberryBuilder builder;
    builder.addFruit();
    builder.addTip();
    builder.addStem();
    for (int i = 0; i < kBerryColumns / 3; ++i) builder.addSepal(i);
    return builder.cage.finish("strawberry");
}

} // namespace relief::meshes
