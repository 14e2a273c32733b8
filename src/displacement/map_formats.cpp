// How height maps are kept on the device: formats, mips, and what they leave of the values.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "displacement/map_formats.h"
#include "displacement/mips.h"
#include "displacement/voids.h"

namespace relief {
namespace {

/// The eight values of a BC4 block: its two end points, and what lies between.
std::array<float, 8> paletteOf(std::uint8_t red0, std::uint8_t red1) {
    const float a = float(red0) / 255, b = float(red1) / 255;
    std::array<float, 8> palette{a, b};
    if (red0 > red1) {
        for (int i = 1; i < 7; ++i) palette[std::size_t(i) + 1] = (float(7 - i) * a + float(i) * b) / 7;
    } else {
        for (int i = 1; i < 5; ++i) palette[std::size_t(i) + 1] = (float(5 - i) * a + float(i) * b) / 5;
        palette[6] = 0;
        palette[7] = 1;
    }
    return palette;
}

std::size_t nearestIn(const std::array<float, 8>& palette, float value) {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < palette.size(); ++i)
        if (std::abs(palette[i] - value) < std::abs(palette[nearest] - value)) nearest = i;
    return nearest;
}

double errorOf(std::uint8_t red0, std::uint8_t red1, std::span<const float, 16> values) {
    const std::array<float, 8> palette = paletteOf(red0, red1);
    double error = 0;
    for (const float value : values) error += std::pow(palette[nearestIn(palette, value)] - value, 2.0);
    return error;
}

std::uint8_t byteOf(float value) { return std::uint8_t(std::lround(255 * std::clamp(value, 0.0f, 1.0f))); }

/// Blocks of values 0..1; those at the border repeat its texels.
std::vector<std::uint8_t> blocksOf(std::span<const float> unit, int width, int height) {
    std::vector<std::uint8_t> blocks;
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4) {
            std::array<float, 16> values;
            for (int i = 0; i < 16; ++i) {
                const int row = std::min(y + i / 4, height - 1), column = std::min(x + i % 4, width - 1);
                values[std::size_t(i)] = unit[std::size_t(row) * std::size_t(width) + std::size_t(column)];
            }
            const std::array<std::uint8_t, 8> block = encodeBc4(values);
            blocks.insert(blocks.end(), block.begin(), block.end());
        }
    return blocks;
}

std::vector<float> valuesOf(std::span<const std::uint8_t> blocks, int width, int height) {
    std::vector<float> unit(std::size_t(width) * std::size_t(height));
    std::size_t next = 0;
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4, next += 8) {
            const std::array<float, 16> values = decodeBc4(blocks.subspan(next).first<8>());
            for (int row = y; row < std::min(y + 4, height); ++row)
                for (int column = x; column < std::min(x + 4, width); ++column)
                    unit[std::size_t(row) * std::size_t(width) + std::size_t(column)] =
                        values[std::size_t(4 * (row - y) + column - x)];
        }
    return unit;
}

/// Numbers that stand for the range of a map: 0 to this many.
float stepsOf(MapFormat format) { return format == MapFormat::unorm16 ? 65535 : 255; }

std::size_t bitsOf(MapFormat format) { return format == MapFormat::real ? 32 : format == MapFormat::unorm8 ? 8 : 16; }

/// A value as an encoding stores it (not in blocks), and what a reader makes of those bits.
std::uint32_t packed(const MapEncoding& encoding, float value) {
    if (encoding.format == MapFormat::real) return std::bit_cast<std::uint32_t>(value);
    if (encoding.format == MapFormat::half) return glm::packHalf1x16(value);
    const float unit = std::clamp((value - encoding.base) / encoding.range, 0.0f, 1.0f);
    return std::uint32_t(std::lround(unit * stepsOf(encoding.format)));
}

float unpacked(const MapEncoding& encoding, std::uint32_t bits) {
    if (encoding.format == MapFormat::real) return std::bit_cast<float>(bits);
    if (encoding.format == MapFormat::half) return glm::unpackHalf1x16(std::uint16_t(bits));
    return encoding.base + encoding.range * (float(bits) / stepsOf(encoding.format));
}

