// Loading vector maps: single pictures, and sets of tiles over unit squares.
#include <set>

#include "displacement/parallel.h"
#include "displacement/tile_set.h"
#include "displacement/vector_parts.h"

namespace relief {
namespace {

/// Which three channels: the first of them.
ChannelIndex findComponents(const ImageInfo& info, const std::string& path, const std::string& word) {
    if (isFaceMap(info))
        fail(Failure::input, "{}: this is a map per face, which holds heights; name it with --height", path);
    ChannelIndex index;
    if (!word.empty()) {
        const std::optional<ChannelIndex> found = findChannel(info, word);
        if (!found) fail(Failure::input, "{}: there is no channel {}", path, word);
        index = *found;
    }
    const std::size_t part = std::size_t(index.part);
    const std::size_t count =
        part < info.parts.size() ? info.parts[part].channelNames.size() : std::size_t(info.channels);
    if (std::size_t(index.channel) + 3 > count)
        fail(Failure::input, "{}: a vector map has 3 channels (x, y and z), this picture has {}{}", path,
             count - std::size_t(index.channel), index.channel > 0 ? " from that channel on" : "");
    return index;
}

void warnAboutFile(const ImageInfo& info, const std::string& path, const VectorOptions& options, const Warn& warn) {
    if (options.channel.empty() && info.channels > 3)
        warn(fmt::format("{}: there are {} channels; {}, {} and {} are taken as x, y and z: choose with --channel NAME",
                         path, info.channels, info.channelNames[0], info.channelNames[1], info.channelNames[2]));
    if (info.sampleBytes == 1) warn(fmt::format("{}: 8-bit vectors show as stairs; use 16 bits or float", path));
    if (!info.hasUnit() && !options.scale)
        warn(
            fmt::format("{}: integer vectors have no unit and no scale is given; 1 is used: components are -0.5 to 0.5 "
                        "cage units",
                        path));
}

double midOf(const ImageInfo& info, const VectorOptions& options) {
    return options.mid.value_or(info.hasUnit() ? 0.0 : 0.5);
}

std::array<HeightMap, 3> readComponents(const std::string& path, const ImageInfo& info, const VectorOptions& options) {
    const ChannelIndex index = findComponents(info, path, options.channel);
    const Image image = readImage(path, -1, options.limits, index.part);
    if (const std::optional<BadTexel> bad = findNotFinite(image))
        fail(Failure::input, "{}: channel {} of the texel in column {}, row {} (from 0, top left) is {}", path,
             bad->channel, bad->x, bad->y, bad->value);
    VectorOptions own = options;
    own.mid = midOf(info, options);
    return takeComponents(image, std::size_t(index.channel), own);
}

HeightMap loadVectorSet(const std::string& path, const VectorOptions& options, const Warn& warn) {
    // Headers first: what they ask for is checked before memory is taken.
    const std::vector<TileFile> files = listTiles(path);
    std::vector<ImageInfo> infos;
    std::vector<ivec2> places;
    HeightMap sizes{.wrap = Wrap::clamp, .addressing = Addressing::tiles};
    std::set<std::string> said; // one line for the set of what is true of several files
    bool isAlike = true;
    for (const TileFile& file : files) {
        infos.push_back(readImageInfo(file.path, options.limits));
        findComponents(infos.back(), file.path, options.channel);
        isAlike = isAlike && infos.back().sample == infos.front().sample;
        places.push_back(file.place);
        sizes.tiles.push_back({.place = file.place, .size = {infos.back().width, infos.back().height}});
        warnAboutFile(infos.back(), file.path, options, [&](const std::string& line) {
            if (said.insert(line.substr(file.path.size())).second) warn(line);
        });
    }
    const MapFormat format = options.format.value_or(isAlike ? fileFormat(infos.front()) : MapFormat::real);
    checkSetMemory(path, sizes, format, 3);

    // Files of different types have different values without displacement: those are taken away then.
    std::array<std::vector<HeightMap>, 3> tiles;
    for (std::vector<HeightMap>& component : tiles) component.resize(files.size());
    forEachAtOnce(files.size(), [&](std::size_t i) {
        std::array<HeightMap, 3> own = readComponents(files[i].path, infos[i], options);
        for (std::size_t k = 0; k < 3; ++k) {
            if (!isAlike)
                for (float& texel : own[k].texels) texel -= float(own[k].mid);
            if (!isAlike) own[k].mid = 0;
            tiles[k][i] = std::move(own[k]);
        }
    });
    std::array<HeightMap, 3> components;
    for (std::size_t k = 0; k < 3; ++k) {
        components[k] = makeTileSet(tiles[k], places);
        tiles[k].clear();
    }
    return joinComponents(components, options.space, format);
}

} // namespace

HeightMap loadVectorMap(const std::string& path, const VectorOptions& options, const Warn& warn) {
    checkAxes(options);
    if (findTilePattern(path)) return loadVectorSet(path, options, warn);
    const ImageInfo info = readImageInfo(path, options.limits);
    findComponents(info, path, options.channel);
    warnAboutFile(info, path, options, warn);
    return joinComponents(readComponents(path, info, options), options.space,
                          options.format.value_or(fileFormat(info)));
}

} // namespace relief
