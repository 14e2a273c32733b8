// Height maps in memory, and an own reader of the words that the device holds of them.
#pragma once

#include <bit>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "displacement/displacement.h"

namespace relief::test {

/// Waves of no period, from -0.5 to 0.5, about a mid of 0.1.
inline HeightMap waves(int width, int height) {
    std::vector<float> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) texels.push_back(float(0.3 * std::sin(0.4 * x) + 0.2 * std::cos(0.3 * y)));
    return makeHeightMap(width, height, texels, 0.1, 2, Wrap::clamp);
}

/// A level of the map as a map of its own, read texel by texel from the words.
inline HeightMap levelOf(const EncodedMap& encoded, const MapWords& words, std::uint32_t level) {
    const HeightMap& map = encoded.decoded;
    const auto& [format, base, range, blocks] = encoded.encoding;
    const int width = std::max(map.width >> level, 1), height = std::max(map.height >> level, 1);
    const std::uint32_t* first = &words.words[words.firsts[level]];
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(first);
    std::vector<float> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const auto i = std::size_t(y * width + x), block = std::size_t(y / 4 * ((width + 3) / 4) + x / 4);
            const auto pair = [&] { return std::uint32_t(bytes[2 * i] | bytes[2 * i + 1] << 8); };
            float value = 0;
            switch (format) {
            case MapFormat::real: value = std::bit_cast<float>(first[i]); break;
            case MapFormat::half: value = glm::unpackHalf1x16(std::uint16_t(pair())); break;
            case MapFormat::unorm16: value = base + range * float(pair()) / 65535; break;
            case MapFormat::unorm8: value = base + range * float(bytes[i]) / 255; break;
            case MapFormat::bc4:
                value =
                    base + range * decodeBc4(std::span<const std::uint8_t, 8>(bytes + 8 * block, 8))[y % 4 * 4 + x % 4];
            }
            texels.push_back(value);
        }
    return makeHeightMap(width, height, texels, map.mid, map.scale, map.wrap);
}

} // namespace relief::test
