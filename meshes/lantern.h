// A lantern: eight sides with hexagonal panes, a roof of triangles, an octagon for a floor, an open chimney.
#pragma once

#include "grid.h"

namespace relief::meshes {

constexpr double kLanternTurn = 0.96 / 8.5;           ///< of s, one side of the lantern
constexpr double kPanelLow = 0.40, kPanelHigh = 0.66; ///< the panels' lower and upper border in t

/// Texture coordinates as sides of the lantern, and 0..1 over the height of a panel.
inline dvec2 lanternCoordinates(const dvec2& st) {
    return {(st.x - 0.02) / kLanternTurn, (st.y - kPanelLow) / (kPanelHigh - kPanelLow)};
}

struct LanternBuilder {
    static constexpr int kSides = 8;
    CageBuilder cage;
    std::map<std::pair<long, long>, std::uint32_t> texes; ///< of the current island, by coordinates

    /// A point at `turn` eighths around the axis; odd rings may stand half a side on.
    std::uint32_t point(double turn, double radius, double y) {
        double a = turn * 2 * kPi / kSides;
        return cage.point({radius * std::sin(a), y, radius * std::cos(a)});
    }
    Loop ring(double shift, double radius, double y) {
        Loop loop;
        for (int i = 0; i < kSides; ++i) loop.push_back(point(i + shift, radius, y));
        return loop;
    }
    /// A corner whose texture coordinates are `turn` eighths along and `up` high; equal ones are shared.
    Corner corner(std::uint32_t point, double turn, double up) {
        dvec2 st(0.02 + kLanternTurn * turn, up);
        auto [entry, isNew] = texes.insert({{std::lround(st.x * 1e5), std::lround(st.y * 1e5)}, 0});
        if (isNew) entry->second = cage.tex(st);
        return {point, entry->second};
    }
    void face(std::initializer_list<Corner> corners) { cage.face(std::vector<Corner>(corners)); }

    void addBand(const Loop& low, const Loop& high, double lowUp, double highUp, double shift = 0);
    void addPanel(int side, const std::array<Loop, 3>& frame);
    void addRoof(const Loop& eaves, const Loop& ridge);
    void addFloor(const Loop& foot);
};

/// A ring of quads.
inline void LanternBuilder::addBand(const Loop& low, const Loop& high, double lowUp, double highUp, double shift) {
    for (int i = 0; i < kSides; ++i) {
        int n = (i + 1) % kSides;
        double left = i + shift, right = left + 1;
        face({corner(low[i], left, lowUp), corner(low[n], right, lowUp), corner(high[n], right, highUp),
              corner(high[i], left, highUp)});
    }
}

/// One side: a hexagonal pane, set back, in a frame of six quads. `frame` holds the lower, middle and upper rings.
inline void LanternBuilder::addPanel(int side, const std::array<Loop, 3>& frame) {
    constexpr dvec2 kPane[] = {{0.32, 0.16}, {0.68, 0.16}, {0.84, 0.5}, {0.68, 0.84}, {0.32, 0.84}, {0.16, 0.5}};
    int n = (side + 1) % kSides;
    const std::uint32_t outer[] = {frame[0][side], frame[0][n],    frame[1][n],
                                   frame[2][n],    frame[2][side], frame[1][side]};
    constexpr dvec2 kOuter[] = {{0, 0}, {1, 0}, {1, 0.5}, {1, 1}, {0, 1}, {0, 0.5}};
    auto up = [](double y) { return glm::mix(kPanelLow, kPanelHigh, y); };
    std::array<Corner, 6> rim, pane;
    for (int k = 0; k < 6; ++k) {
        rim[k] = corner(outer[k], side + kOuter[k].x, up(kOuter[k].y));
        double bulge = 0.50 + 0.10 * std::sin(kPi * kPane[k].y), middle = std::abs(kPane[k].x - 0.5);
        std::uint32_t inner = point(side + kPane[k].x, bulge - 0.06 * (1 - middle), glm::mix(0.34, 1.18, kPane[k].y));
        pane[k] = corner(inner, side + kPane[k].x, up(kPane[k].y));
    }
    for (int k = 0; k < 6; ++k) cage.quad(rim[k], rim[(k + 1) % 6], pane[(k + 1) % 6], pane[k]);
    cage.face(pane);
    for (int k = 0; k < 6; ++k) cage.crease(pane[k].point, pane[(k + 1) % 6].point, 2);
}

/// Triangles between the eaves and a ring that stands half a side on.
inline void LanternBuilder::addRoof(const Loop& eaves, const Loop& ridge) {
    for (int i = 0; i < kSides; ++i) {
        int n = (i + 1) % kSides;
        face({corner(eaves[i], i, 0.74), corner(eaves[n], i + 1, 0.74), corner(ridge[i], i + 0.5, 0.86)});
        face({corner(eaves[n], i + 1, 0.74), corner(ridge[n], i + 1.5, 0.86), corner(ridge[i], i + 0.5, 0.86)});
    }
}

/// One octagon, an island of its own.
inline void LanternBuilder::addFloor(const Loop& foot) {
    std::vector<Corner> corners;
    for (int i = kSides - 1; i >= 0; --i) {
        double a = i * 2 * kPi / kSides;
        corners.push_back({foot[i], cage.tex(dvec2(0.14, 0.14) + 0.12 * dvec2(std::sin(a), std::cos(a)))});
    }
    cage.face(corners);
}

inline Cage makeLantern() {
    // Rings of points from the foot up, each with its turn, radius and height.
    LanternBuilder lantern;
    Loop foot = lantern.ring(0, 0.56, 0), sole = lantern.ring(0, 0.60, 0.10), waist = lantern.ring(0, 0.50, 0.20);
    std::array<Loop, 3> frame{lantern.ring(0, 0.54, 0.26), lantern.ring(0, 0.66, 0.76), lantern.ring(0, 0.54, 1.26)};
    Loop under = lantern.ring(0, 0.78, 1.26), eaves = lantern.ring(0, 0.80, 1.32),
         ridge = lantern.ring(0.5, 0.34, 1.62);
    Loop neck = lantern.ring(0.5, 0.20, 1.72), mouth = lantern.ring(0.5, 0.24, 1.92);
    // Faces between neighbouring rings, with the interval of t that they have in texture space.
    lantern.addFloor(foot);
    lantern.addBand(foot, sole, 0.29, 0.32);
    lantern.addBand(sole, waist, 0.32, 0.37);
    lantern.addBand(waist, frame[0], 0.37, 0.40);
    for (int side = 0; side < LanternBuilder::kSides; ++side) lantern.addPanel(side, frame);
    lantern.addBand(frame[2], under, 0.66, 0.72);
    lantern.addBand(under, eaves, 0.72, 0.74);
    lantern.addRoof(eaves, ridge);
    lantern.addBand(ridge, neck, 0.86, 0.90, 0.5);
    lantern.addBand(neck, mouth, 0.90, 0.96, 0.5);
    // Sharp at the foot, semi-sharp at the eaves.
    for (int i = 0; i < LanternBuilder::kSides; ++i) {
        int n = (i + 1) % LanternBuilder::kSides;
        lantern.cage.crease(foot[i], foot[n], 10);
        lantern.cage.crease(eaves[i], eaves[n], 3);
        lantern.cage.crease(under[i], under[n], 3);
    }
    return lantern.cage.finish("lantern");
}

} // namespace relief::meshes
