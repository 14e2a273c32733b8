// The slopes of a height map, level by level: what bump mapping reads.
#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "displacement/displacement.h"
#include "displacement/mips.h"
#include "displacement/neighbours.h"

namespace relief {

namespace {

/// (h_s, h_t) at every texel of a level by central differences over one texel, cage units per unit of s and t.
std::vector<vec2> slopesOf(const MapLevel<float>& level, double scale, Wrap wrap) {
    std::vector<vec2> slopes;
    slopes.reserve(level.texels.size());
    const dvec2 perUnit(0.5 * scale * level.width, 0.5 * scale * level.height);
    eachDifference(level.width, level.height, level.texels, wrap,
                   [&](const dvec2& difference) { slopes.emplace_back(perUnit * difference); });
    return slopes;
}

} // namespace

SlopeMap computeSlopes(const HeightMap& map) {
    SlopeMap result{.width = map.width, .height = map.height};
    MapLevel<float> level{map.width, map.height, map.texels};
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
        level = {level.halfWidth(), level.halfHeight(), texels};
    }
}

} // namespace relief
