#include <algorithm>
#include <cmath>

#include "doctor/examiners.h"

namespace relief {
namespace {

int wrappedIndex(int index, int size, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::clamp(index, 0, size - 1);
    const int rest = index % size;
    return rest < 0 ? rest + size : rest;
}

/// Findings of the file itself.
void examineFile(const MapCase& map, const std::string& path, const HeightCensus& census, Findings& findings) {
    if (!map.info.hasUnit() && !map.options.height.scale)
        findings.push_back({.kind = FindingKind::scale,
                            .isFault = false,
                            .text = "integer heights have no unit and no scale is given: the map spans one cage unit",
                            .advice = "--scale with the height in cage units between black and white",
                            .figure = 1});
    if (census.voidCount() > 0)
        findings.push_back({.kind = FindingKind::voids,
                            .text = fmt::format("{} of {} texels are voids ({}); they are filled from around them",
                                                census.voidCount(), map.map.texels.size(), census.voidReason()),
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

void examineOutside(const MapCase& map, Findings& findings) {
    const SurfaceLayout& layout = *map.subject.layout;
    constexpr double kRounding = 1e-4;
    if (!layout.hasTexCoords || map.options.namesWrap) return;
    const double most = std::max({-layout.lower.x, -layout.lower.y, layout.upper.x - 1, layout.upper.y - 1});
    if (most <= kRounding) return;
    findings.push_back(
        {.kind = FindingKind::outside,
         .text = fmt::format("texture coordinates go from ({:.4g}, {:.4g}) to ({:.4g}, {:.4g}), where the "
                             "map repeats",
                             layout.lower.x, layout.lower.y, layout.upper.x, layout.upper.y),
         .advice = "--wrap repeat or clamp says what is meant; else pack the islands into the unit square",
         .figure = most});
}

HeightMap loadVectors(const std::string& path, const DoctorOptions& options, const Warn& warn) {
    VectorOptions own = *options.vectors;
    own.mid = options.height.mid, own.scale = options.height.scale, own.channel = options.height.channel;
    own.wrap = options.height.wrap, own.limits = options.height.limits;
    return loadVectorMap(path, own, warn);
}

/// The channel as it is in the file, with its voids.
HeightCensus takeCensus(const std::string& path, const ImageInfo& info, const HeightOptions& options) {
    HeightCensus census(info);
    const ChannelIndex index = findChannel(info, options.channel).value_or(ChannelIndex());
    for (const float texel : readImage(path, index.channel, options.limits, index.part).texels) census.add(texel);
    census.finish();
    return census;
}

} // namespace

std::vector<std::uint32_t> coverTexels(const SurfaceLayout& layout, int width, int height, Wrap wrap) {
    std::vector<std::uint32_t> coverage(std::size_t(width) * std::size_t(height), kNoIsland);
    // Cells far outside of the map, or several times as large, cover no more of it.
    const dvec2 size(width, height), most = 8.0 * size;
    for (const LayoutCell& cell : layout.cells) {
        std::array<dvec2, 4> corners;
        for (std::size_t k = 0; k < 4; ++k)
            corners[k] = dvec2(cell.corners[k].x * width, (1 - cell.corners[k].y) * height) - 0.5;
        eachPointIn(corners, -most, most, [&](int x, int y) {
            const auto row = std::size_t(wrappedIndex(y, height, wrap));
            coverage[row * std::size_t(width) + std::size_t(wrappedIndex(x, width, wrap))] = cell.island;
        });
    }
    return coverage;
}

bool Examination::isHealthy() const {
    return std::ranges::none_of(findings, [](const Finding& finding) { return finding.isFault; });
}

Examination examineMap(const std::string& path, const DoctorOptions& options, const DoctorSubject& subject) {
    // What loading warns of are findings, with their figures.
    Examination result{.path = path};
    const ImageInfo info = readImageInfo(path, options.height.limits);
    const Warn ignore = [](const std::string&) {};
    result.map =
        options.vectors ? loadVectors(path, options, ignore) : loadHeightMap(path, options.height, ignore).decoded;
    if (result.map.addressing != Addressing::texture)
        fail(Failure::usage, "{}: one map over the unit square is examined; name the files of a set one by one", path);
    scaleHeights(result.map, 1 / subject.unit);
    result.bound = result.map.heightBound() * subject.unit;

    // The texels that the surface shows: what lies between islands is no height, and empty islands have a finding of
    // their own.
    const SurfaceLayout& layout = *subject.layout;
    const std::vector<std::uint32_t> coverage =
        coverTexels(layout, result.map.width, result.map.height, result.map.wrap);
    const std::vector<vec2> ranges = computeIslandRanges(layout, result.map, coverage);
    MapCase map{subject, options, info, result.map, result.map.texels, {}};
    std::ranges::sort(map.sorted);
    for (std::size_t i = 0; i < coverage.size(); ++i)
        if (coverage[i] != kNoIsland && !isEmptyIsland(ranges[coverage[i]], result.map))
            map.used.push_back(result.map.texels[i]);
    std::ranges::sort(map.used);
    if (map.used.empty()) map.used = map.sorted;

    // Colors come before the midlevel and flips before seams: the former explain the latter.
    Findings& findings = result.findings;
    examineFile(map, path, takeCensus(path, info, options.height), findings);
    result.seams = reportSeams(*subject.surface, *subject.reference, result.map);
    if (options.vectors) {
        examineVectors(map, coverage, findings);
    } else {
        examineSteps(map, findings);
        examineColors(map, findings);
        examineSigns(map, findings);
        examineMidlevel(map, findings);
        examineFlips(map, result.seams, coverage, findings);
    }
    examineSeams(map, result.seams, findings);
    examineOutside(map, findings);
    examineIslands(map, ranges, findings);
    examineStretch(map, findings);
    if (options.vectors)
        examineTurns(map, findings);
    else
        examineFolds(map, findings);
    std::ranges::stable_sort(findings, {}, &Finding::kind);
    return result;
}

} // namespace relief
