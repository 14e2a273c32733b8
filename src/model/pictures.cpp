#include "model/pictures.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <glm/gtc/packing.hpp>

#include "displacement/mips.h"

namespace relief {
namespace {

/// RGBA bytes of an albedo picture and of its mips, largest first; averages run on linear light.
struct AlbedoMips {
    std::vector<std::uint8_t> bytes;
    std::uint32_t levels = 0;
};

double linearOf(double srgb) { return srgb <= 0.04045 ? srgb / 12.92 : std::pow((srgb + 0.055) / 1.055, 2.4); }
double srgbOf(double linear) {
    return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

std::uint8_t byteOf(double value) { return std::uint8_t(std::lround(255 * std::clamp(value, 0.0, 1.0))); }

struct AlbedoTables {
    double linear[256];
    std::uint8_t srgb[4096];
    AlbedoTables() {
        for (int i = 0; i < 256; ++i) linear[i] = linearOf(i / 255.0);
        for (int i = 0; i < 4096; ++i) srgb[i] = byteOf(srgbOf(i / 4095.0));
    }
};

AlbedoMips albedoMips(const Image& image) {
    static const AlbedoTables tables;
    // Level 0: the codes of the picture, opaque.
    AlbedoMips mips;
    auto width = std::size_t(image.width), height = std::size_t(image.height);
    mips.bytes.reserve(width * height * 4 * 4 / 3 + 64);
    for (std::size_t i = 0; i < width * height; ++i)
        for (std::size_t c = 0; c < 4; ++c)
            mips.bytes.push_back(c < 3 ? byteOf(image.texels[i * std::size_t(image.channels) + c]) : 255);
    // Further levels: the mean of four texels of the level before, in linear light.
    std::size_t from = 0;
    for (mips.levels = 1; width > 1 || height > 1; ++mips.levels) {
        const std::size_t w = std::max<std::size_t>(1, width / 2), h = std::max<std::size_t>(1, height / 2);
        const std::size_t to = mips.bytes.size();
        for (std::size_t y = 0; y < h; ++y)
            for (std::size_t x = 0; x < w; ++x)
                for (std::size_t c = 0; c < 4; ++c) {
                    double sum = 0;
                    for (std::size_t k = 0; k < 4; ++k) {
                        const std::size_t sx = std::min(2 * x + k % 2, width - 1),
                                          sy = std::min(2 * y + k / 2, height - 1);
                        sum += tables.linear[mips.bytes[from + (sy * width + sx) * 4 + c]];
                    }
                    mips.bytes.push_back(tables.srgb[std::size_t(sum / 4 * 4095 + 0.5)]);
                }
        from = to, width = w, height = h;
    }
    return mips;
}

/// Normals as four halves each, and those of the mips.
std::vector<std::uint64_t> packNormals(const NormalMap& map, std::uint32_t& levels) {
    std::vector<std::uint64_t> texels;
    MapLevel<vec3> level{map.width, map.height, map.normals};
    std::vector<vec3> normals; // of the level
    for (levels = 1;; ++levels) {
        for (const vec3& n : level.texels) texels.push_back(glm::packHalf4x16({n, 0}));
        if (level.width == 1 && level.height == 1) return texels;
        normals = halved(level);
        level = {level.halfWidth(), level.halfHeight(), normals};
    }
}

std::size_t texelBytes(MapFormat format) { return format == MapFormat::real ? 4 : format == MapFormat::unorm8 ? 1 : 2; }

/// Brings the texels of a level from rows into blocks of 4 x 4.
void toBlocks(std::span<std::byte> texels, const ivec2& size, std::size_t bytes) {
    const std::vector<std::byte> rows(texels.begin(), texels.end());
    const std::size_t blockRow = 4 * bytes, row = std::size_t(size.x) * bytes; // bytes
    std::byte* to = texels.data();
    for (std::size_t y = 0; y < std::size_t(size.y); y += 4)
        for (std::size_t x = 0; x < row; x += blockRow)
            for (std::size_t k = 0; k < 4; ++k, to += blockRow) std::memcpy(to, &rows[(y + k) * row + x], blockRow);
}

} // namespace

TexelBuffer uploadHeights(Device& device, MapWords map, MapFormat format) {
    std::vector<std::uint32_t>& words = map.words;
    for (std::size_t level = 0; level < map.firsts.size() && format != MapFormat::bc4; ++level) {
        const ivec2 size = map.sizes[level];
        if (!mapIsInBlocks(std::uint32_t(format), size)) continue;
        const std::size_t bytes = std::size_t(size.x) * std::size_t(size.y) * texelBytes(format);
        toBlocks(std::as_writable_bytes(std::span(words)).subspan(4 * std::size_t(map.firsts[level]), bytes), size,
                 texelBytes(format));
    }
    words.resize((words.size() + 1) / 2 * 2, 0);
    return uploadTexels(device, {.name = "height map"}, VK_FORMAT_R32G32_UINT, std::as_bytes(std::span(words)));
}

GpuSlopeMap uploadSlopes(Device& device, const HeightMap& map) {
    RELIEF_CHECK(map.addressing != Addressing::faces);
    if (map.addressing == Addressing::tiles) {
        const JoinedMap joined = joinTiles(map);
        GpuSlopeMap slopes = uploadSlopes(device, joined.map);
        slopes.tiles = joined.tiles;
        return slopes;
    }
    const SlopeMap slopes = computeSlopes(map);
    return {uploadTexture(device,
                          {.name = "slopes",
                           .width = std::uint32_t(map.width),
                           .height = std::uint32_t(map.height),
                           .mipCount = slopes.levelCount,
                           .format = VK_FORMAT_R16G16_SFLOAT},
                          std::as_bytes(std::span(slopes.texels)), 4),
            slopes.unit,
            map.wrap,
            slopes.texels.size() * sizeof(slopes.texels[0]),
            {}};
}

GpuNormalMap uploadNormals(Device& device, const NormalMap& map) {
    std::uint32_t levels = 0;
    const std::vector<std::uint64_t> texels = packNormals(map, levels);
    return {uploadTexture(device,
                          {.name = "normal map",
                           .width = std::uint32_t(map.width),
                           .height = std::uint32_t(map.height),
                           .mipCount = levels,
                           .format = VK_FORMAT_R16G16B16A16_SFLOAT},
                          std::as_bytes(std::span(texels)), 8),
            map.space, map.wrap, map.tiles};
}

Texture uploadAlbedo(Device& device, const Image& image) {
    const AlbedoMips mips = albedoMips(image);
    // Samplers decode the codes each in its own way, but choose none: drivers differ by less than a code of a picture.
    return uploadTexture(device,
                         {.name = "albedo map",
                          .width = std::uint32_t(image.width),
                          .height = std::uint32_t(image.height),
                          .mipCount = mips.levels,
                          .format = VK_FORMAT_R8G8B8A8_SRGB},
                         std::as_bytes(std::span(mips.bytes)), 4);
}

} // namespace relief
