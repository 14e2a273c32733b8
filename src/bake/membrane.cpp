#include "bake/membrane.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "displacement/voids.h"

namespace relief {
namespace {

/// A void texel and those of its neighbours that are on the surface.
struct Membrane {
    std::uint32_t texel = 0;
    TexelNeighbours neighbours;
};

std::vector<Membrane> findMembranes(const BakedHeights& map, const TexelSource& texels) {
    std::vector<Membrane> membranes;
    for (std::size_t texel = 0; texel < map.states.size(); ++texel) {
        if (map.states[texel] != TexelState::missed) continue;
        Membrane membrane{.texel = std::uint32_t(texel), .neighbours = {}};
        const TexelNeighbours around = texels.neighboursOf(membrane.texel);
        for (std::uint32_t k = 0; k < around.count; ++k)
            if (map.states[around.texels[k]] != TexelState::outside) membrane.neighbours.add(around.texels[k]);
        membranes.push_back(membrane);
    }
    return membranes;
}

/// Heights for a start: each void takes the mean of its neighbours that have one, those beside hits first.
void spreadHeights(BakedHeights& map, std::span<const Membrane> membranes) {
    std::vector<bool> isKnown(map.states.size());
    for (std::size_t i = 0; i < isKnown.size(); ++i) isKnown[i] = map.states[i] == TexelState::hit;
    std::vector<std::uint32_t> waiting(membranes.size()), next, known;
    std::iota(waiting.begin(), waiting.end(), 0u);
    for (; !waiting.empty(); waiting.swap(next)) {
        next.clear(), known.clear();
        for (const std::uint32_t i : waiting) {
            double sum = 0, count = 0;
            const Membrane& m = membranes[i];
            for (std::uint32_t k = 0; k < m.neighbours.count; ++k)
                if (const std::uint32_t other = m.neighbours.texels[k]; isKnown[other])
                    sum += double(map.heights[other]), count += 1;
            if (count > 0) map.heights[m.texel] = float(sum / count);
            (count > 0 ? known : next).push_back(i);
        }
        if (known.empty()) return; // parts of the surface without a hit stay as they are
        for (const std::uint32_t i : known) isKnown[membranes[i].texel] = true;
    }
}

} // namespace

void fillMissed(BakedHeights& map, const TexelSource& texels) {
    const std::vector<Membrane> membranes = findMembranes(map, texels);
    if (texels.isPicture()) {
        std::vector<bool> isVoid(map.states.size());
        for (std::size_t i = 0; i < isVoid.size(); ++i) isVoid[i] = map.states[i] != TexelState::hit;
        fillVoids(map.width, map.height, map.heights, isVoid);
    } else {
        spreadHeights(map, membranes);
    }

    // Successive over-relaxation of the Laplace equation. The heights to begin with are right on a large scale, so that
    // what is left to smooth is small.
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
            if (m.neighbours.count == 0) continue;
            double sum = 0;
            for (std::uint32_t k = 0; k < m.neighbours.count; ++k) sum += double(map.heights[m.neighbours.texels[k]]);
            const double before = double(map.heights[m.texel]);
            const double step = kOverRelaxation * (sum / m.neighbours.count - before);
            map.heights[m.texel] = float(before + step);
            change = std::max(change, std::abs(step));
        }
    }
}

} // namespace relief
