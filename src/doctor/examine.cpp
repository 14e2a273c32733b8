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

/// Parts of the surface where a set has no tile.
void examineMissingTiles(const MapCase& map, Findings& findings) {
    double area = 0, missing = 0;
    const LayoutCell* first = nullptr;
    for (const LayoutCell& cell : map.subject.layout->cells) {
        area += cell.area;
        if (findTile(map.map.tiles, cell.st) != nullptr) continue;
        missing += cell.area;
        if (first == nullptr) first = &cell;
    }
    if (first == nullptr) return;
    findings.push_back({.kind = FindingKind::outside,
                        .isFault = false,
                        .text = fmt::format("{:.1f} % of the surface lies where the set has no tile, first at {}",
                                            100 * missing / area, describeSpot(map, first->at)),
                        .advice = "nothing, if these parts are meant to stay smooth; else export their tiles as well",
                        .figure = missing / area,
                        .at = first->at});
}

void examineOutside(const MapCase& map, Findings& findings) {
    if (map.map.addressing == Addressing::tiles) return examineMissingTiles(map, findings);
    if (map.map.addressing == Addressing::faces) return;
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

/// The map as it displaces the surface, in the unit of positions.
HeightMap loadMap(const std::string& path, const DoctorOptions& options, const DoctorSubject& subject) {
    // What loading warns of are findings, with their figures.
    const Warn ignore = [](const std::string&) {};
    if (findTilePattern(path) && !subject.layout->hasTexCoords)
        fail(Failure::input, "{}: a set of tiles needs texture coordinates, and the cage has none", path);
    HeightMap map =
        options.vectors ? loadVectors(path, options, ignore) : loadHeightMap(path, options.height, ignore).decoded;
    if (map.addressing == Addressing::faces) {
        if (map.topology != subject.topology)
            fail(Failure::input, "{}: this map per face was made for another cage ({:016x}, not {:016x})", path,
                 map.topology, subject.topology);
        fitToFaces(map, *subject.surface);
    }
    scaleHeights(map, 1 / subject.unit);
    return map;
}

/// Calls `take(x, y, island)` with the texels that cells cover of a picture of the unit square from `lower` on.
template <typename Take>
void eachCovered(const SurfaceLayout& layout, const ivec2& size, const dvec2& lower, double margin, const Take& take) {
    for (const LayoutCell& cell : layout.cells) {
        std::array<dvec2, 4> corners;
        for (std::size_t k = 0; k < 4; ++k)
            corners[k] =
                dvec2((cell.corners[k].x - lower.x) * size.x, (1 - (cell.corners[k].y - lower.y)) * size.y) - 0.5;
        eachPointIn(corners, -margin * dvec2(size), dvec2(size) - 1.0 + margin * dvec2(size),
                    [&](int x, int y) { take(x, y, cell.island); });
    }
}

} // namespace

std::vector<float> valuesOf(const HeightMap& map) {
    if (map.addressing == Addressing::texture) return map.texels;
    std::vector<float> values;
    const int apron = apronOf(map.addressing);
    for (const MapTile& tile : map.tiles)
        for (int y = 0; y < tile.size.y; ++y) {
            const auto stride = std::ptrdiff_t(tile.size.x) + 2 * apron;
            const float* row = &map.texels[tile.first] + (y + apron) * stride + apron;
            values.insert(values.end(), row, row + tile.size.x);
        }
    return values;
}

std::vector<std::uint32_t> coverTexels(const SurfaceLayout& layout, const HeightMap& map) {
    if (map.addressing == Addressing::texture) {
        // Cells far outside of the map, or several times as large, cover no more of it.
        constexpr double kMargin = 8;
        std::vector<std::uint32_t> coverage(map.texels.size(), kNoIsland);
        eachCovered(layout, {map.width, map.height}, dvec2(0), kMargin, [&](int x, int y, std::uint32_t island) {
            const auto row = std::size_t(wrappedIndex(y, map.height, map.wrap));
            coverage[row * std::size_t(map.width) + std::size_t(wrappedIndex(x, map.width, map.wrap))] = island;
        });
        return coverage;
    }
    std::vector<std::uint32_t> coverage;
    std::vector<std::uint32_t> islands(map.tiles.size(), kNoIsland); // of faces
    if (map.addressing == Addressing::faces)
        for (const LayoutCell& cell : layout.cells) islands[cell.at.face] = cell.island;
    for (std::size_t t = 0; t < map.tiles.size(); ++t) {
        const ivec2 size = map.tiles[t].size;
        const std::size_t first = coverage.size();
        coverage.resize(first + std::size_t(size.x) * std::size_t(size.y), islands[t]);
        if (map.addressing == Addressing::faces) continue;
        eachCovered(layout, size, dvec2(map.tiles[t].place), 0, [&](int x, int y, std::uint32_t island) {
            coverage[first + std::size_t(y) * std::size_t(size.x) + std::size_t(x)] = island;
        });
    }
    return coverage;
}

bool Examination::isHealthy() const {
    return std::ranges::none_of(findings, [](const Finding& finding) { return finding.isFault; });
}

Examination examineMap(const std::string& path, const DoctorOptions& options, const DoctorSubject& subject) {
    Examination result{.path = path, .scheme = subject.surface->scheme};
    if (options.vectors) result.vectorOrder = options.vectors->order, result.vectorFlip = options.vectors->flip;
    const bool isSet = findTilePattern(path).has_value();
    const std::string file = isSet ? listTiles(path).front().path : path;
    const ImageInfo info = readImageInfo(file, options.height.limits);
    result.map = loadMap(path, options, subject);
    result.bound = result.map.heightBound() * subject.unit;

    // The texels that the surface shows: what lies between islands is no height, and empty islands have a finding of
    // their own.
    const SurfaceLayout& layout = *subject.layout;
    const std::vector<std::uint32_t> coverage = coverTexels(layout, result.map);
    const std::vector<float> values = valuesOf(result.map);
    const std::vector<vec2> ranges = computeIslandRanges(layout, result.map, coverage);
    MapCase map{subject, options, info, result.map, values, {}};
    std::ranges::sort(map.sorted);
    for (std::size_t i = 0; i < coverage.size(); ++i)
        if (coverage[i] != kNoIsland && !isEmptyIsland(ranges[coverage[i]], result.map)) map.used.push_back(values[i]);
    std::ranges::sort(map.used);
    if (map.used.empty()) map.used = map.sorted;

    // Colors come before the midlevel and flips before seams: the former explain the latter.
    Findings& findings = result.findings;
    const bool isPerFace = result.map.addressing == Addressing::faces;
    if (!isPerFace) result.seams = reportSeams(*subject.surface, *subject.reference, result.map);
    if (isSet && !options.vectors)
        examineTiles(path, options, subject, coverage, findings);
    else
        examineFile(map, file, findings);
    if (options.vectors) {
        examineVectors(map, coverage, findings);
    } else {
        if (!isSet) examineSteps(map, findings), examineColors(map, findings);
        if (!isSet) examineSigns(map, findings), examineMidlevel(map, findings);
        if (!isPerFace) examineFlips(map, result.seams, coverage, findings);
    }
    if (!isPerFace) examineSeams(map, result.seams, findings);
    examineOutside(map, findings);
    examineIslands(map, ranges, findings);
    if (!isPerFace) examineStretch(map, findings);
    if (options.vectors)
        examineTurns(map, findings);
    else
        examineFolds(map, findings);
    std::ranges::stable_sort(findings, {}, &Finding::kind);
    return result;
}

} // namespace relief
