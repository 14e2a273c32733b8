// Maps painted by texture coordinates: smooth, golf, bricks (all tileable) and terrain.
#pragma once

#include "painting.h"

namespace relief::meshes {

/// h = 0.05 sin(6 pi s) sin(8 pi t): known in closed form, tileable.
inline Painting paintSmooth(const ivec2& size) {
    Painting painting = paintSquare(size, [](const dvec2& st) {
        return Paint{0.05 * std::sin(6 * kPi * st.x) * std::sin(8 * kPi * st.y), {}};
    });
    painting.albedo = {};
    return painting;
}

/// Dimples in hexagonal packing; 36 x 16 of them are evenly spaced on the torus.
inline Painting paintGolf(const ivec2& size) {
    constexpr double kSpacing = 0.17, kRow = kSpacing * 0.866; // cage units on the torus
    constexpr int kColumns = 36, kRows = 16;
    Painting painting = paintSquare(size, [](const dvec2& st) {
        dvec2 p(st.x * kColumns * kSpacing, st.y * kRows * kRow);
        int below = int(std::floor(p.y / kRow));
        double nearest = 9;
        for (int row = below; row <= below + 1; ++row) {
            double shift = (row & 1) ? 0.5 : 0, x = p.x / kSpacing - shift;
            nearest = std::min(nearest, std::hypot((x - std::round(x)) * kSpacing, p.y - row * kRow));
        }
        double x = nearest / (0.46 * kSpacing), rim = (x - 1) / 0.16;
        return Paint{-0.026 * bump(x) + 0.0035 * std::exp(-rim * rim), {}};
    });
    painting.albedo = {};
    return painting;
}

/// Where a point lies in a running bond of 4 x 8 bricks.
struct BrickPlace {
    int column, row; ///< of the brick, already wrapped
    dvec2 inside;    ///< from its middle, in units of the cube (a brick is 0.5 x 0.25)
    double toEdge;   ///< distance from the mortar's middle line
};

inline BrickPlace brickAt(const dvec2& st) {
    constexpr dvec2 kBrick(0.5, 0.25);
    dvec2 p = st * dvec2(4, 8);
    int row = int(std::floor(p.y)) & 7;
    p.x += (row & 1) ? 0.5 : 0;
    dvec2 cell = glm::floor(p), inside = (p - cell - 0.5) * kBrick;
    dvec2 edge = kBrick / 2.0 - glm::abs(inside);
    double corner = 0.05, round = glm::length(glm::max(corner - edge, dvec2(0))); // rounded corners
    return {int(cell.x) & 3, row, inside, std::min(std::min(edge.x, edge.y), corner - round)};
}

/// Worn bricks in sandy mortar for the cube.
inline Painting paintBricks(const ivec2& size) {
    return paintSquare(size, [](const dvec2& st) {
        BrickPlace brick = brickAt(st);
        Random luck(97 + brick.row * 8 + brick.column);
        dvec3 p(st * 16.0, 0.5);
        double out = luck(-0.006, 0.010), tiltX = luck(-0.025, 0.025), tiltY = luck(-0.05, 0.05), shade = luck();
        double wear = 0.010 * fractal(p, 3, 5, 16), grit = 0.0035 * fractal(p * 8.0, 2, 9, 128);
        double chipped = 0.014 * smoothstep(0.10, 0.45, fractal(p * 2.0, 2, 13, 32));
        double solid = smoothstep(0.012, 0.036, brick.toEdge + wear - chipped);
        double face = 0.022 + out + tiltX * brick.inside.x + tiltY * brick.inside.y + 0.5 * wear + grit;
        double mortar = -0.024 + 1.4 * grit + 0.3 * wear;
        dvec3 clay = glm::mix(dvec3(0.52, 0.20, 0.13), dvec3(0.70, 0.36, 0.24), shade);
        clay *= 1 + 0.25 * fractal(p * 2.0, 3, 17, 32) + 12 * grit;
        clay = glm::mix(clay, dvec3(0.22, 0.12, 0.11), luck() > 0.85 ? 0.55 : 0.0);
        dvec3 sand = dvec3(0.66, 0.62, 0.55) * (1 + 14 * grit);
        return Paint{glm::mix(mortar, face, solid), glm::mix(sand, clay, solid)};
    });
}

/// Signed distance to the walls of the box that stands on the terrain, negative inside. They run along the axes, as the
/// samples of a displaced grid do: a slanted wall narrower than a sample would have teeth.
inline double boxDistance(const dvec2& ground) {
    dvec2 away = glm::abs(ground - dvec2(0.25, -0.375)) - dvec2(0.1875, 0.125);
    return std::max(away.x, away.y);
}

/// Falls to 0 on the border, so that a map that repeats has no step there.
inline double rimOf(const dvec2& ground) {
    return smoothstep(0.0, 0.12, 1 - std::max(std::abs(ground.x), std::abs(ground.y)));
}

/// Ridged mountains behind a valley; `ground` is -1..1 each way.
inline double mountainHeight(const dvec2& ground) {
    dvec3 p = warped({ground, 3.7}, 1.3, 0.20, 23);
    double range = smoothstep(-0.50, 0.60, 0.8 * fractal(p * 1.2, 2, 21) + 0.75 * ground.y - 0.10 * ground.x + 0.05);
    double peaks = ridges(p * 1.35, 6, 29), hills = 0.05 * fractal(p * 2.6, 4, 37);
    return rimOf(ground) * (0.62 * range * peaks * peaks + (1 - 0.6 * range) * hills + 0.04);
}

inline dvec3 groundColor(const dvec2& ground, double height, double slope) {
    dvec3 p(ground, 0);
    double patch = fractal(p * 9.0, 3, 41);
    dvec3 grass = glm::mix(dvec3(0.20, 0.23, 0.13), dvec3(0.37, 0.35, 0.23), smoothstep(-0.3, 0.4, patch));
    dvec3 rock =
        glm::mix(dvec3(0.36, 0.32, 0.29), dvec3(0.53, 0.49, 0.44), smoothstep(-0.4, 0.4, fractal(p * 24.0, 2, 43)));
    dvec3 color = glm::mix(grass, rock, smoothstep(0.45, 0.80, slope + 0.3 * patch + 1.0 * height));
    double snow = smoothstep(0.20, 0.27, height + 0.05 * patch - 0.06 * slope);
    return glm::mix(color, dvec3(0.93, 0.95, 0.97), snow);
}

/// Mountains, and a sharp-sided box with a flat roof: what a smooth surface cannot do alone.
inline Painting paintTerrain(const ivec2& size) {
    constexpr double kRoof = 0.22, kWall = 0.0024; // the walls lean outwards over this width
    auto groundAt = [](const dvec2& st) { return 2.0 * st - 1.0; };
    Painting painting = paintSquare(size, [&](const dvec2& st) {
        dvec2 ground = groundAt(st);
        double toWall = boxDistance(ground), level = smoothstep(0.10, 0.02, toWall); // a terrace to stand on
        double height = glm::mix(mountainHeight(ground), 0.06, level);
        return Paint{glm::mix(height, kRoof, smoothstep(kWall, 0.0, toWall)), {}};
    });
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            auto h = [&](int i, int j) {
                return *painting.height.at(glm::clamp(i, 0, size.x - 1), glm::clamp(j, 0, size.y - 1));
            };
            dvec2 st((x + 0.5) / size.x, 1 - (y + 0.5) / size.y), ground = groundAt(st);
            dvec2 gradient = dvec2(h(x + 2, y) - h(x - 2, y), h(x, y + 2) - h(x, y - 2)) * (size.x / 8.0);
            dvec3 color = groundColor(ground, h(x, y), glm::length(gradient) * rimOf(ground));
            color = glm::mix(color, dvec3(0.78, 0.72, 0.64), smoothstep(0.004, 0.0, boxDistance(ground)));
            for (int c = 0; c < 3; ++c) painting.albedo.at(x, y)[c] = float(color[c]);
        }
    return painting;
}

} // namespace relief::meshes
