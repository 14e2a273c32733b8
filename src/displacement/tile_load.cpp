// Loading sets of tiles over unit squares.
#include <cstdio>
#include <set>

#include "displacement/parallel.h"
#include "displacement/tile_levels.h"
#include "displacement/tile_set.h"
#include "displacement/voids.h"

namespace relief {
namespace {

/// Bytes that programs may still take, as the system estimates it; 0 where it does not say.
std::uint64_t availableBytes() {
    std::FILE* file = std::fopen("/proc/meminfo", "r");
    if (file == nullptr) return 0;
    std::uint64_t kilobytes = 0;
    char line[128];
    while (std::fgets(line, sizeof(line), file) != nullptr)
        if (unsigned long long value = 0; std::sscanf(line, "MemAvailable: %llu", &value) == 1) kilobytes = value;
    std::fclose(file);
    return 1024 * kilobytes;
}

} // namespace

void checkSetMemory(const std::string& path, const HeightMap& set, MapFormat format, int components) {
    std::uint64_t texels = 0;
    for (const MapTile& tile : set.tiles) {
        const ivec2 size = tile.size + 2 * kTileApron;
        texels += std::uint64_t(size.x) * std::uint64_t(size.y);
    }
    // Of vectors there are the components as read and as encoded, and their lengths.
    const std::uint64_t copies = components == 1 ? 2 : 3;
    const std::uint64_t bytes = std::uint64_t(components) * (copies * sizeof(float) * texels + mapBytes(format, set));
    const std::uint64_t available = availableBytes();
    if (available > 0 && bytes > available)
        fail(Failure::device, "{}: its {} tiles take {} of memory; {} are available: use smaller tiles", path,
             set.tiles.size(), humanBytes(bytes), humanBytes(available));
}

namespace {

/// Files of a set have the same channels, unless one is named.
void checkChannels(const std::vector<TileFile>& files, const std::vector<ImageInfo>& infos,
                   const HeightOptions& options) {
    for (std::size_t i = 1; i < files.size() && options.channel.empty(); ++i)
        if (infos[i].channels != infos[0].channels)
            fail(Failure::input, "{} has {} channels and {} has {}: --channel says which one is the height",
                 files[i].path, infos[i].channels, files[0].path, infos[0].channels);
}

/// One line for the set of what is true of several files.
void warnAboutSet(const std::vector<TileFile>& files, const std::vector<ImageInfo>& infos, const HeightOptions& options,
                  const Warn& warn) {
    std::set<std::string> said; // what follows the file's name
    for (std::size_t i = 0; i < files.size(); ++i)
        warnAbout(infos[i], files[i].path, options, [&](const std::string& line) {
            if (said.insert(line.substr(files[i].path.size())).second) warn(line);
        });
    // Three channels are a grey picture; two and four are something else beside the heights.
    const int channels = infos.front().channels;
    if (options.channel.empty() && (channels == 2 || channels > 3) && layersOf(infos.front()).size() < 2)
        warn(fmt::format("{}: there are {} channels; {} is taken as the height: choose with --channel NAME",
                         files.front().path, channels, infos.front().channelNames.front()));
}

} // namespace

EncodedMap loadTileSet(const std::string& path, const HeightOptions& options, const Warn& warn) {
    // Headers first: what they ask for is checked before memory is taken.
    const std::vector<TileFile> files = listTiles(path);
    HeightMap set{.scale = options.scale.value_or(1.0), .wrap = Wrap::clamp, .addressing = Addressing::tiles};
    std::vector<ImageInfo> infos;
    bool isAlike = true;
    for (const TileFile& file : files) {
        infos.push_back(readImageInfo(file.path, options.limits));
        isAlike = isAlike && infos.back().sample == infos.front().sample;
        set.tiles.push_back({.place = file.place, .size = {infos.back().width, infos.back().height}});
    }
    checkChannels(files, infos, options);
    warnAboutSet(files, infos, options, warn);
    const MapFormat format = isAlike ? fileFormat(infos.front()) : MapFormat::real;
    checkSetMemory(path, set, options.format.value_or(format));
    allocateTiles(set);

    // Files of different types have different values without height: each is read less its own.
    const auto midOf = [&](const ImageInfo& info) { return options.mid.value_or(info.hasUnit() ? 0.0 : 0.5); };
    const bool hasOneMid = std::ranges::all_of(infos, [&](const ImageInfo& i) { return midOf(i) == midOf(infos[0]); });
    set.mid = hasOneMid ? midOf(infos.front()) : 0.0;
    std::vector<std::vector<std::string>> warnings(files.size());
    forEachAtOnce(files.size(), [&](std::size_t i) {
        const Warn collect = [&](const std::string& line) { warnings[i].push_back(line); };
        HeightMap tile = loadTexels(files[i].path, options, infos[i], collect);
        const auto shift = float(hasOneMid ? 0.0 : midOf(infos[i]));
        if (shift != 0)
            for (float& texel : tile.texels) texel -= shift;
        copyTile(tile.texels, set, set.tiles[i]);
    });
    for (const std::vector<std::string>& lines : warnings)
        for (const std::string& line : lines) warn(line);
    finishTiles(set);
    if (options.format) return encode(set, *options.format);
    const MapEncoding encoding{.format = format, .blocks = {}};
    if (!hasOneSize(set)) roundTiles(set, encoding); // aprons hold numbers between texels
    return {std::move(set), encoding};
}

} // namespace relief
