#include "bake/membrane.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "displacement/neighbours.h"
#include "displacement/voids.h"

namespace relief {
namespace {

/// A void texel and those of its four neighbours that are on the surface.
struct Membrane {
    std::uint32_t texel = 0;
    std::uint32_t neighbourCount = 0;
    std::array<std::uint32_t, 4> neighbours{};
};

std::vector<Membrane> findMembranes(const BakedHeights& map, Wrap wrap) {
    std::vector<Membrane> membranes;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            const auto at = [&](int column, int row) {
                return std::uint32_t(std::size_t(row) * std::size_t(map.width) + std::size_t(column));
            };
            if (map.states[at(x, y)] != TexelState::missed) continue;
            Membrane membrane{.texel = at(x, y)};
            for (const std::uint32_t other :
                 {at(beside(x, -1, map.width, wrap), y), at(beside(x, 1, map.width, wrap), y),
                  at(x, beside(y, -1, map.height, wrap)), at(x, beside(y, 1, map.height, wrap))})
                if (other != membrane.texel && map.states[other] != TexelState::outside)
                    membrane.neighbours[membrane.neighbourCount++] = other;
            membranes.push_back(membrane);
        }
    return membranes;
}

} // namespace

void fillMissed(BakedHeights& map, Wrap wrap) {
    std::vector<bool> isVoid(map.states.size());
    for (std::size_t i = 0; i < isVoid.size(); ++i) isVoid[i] = map.states[i] != TexelState::hit;
    fillVoids(map.width, map.height, map.heights, isVoid);

    // Successive over-relaxation of the Laplace equation, from the pyramid's heights on: these are right on a large
    // scale, so that what is left to smooth is as large as their blocks.
    const std::vector<Membrane> membranes = findMembranes(map, wrap);
    if (membranes.empty()) return;
    constexpr double kOverRelaxation = 1.8, kMostUpdates = 4e8;
    constexpr std::size_t kMostSweeps = 1000;
    const auto sweeps = std::size_t(std::clamp(kMostUpdates / double(membranes.size()), 20.0, double(kMostSweeps)));
    const auto [low, high] = std::ranges::minmax_element(map.heights);
    const double small = 1e-7 * (double(*high) - double(*low));
    double change = 2 * small + 1;
    for (std::size_t sweep = 0; sweep < sweeps && change > small; ++sweep) {
        change = 0;
        for (const Membrane& m : membranes) {
            if (m.neighbourCount == 0) continue;
            double sum = 0;
            for (std::uint32_t k = 0; k < m.neighbourCount; ++k) sum += double(map.heights[m.neighbours[k]]);
            const double before = double(map.heights[m.texel]);
            const double step = kOverRelaxation * (sum / m.neighbourCount - before);
            map.heights[m.texel] = float(before + step);
            change = std::max(change, std::abs(step));
        }
    }
}

} // namespace relief
