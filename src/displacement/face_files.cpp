// Maps per face on disk: one EXR of packed tiles, rows of nodes from v = 0 down. The header holds the layout: for each
// face log2 of its segments along u and v, a hexadecimal digit each. Tiles are packed by falling height, then width,
// then the number of the face: row after row from the left, as wide as the picture is.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <numeric>

#include <glm/gtc/packing.hpp>

#include "displacement/tile_set.h"

namespace relief {
namespace {

constexpr const char* kFacesAttribute = "relief:faces";
constexpr const char* kTopologyAttribute = "relief:topology";
constexpr int kMostSegments = 12; ///< log2

/// The corners of packed tiles, and the height of the picture.
struct Packing {
    std::vector<ivec2> corners;
    int height = 0;
};

Packing packFaces(std::span<const ivec2> segments, int width) {
    std::vector<std::size_t> order(segments.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
        return segments[a].y != segments[b].y ? segments[a].y > segments[b].y : segments[a].x > segments[b].x;
    });
    Packing packing{std::vector<ivec2>(segments.size()), 0};
    ivec2 at(0);
    for (const std::size_t f : order) {
        const ivec2 size = ivec2(1 << segments[f].x, 1 << segments[f].y) + 1;
        if (at.x + size.x > width) at = {0, packing.height};
        packing.corners[f] = at;
        packing.height = std::max(packing.height, at.y + size.y);
        at.x += size.x;
    }
    return packing;
}

int chooseWidth(std::span<const ivec2> segments) {
    double area = 0;
    int widest = 1;
    for (const ivec2& s : segments) {
        area += double((1 << s.x) + 1) * double((1 << s.y) + 1);
        widest = std::max(widest, (1 << s.x) + 1);
    }
    return std::max(widest, int(std::ceil(std::sqrt(area))));
}

int hexDigit(char c) {
    int value = -1;
    std::from_chars(&c, &c + 1, value, 16);
    return value;
}

} // namespace

bool isFaceMap(const ImageInfo& info) { return info.attributes.contains(kFacesAttribute); }

FaceMapInfo readFaceMapInfo(const ImageInfo& info, const std::string& name) {
    const auto textOf = [&](const char* attribute) {
        const auto found = info.attributes.find(attribute);
        return found == info.attributes.end() ? std::string() : found->second;
    };
    FaceMapInfo result;
    const std::string digits = textOf(kFacesAttribute), topology = textOf(kTopologyAttribute);
    for (std::size_t i = 0; i + 1 < digits.size(); i += 2)
        result.segments.emplace_back(hexDigit(digits[i]), hexDigit(digits[i + 1]));
    const bool isBad = digits.empty() || digits.size() % 2 != 0 || std::ranges::any_of(result.segments, [](ivec2 s) {
                           return std::min(s.x, s.y) < 0 || std::max(s.x, s.y) > kMostSegments;
                       });
    const auto [end, error] = std::from_chars(topology.data(), topology.data() + topology.size(), result.topology, 16);
    if (isBad || error != std::errc() || end != topology.data() + topology.size())
        fail(Failure::input, "{}: its header does not say how large the tiles of its faces are; write it again", name);
    if (info.channels != 1)
        fail(Failure::input, "{}: a map per face has one channel, this one has {}", name, info.channels);
    const Packing packing = packFaces(result.segments, info.width);
    if (chooseWidth(result.segments) > info.width || packing.height != info.height)
        fail(Failure::input, "{}: its tiles do not fill a picture of {} x {}; it has been resized or cut", name,
             info.width, info.height);
    return result;
}

EncodedMap loadFaceMap(const std::string& path, const HeightOptions& options, const ImageInfo& info) {
    const FaceMapInfo faces = readFaceMapInfo(info, path);
    const Image image = readImage(path, 0, options.limits);
    if (const std::optional<BadTexel> bad = findNotFinite(image))
        fail(Failure::input,
             "{}: the texel in column {}, row {} (from 0, top left) is {}; fill the map's gaps with numbers", path,
             bad->x, bad->y, bad->value);
    HeightMap map{.mid = options.mid.value_or(0.0),
                  .scale = options.scale.value_or(1.0),
                  .wrap = Wrap::clamp,
                  .addressing = Addressing::faces,
                  .topology = faces.topology};
    for (std::size_t f = 0; f < faces.segments.size(); ++f)
        map.tiles.push_back({.place = {int(f), 0},
                             .size = ivec2(1 << faces.segments[f].x, 1 << faces.segments[f].y) + 1,
                             .segments = faces.segments[f]});
    allocateTiles(map);
    // Nodes in the picture lie without aprons, which neighbours will fill.
    const Packing packing = packFaces(faces.segments, info.width);
    for (std::size_t f = 0; f < map.tiles.size(); ++f) {
        std::vector<float> nodes;
        for (int j = 0; j < map.tiles[f].size.y; ++j) {
            const float* row = image.at(packing.corners[f].x, packing.corners[f].y + j);
            nodes.insert(nodes.end(), row, row + map.tiles[f].size.x);
        }
        copyTile(nodes, map, map.tiles[f]);
    }
    const auto [lowest, highest] = std::ranges::minmax(image.texels);
    map.lowest = lowest, map.highest = highest;
    return {std::move(map), {.format = options.format.value_or(fileFormat(info)), .blocks = {}}};
}

void saveFaceMap(const std::string& path, const HeightMap& map) {
    RELIEF_CHECK(map.addressing == Addressing::faces);
    std::vector<ivec2> segments;
    std::string digits;
    for (const MapTile& tile : map.tiles) {
        segments.push_back(tile.segments);
        digits += fmt::format("{:x}{:x}", tile.segments.x, tile.segments.y);
    }
    // One picture, packed so that a reader finds each face by its segments alone.
    const int width = chooseWidth(segments);
    const Packing packing = packFaces(segments, width);
    Image image{.width = width, .height = packing.height, .channels = 1, .texels = {}};
    image.texels.assign(std::size_t(image.width) * std::size_t(image.height), 0.0f);
    // Heights in cage units: mid and scale are applied, and the file needs neither.
    for (std::size_t f = 0; f < map.tiles.size(); ++f) {
        const MapTile& tile = map.tiles[f];
        const std::size_t stride = std::size_t(tile.size.x) + 2 * kFaceApron;
        for (int j = 0; j < tile.size.y; ++j)
            for (int i = 0; i < tile.size.x; ++i) {
                const float node =
                    map.texels[tile.first + std::size_t(j + kFaceApron) * stride + std::size_t(i + kFaceApron)];
                *image.at(packing.corners[f].x + i, packing.corners[f].y + j) =
                    float(map.scale * (double(node) - map.mid));
            }
    }
    const auto isHalf = [](float x) { return glm::unpackHalf1x16(glm::packHalf1x16(x)) == x; };
    writeImage(path, image, std::ranges::all_of(image.texels, isHalf) ? SampleType::half : SampleType::real,
               ImageAttributes{{kFacesAttribute, digits}, {kTopologyAttribute, fmt::format("{:016x}", map.topology)}});
}

} // namespace relief