/// Values as shares 0..1 of the encoding's range, and back.
std::vector<float> toUnit(const MapEncoding& encoding, std::span<const float> texels) {
    std::vector<float> unit(texels.begin(), texels.end());
    for (float& value : unit) value = (value - encoding.base) / encoding.range;
    return unit;
}

std::vector<float> fromUnit(const MapEncoding& encoding, std::vector<float> unit) {
    for (float& value : unit) value = encoding.base + encoding.range * value;
    return unit;
}

float largestDifference(std::span<const float> a, std::span<const float> b) {
    float most = 0;
    for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
    return most;
}

} // namespace

std::uint64_t levelBytes(MapFormat format, const ivec2& size) {
    const auto width = std::uint64_t(size.x), height = std::uint64_t(size.y);
    if (format == MapFormat::bc4) return (width + 3) / 4 * ((height + 3) / 4) * 8;
    return (width * height * bitsOf(format) + 31) / 32 * 4;
}

float storeBlocks(std::span<std::uint32_t> to, const MapEncoding& encoding, const MapLevel<float>& level,
                  std::span<const std::uint8_t> blocks) {
    RELIEF_CHECK(blocks.size() == levelBytes(encoding.format, ivec2(level.width, level.height)));
    std::memcpy(to.data(), blocks.data(), blocks.size());
    return largestDifference(level.texels, fromUnit(encoding, valuesOf(blocks, level.width, level.height)));
}

float storeLevel(std::span<std::uint32_t> to, const MapEncoding& encoding, const MapLevel<float>& level) {
    if (encoding.format == MapFormat::bc4)
        return storeBlocks(to, encoding, level, blocksOf(toUnit(encoding, level.texels), level.width, level.height));
    const std::size_t bits = bitsOf(encoding.format), perWord = 32 / bits;
    float most = 0;
    for (std::size_t i = 0; i < level.texels.size(); ++i) {
        const std::uint32_t texel = packed(encoding, level.texels[i]);
        to[i / perWord] |= texel << (bits * (i % perWord));
        most = std::max(most, std::abs(unpacked(encoding, texel) - level.texels[i]));
    }
    return most;
}

std::array<std::uint8_t, 8> encodeBc4(std::span<const float, 16> values) {
    const auto [lowest, highest] = std::ranges::minmax(values);
    std::uint8_t best[2] = {byteOf(highest), byteOf(lowest)};
    double least = errorOf(best[0], best[1], values);
    // End points a little inside of the range often serve the values between better.
    const int low = byteOf(lowest), high = byteOf(highest), inset = std::min(4, (high - low) / 4);
    for (int a = -1; a <= inset; ++a)
        for (int b = -1; b <= inset; ++b) {
            const auto red0 = std::uint8_t(std::clamp(high - a, 0, 255)),
                       red1 = std::uint8_t(std::clamp(low + b, 0, 255));
            const double error = errorOf(red0, red1, values);
            if (error < least) least = error, best[0] = red0, best[1] = red1;
        }
    const std::array<float, 8> palette = paletteOf(best[0], best[1]);
    std::uint64_t bits = 0; // three per value, the first value lowest
    for (std::size_t i = 0; i < 16; ++i) bits |= std::uint64_t(nearestIn(palette, values[i])) << (3 * i);
    std::array<std::uint8_t, 8> block{best[0], best[1]};
    for (std::size_t i = 0; i < 6; ++i) block[2 + i] = std::uint8_t(bits >> (8 * i));
    return block;
}

std::array<float, 16> decodeBc4(std::span<const std::uint8_t, 8> block) {
    const std::array<float, 8> palette = paletteOf(block[0], block[1]);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < 6; ++i) bits |= std::uint64_t(block[2 + i]) << (8 * i);
    std::array<float, 16> values;
    for (std::size_t i = 0; i < 16; ++i) values[i] = palette[bits >> (3 * i) & 7];
    return values;
}

void roundTo(const MapEncoding& encoding, std::span<float> texels) {
    for (float& texel : texels) texel = unpacked(encoding, packed(encoding, texel));
}

