#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "measure/measure.h"

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

HeightMap withTexels(const HeightMap& map, std::vector<float> texels) {
    return makeHeightMap(map.width, map.height, std::move(texels), map.mid, map.scale, map.wrap);
}

/// Each 4 x 4 texels through the encoder and back; blocks at the border repeat its texels.
void throughBc4(std::vector<float>& unit, int width, int height) {
    for (int y = 0; y < height; y += 4)
        for (int x = 0; x < width; x += 4) {
            std::array<float, 16> block;
            const auto texel = [&](int i) -> float& {
                const int row = std::min(y + i / 4, height - 1), column = std::min(x + i % 4, width - 1);
                return unit[std::size_t(row) * std::size_t(width) + std::size_t(column)];
            };
            for (int i = 0; i < 16; ++i) block[std::size_t(i)] = texel(i);
            const std::array<float, 16> decoded = decodeBc4(encodeBc4(block));
            for (int i = 15; i >= 0; --i) texel(i) = decoded[std::size_t(i)]; // the inner of repeated ones last
        }
}

/// Texels 0..count-1 of a line as means of what they cover of `from`.
void shrinkLine(std::span<const float> from, std::span<float> to) {
    const double step = double(from.size()) / double(to.size());
    for (std::size_t i = 0; i < to.size(); ++i) {
        const double first = double(i) * step, end = std::min(double(i + 1) * step, double(from.size()));
        double sum = 0;
        for (auto k = std::size_t(first); k < from.size() && double(k) < end; ++k)
            sum += from[k] * (std::min(end, double(k) + 1) - std::max(first, double(k)));
        to[i] = float(sum / (end - first));
    }
}

} // namespace

std::array<std::uint8_t, 8> encodeBc4(std::span<const float, 16> values) {
    const auto [lowest, highest] = std::ranges::minmax(values);
    std::uint8_t best[2] = {byteOf(highest), byteOf(lowest)};
    double least = errorOf(best[0], best[1], values);
    // End points a little inside of the range often serve the values between better.
    const int low = byteOf(lowest), high = byteOf(highest), reach = std::min(4, (high - low) / 4);
    for (int a = -1; a <= reach; ++a)
        for (int b = -1; b <= reach; ++b) {
            const auto red0 = std::uint8_t(std::clamp(high - a, 0, 255)),
                       red1 = std::uint8_t(std::clamp(low + b, 0, 255));
            const double error = errorOf(red0, red1, values);
            if (error < least) least = error, best[0] = red0, best[1] = red1;
        }
    const std::array<float, 8> palette = paletteOf(best[0], best[1]);
    std::uint64_t bits = 0; // three a value, the first value lowest
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

HeightMap decodedMap(const HeightMap& map, MapFormat format) {
    std::vector<float> texels = map.texels;
    if (format == MapFormat::real) return map;
    if (format == MapFormat::half) {
        for (float& texel : texels) texel = glm::unpackHalf1x16(glm::packHalf1x16(texel));
        return withTexels(map, std::move(texels));
    }
    const float lowest = map.lowest, range = map.highest > map.lowest ? map.highest - map.lowest : 1;
    for (float& texel : texels) texel = (texel - lowest) / range;
    const float steps = format == MapFormat::unorm16 ? 65535.0f : 255.0f;
    if (format == MapFormat::bc4)
        throughBc4(texels, map.width, map.height);
    else
        for (float& texel : texels) texel = std::round(texel * steps) / steps;
    for (float& texel : texels) texel = lowest + range * texel;
    return withTexels(map, std::move(texels));
}

HeightMap resampled(const HeightMap& map, int width, int height) {
    if (width == map.width && height == map.height) return map;
    std::vector<float> rows(std::size_t(width) * std::size_t(map.height));
    for (std::size_t y = 0; y < std::size_t(map.height); ++y)
        shrinkLine(std::span(map.texels).subspan(y * std::size_t(map.width), std::size_t(map.width)),
                   std::span(rows).subspan(y * std::size_t(width), std::size_t(width)));
    std::vector<float> texels(std::size_t(width) * std::size_t(height));
    std::vector<float> column(rows.size() / std::size_t(width)), shrunk(texels.size() / std::size_t(width));
    for (std::size_t x = 0; x < std::size_t(width); ++x) {
        for (std::size_t y = 0; y < column.size(); ++y) column[y] = rows[y * std::size_t(width) + x];
        shrinkLine(column, shrunk);
        for (std::size_t y = 0; y < shrunk.size(); ++y) texels[y * std::size_t(width) + x] = shrunk[y];
    }
    return makeHeightMap(width, height, std::move(texels), map.mid, map.scale, map.wrap);
}

} // namespace relief
