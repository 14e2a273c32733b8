// Heights and slopes in memory for the tests of maps.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "maps/maps.h"
#include "support.h"

namespace relief::test {

inline constexpr double kPi = std::numbers::pi;

/// Texels of a function of texture coordinates, at their centres.
template <typename Function>
HeightMap heightsOf(int width, int height, Wrap wrap, const Function& function) {
    std::vector<float> texels;
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i) texels.push_back(float(function((i + 0.5) / width, 1 - (j + 0.5) / height)));
    return makeHeightMap(width, height, std::move(texels), 0, 1, wrap);
}

inline HeightMap noiseHeights(int width, int height, Wrap wrap) {
    std::mt19937 random(7);
    return heightsOf(width, height, wrap, [&](double, double) { return double(random() % 4096) / 4096; });
}

/// A map of the slopes along x and y that a function of (column, row) returns.
template <typename Function>
NormalMap normalsOf(int width, int height, Wrap wrap, const Function& slopes) {
    NormalMap map{.width = width, .height = height, .normals = {}, .wrap = wrap};
    for (int j = 0; j < height; ++j)
        for (int i = 0; i < width; ++i) {
            const dvec2 slope = slopes(i, j);
            map.normals.push_back(vec3(glm::normalize(dvec3(-slope.x, -slope.y, 1))));
        }
    return map;
}

/// The largest difference of two maps but for their means, as a share of the range of the first.
inline double largestDifference(const HeightMap& a, const HeightMap& b) {
    EXPECT_EQ(a.texels.size(), b.texels.size());
    double mean = 0, largest = 0;
    for (std::size_t i = 0; i < a.texels.size(); ++i)
        mean += (double(a.texels[i]) - b.texels[i]) / double(a.texels.size());
    for (std::size_t i = 0; i < a.texels.size(); ++i)
        largest = std::max(largest, std::abs(double(a.texels[i]) - b.texels[i] - mean));
    return largest / std::max(double(a.highest) - a.lowest, 1e-30);
}

} // namespace relief::test