EncodedMap encode(const HeightMap& map, MapFormat format) {
    EncodedMap result{.decoded = map, .encoding = {.format = format, .blocks = {}}};
    HeightMap& decoded = result.decoded;
    MapEncoding& encoding = result.encoding;
    if (format == MapFormat::real) return result;

    // Integers and blocks spread their numbers over the map's own range; halves have a range of their own.
    constexpr float kMostHalf = 65504;
    if (format == MapFormat::half && std::max(-map.lowest, map.highest) > kMostHalf)
        fail(Failure::input, "the height map's values go to {}; halves hold up to {}: keep it as float or unorm16",
             std::max(-map.lowest, map.highest), kMostHalf);
    if (format != MapFormat::half) {
        const auto [lowest, highest] = std::ranges::minmax(map.texels); // with the aprons of faces
        encoding.base = lowest;
        if (highest > lowest) encoding.range = highest - lowest;
    }

    // Blocks are kept: encoding what was decoded from them could choose others.
    if (format == MapFormat::bc4) {
        const auto encodeTile = [&](int width, int height, std::size_t first) {
            const auto texels = std::span(decoded.texels).subspan(first, std::size_t(width) * std::size_t(height));
            const std::vector<std::uint8_t> blocks = blocksOf(toUnit(encoding, texels), width, height);
            std::ranges::copy(fromUnit(encoding, valuesOf(blocks, width, height)), texels.begin());
            encoding.blocks.insert(encoding.blocks.end(), blocks.begin(), blocks.end());
        };
        if (map.tiles.empty()) encodeTile(map.width, map.height, 0);
        for (const MapTile& tile : map.tiles) {
            const ivec2 size = tile.size + 2 * apronOf(map.addressing);
            encodeTile(size.x, size.y, tile.first);
        }
    } else {
        roundTo(encoding, decoded.texels);
    }
    findRange(decoded);
    return result;
}

MapWords toWords(const HeightMap& decoded, const MapEncoding& encoding) {
    // Integers and codes of blocks are read as numbers 0..steps, other formats as the values themselves.
    MapWords words{.words = {}, .firsts = {}, .mid = decoded.mid, .scale = decoded.scale};
    if (encoding.format != MapFormat::real && encoding.format != MapFormat::half) {
        const double step = double(encoding.range) / double(stepsOf(encoding.format));
        words.mid = (decoded.mid - double(encoding.base)) / step;
        words.scale = decoded.scale * step;
    }

    if (decoded.addressing != Addressing::texture) {
        storeTiles(words, decoded, encoding);
        return words;
    }
    words.words.reserve(mapBytes(encoding.format, decoded.width, decoded.height) / 4);
    const auto append = [&](const MapLevel<float>& level) {
        const std::size_t first = words.words.size();
        const ivec2 size(level.width, level.height);
        words.firsts.push_back(std::uint32_t(first));
        words.sizes.push_back(size);
        words.words.resize(first + levelBytes(encoding.format, size) / 4, 0);
        const std::span<std::uint32_t> to = std::span(words.words).subspan(first);
        const bool hasBlocks = first == 0 && encoding.format == MapFormat::bc4;
        return hasBlocks ? storeBlocks(to, encoding, level, encoding.blocks) : storeLevel(to, encoding, level);
    };
    MapLevel<float> level{decoded.width, decoded.height, decoded.texels};
    append(level);
    std::vector<float> texels; // of the level, which mips are made of before they are rounded
    while ((level.width > 1 || level.height > 1) && words.firsts.size() < kMostMapLevels) {
        texels = halved(level);
        level = {level.halfWidth(), level.halfHeight(), texels};
        words.roundOff = std::max(words.roundOff, append(level));
    }
    RELIEF_CHECK(words.words.size() * 4 == mapBytes(encoding.format, decoded.width, decoded.height));
    return words;
}

std::uint64_t mapBytes(MapFormat format, int width, int height) {
    std::uint64_t bytes = levelBytes(format, ivec2(width, height));
    for (std::uint32_t level = 1; (width > 1 || height > 1) && level < kMostMapLevels; ++level) {
        width = std::max(1, width / 2), height = std::max(1, height / 2);
        bytes += levelBytes(format, ivec2(width, height));
    }
    return bytes;
}

} // namespace relief
