// The slopes of a height map, level by level: what bump mapping reads.
#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "displacement/displacement.h"
#include "displacement/mips.h"

namespace relief {

namespace {

/// The neighbour of a column or row outside of a level.
int wrapped(int i, int size, Wrap wrap) {
    return wrap == Wrap::repeat ? (i + size) % size : std::clamp(i, 0, size - 1);
}

/// (h_s, h_t) at every texel of a level by central differences over one texel, cage units per unit of s and t.
std::vector<vec2> slopesOf(const MapLevel& level, double scale, Wrap wrap) {
    const auto at = [&](int x, int y) {
        return double(level.texels[std::size_t(y) * std::size_t(level.width) + std::size_t(x)]);
    };
    std::vector<vec2> slopes;
    slopes.reserve(level.texels.size());
    for (int y = 0; y < level.height; ++y) {
        // t points up, rows go down.
        const int above = wrapped(y - 1, level.height, wrap), below = wrapped(y + 1, level.height, wrap);
        for (int x = 0; x < level.width; ++x) {
            const int left = wrapped(x - 1, level.width, wrap), right = wrapped(x + 1, level.width, wrap);
            slopes.emplace_back(0.5 * scale * level.width * (at(right, y) - at(left, y)),
                                0.5 * scale * level.height * (at(x, above) - at(x, below)));
        }
    }
    return slopes;
}

} // namespace

SlopeMap computeSlopes(const HeightMap& map) {
    SlopeMap result{.width = map.width, .height = map.height};
    MapLevel level{map.width, map.height, map.texels};
    std::vector<float> texels; // of the level
    for (;;) {
        const std::vector<vec2> slopes = slopesOf(level, map.scale, map.wrap);
        // Halves hold 11 bits of the steepest slope; the coarser levels are flatter.
        if (result.levelCount == 0) {
            float steepest = 0;
            for (const vec2& slope : slopes) steepest = std::max({steepest, std::abs(slope.x), std::abs(slope.y)});
            if (steepest > 0 && std::isfinite(steepest)) result.unit = steepest;
        }
        for (const vec2& slope : slopes)
            result.texels.push_back(glm::packHalf2x16(glm::clamp(slope / result.unit, vec2(-65504), vec2(65504))));
        ++result.levelCount;
        if (level.width == 1 && level.height == 1) return result;
        texels = halved(level);
        level = {std::max(level.width / 2, 1), std::max(level.height / 2, 1), texels};
    }
}

} // namespace relief
