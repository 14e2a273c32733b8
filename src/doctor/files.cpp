// What the files of a map show: of a single one, and of each of a set.
#include <algorithm>
#include <map>

#include "doctor/examiners.h"

namespace relief {
namespace {

/// The channel as it is in the file, with its voids.
HeightCensus takeCensus(const std::string& path, const ImageInfo& info, const HeightOptions& options) {
    HeightCensus census(info);
    const ChannelIndex index = findChannel(info, options.channel).value_or(ChannelIndex());
    for (const float texel : readImage(path, index.channel, options.limits, index.part).texels) census.add(texel);
    census.finish();
    return census;
}

/// A finding that several tiles share: that of the first tile, and the number of tiles.
struct SharedFinding {
    Finding first;
    std::string tile;
    std::size_t count = 0;
};

std::string describeTiles(const SharedFinding& shared) {
    if (shared.count == 1) return fmt::format("tile {}", shared.tile);
    return fmt::format("tile {} and {} more", shared.tile, shared.count - 1);
}

} // namespace

void examineFile(const MapCase& map, const std::string& path, Findings& findings) {
    if (!map.info.hasUnit() && !map.options.height.scale)
        findings.push_back({.kind = FindingKind::scale,
                            .isFault = false,
                            .text = "integer heights have no unit and no scale is given: the map spans one cage unit",
                            .advice = "--scale with the height in cage units between black and white",
                            .figure = 1});
    const HeightCensus census = takeCensus(path, map.info, map.options.height);
    if (census.voidCount() > 0)
        findings.push_back(
            {.kind = FindingKind::voids,
             .text = fmt::format("{} of {} texels are voids ({}); they are filled from around them", census.voidCount(),
                                 std::size_t(map.info.width) * std::size_t(map.info.height), census.voidReason()),
             .advice = "fill them in the program that made the map",
             .figure = double(census.voidCount())});
    const std::vector<std::string> layers = layersOf(map.info);
    if (layers.size() > 1 && map.options.height.channel.empty())
        findings.push_back({.kind = FindingKind::channel,
                            .isFault = false,
                            .text = fmt::format("{} has {} layers, and none is named: {} is taken", path, layers.size(),
                                                map.info.channelNames.front()),
                            .advice = "--channel NAME",
                            .figure = double(layers.size())});
}

void examineTiles(const std::string& path, const DoctorOptions& options, const DoctorSubject& subject,
                  std::span<const std::uint32_t> coverage, Findings& findings) {
    const TilePattern pattern = *findTilePattern(path);
    std::map<FindingKind, SharedFinding> shared;
    std::size_t first = 0; // of the tile's texels in the set
    for (const TileFile& file : listTiles(path)) {
        // The tile as a map of its own.
        const ImageInfo info = readImageInfo(file.path, options.height.limits);
        HeightMap tile = loadHeightMap(file.path, options.height, [](const std::string&) {}).decoded;
        scaleHeights(tile, 1 / subject.unit);
        MapCase map{subject, options, info, tile, tile.texels, {}};
        std::ranges::sort(map.sorted);
        for (std::size_t i = 0; i < tile.texels.size(); ++i)
            if (coverage[first + i] != kNoIsland) map.used.push_back(tile.texels[i]);
        std::ranges::sort(map.used);
        first += tile.texels.size();
        if (map.used.empty()) continue; // no face shows it

        Findings own;
        examineFile(map, file.path, own);
        examineSteps(map, own);
        examineColors(map, own);
        examineSigns(map, own);
        examineMidlevel(map, own);
        for (const Finding& finding : own) {
            SharedFinding& entry = shared[finding.kind];
            if (entry.count++ == 0) entry.first = finding, entry.tile = nameTile(pattern, file.place);
        }
    }
    for (const auto& [kind, entry] : shared) {
        findings.push_back(entry.first);
        findings.back().text = fmt::format("{}: {}", describeTiles(entry), entry.first.text);
    }
}

} // namespace relief
