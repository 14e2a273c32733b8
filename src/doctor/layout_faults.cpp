// What a map does on its surface: seams, flips, islands, stretched texels, folds.
#include <algorithm>
#include <cmath>

#include "doctor/examiners.h"

namespace relief {
namespace {

// --- flips --------------------------------------------------------------------------------------------------------

struct Flip {
    const char* name;
    bool mirrorsS, mirrorsT, exchanges;
};
constexpr Flip kFlips[] = {
    {"mirrored along s", true, false, false},
    {"mirrored along t", false, true, false},
    {"turned by half a turn", true, true, false},
    {"with s and t exchanged", false, false, true},
};

HeightMap flippedTile(const HeightMap& map, const Flip& flip) {
    HeightMap result = map;
    for (int y = 0; y < map.height; ++y)
        for (int x = 0; x < map.width; ++x) {
            int column = flip.mirrorsS ? map.width - 1 - x : x, row = flip.mirrorsT ? map.height - 1 - y : y;
            if (flip.exchanges) column = map.height - 1 - y, row = map.width - 1 - x; // t points up
            result.texels[std::size_t(y) * std::size_t(map.width) + std::size_t(x)] =
                map.texels[std::size_t(row) * std::size_t(map.width) + std::size_t(column)];
        }
    return result;
}

/// A map, or each tile of a set.
HeightMap flipped(const HeightMap& map, const Flip& flip) {
    if (map.addressing == Addressing::texture) return flippedTile(map, flip);
    const std::vector<float> values = valuesOf(map);
    std::vector<HeightMap> tiles;
    std::vector<ivec2> places;
    auto first = values.begin();
    for (const MapTile& tile : map.tiles) {
        const auto last = first + std::ptrdiff_t(tile.size.x) * tile.size.y;
        tiles.push_back(
            flippedTile(makeHeightMap(tile.size.x, tile.size.y, {first, last}, map.mid, map.scale, Wrap::clamp), flip));
        places.push_back(tile.place);
        first = last;
    }
    return makeTileSet(tiles, places);
}

bool hasSquareTiles(const HeightMap& map) {
    return map.tiles.empty() ? map.width == map.height
                             : std::ranges::all_of(map.tiles, [](const MapTile& t) { return t.size.x == t.size.y; });
}

/// The value that fills what is not painted: the most frequent one, where it is on more than a fifth of all texels.
std::optional<float> findBackground(std::span<const float> sorted) {
    const std::size_t step = std::max<std::size_t>(sorted.size() / 5, 1);
    for (std::size_t i = 0; i + step < sorted.size(); ++i)
        if (sorted[i] == sorted[i + step]) return sorted[i];
    return {};
}

/// The share of painted texels that no island covers.
double shareOutside(const HeightMap& map, std::span<const std::uint32_t> coverage, float background) {
    const float slack = 1e-3f * (map.highest - map.lowest);
    const std::vector<float> values = valuesOf(map);
    double painted = 0, outside = 0;
    for (std::size_t i = 0; i < coverage.size(); ++i) {
        if (std::abs(values[i] - background) <= slack) continue;
        ++painted;
        if (coverage[i] == kNoIsland) ++outside;
    }
    return painted > 0 ? outside / painted : 0;
}

constexpr double kSeamMost = 0.1, kSeamMean = 0.01; ///< of the range of heights
constexpr double kClearly = 0.25;                   ///< of what was before
constexpr double kMostOutside = 0.2;                ///< of painted texels: margins around islands

double rangeOf(const HeightMap& map) { return std::abs(map.scale) * (double(map.highest) - map.lowest); }

bool disagree(const SeamReport& seams, const HeightMap& map) {
    const double range = rangeOf(map);
    return range > 0 && (seams.max > kSeamMost * range || seams.mean > kSeamMean * range);
}

} // namespace

std::string describeSpot(const MapCase& map, const SurfaceLocation& at) {
    const dvec2 st = map.subject.reference->texture(int(at.face), dvec2(at.uv)).st;
    return fmt::format("face {} of the cage at (s,t) = ({:.4g}, {:.4g})", map.subject.surface->faces[at.face].cageFace,
                       st.x, st.y);
}

void examineFlips(const MapCase& map, const SeamReport& seams, std::span<const std::uint32_t> coverage,
                  Findings& findings) {
    if (!map.subject.layout->hasTexCoords) return; // faces take the whole map: there is nothing to flip
    const bool hasSeamFault = disagree(seams, map.map);
    const std::optional<float> background = findBackground(map.sorted);
    const double outside = background ? shareOutside(map.map, coverage, *background) : 0;
    if (!hasSeamFault && outside <= kMostOutside) return;

    // The flip that makes the sides of seams agree best, or that takes what is painted into the islands.
    const Flip* best = nullptr;
    double least = kClearly;
    std::string because;
    for (const Flip& flip : kFlips) {
        if (flip.exchanges && !hasSquareTiles(map.map)) continue;
        const HeightMap heights = flipped(map.map, flip);
        const double share = background ? shareOutside(heights, coverage, *background) : 0;
        double ratio = outside > kMostOutside ? share / outside : 1;
        std::string reason = fmt::format("{:.0f} instead of {:.0f} % of what is painted lies outside of all islands",
                                         100 * share, 100 * outside);
        if (hasSeamFault) {
            const SeamReport then = reportSeams(*map.subject.surface, *map.subject.reference, heights);
            if (then.mean / seams.mean < ratio) {
                ratio = then.mean / seams.mean;
                reason = fmt::format("the sides of seams differ by {:.3g} instead of {:.3g} cage units",
                                     map.cageUnits(then.mean), map.cageUnits(seams.mean));
            }
        }
        if (ratio < least) least = ratio, best = &flip, because = reason;
    }
    if (best == nullptr) return;
    findings.push_back(
        {.kind = FindingKind::flip,
         .text = fmt::format("the map is {} against the texture coordinates: flipped back, {}", best->name, because),
         .advice = "flip the picture, or the texture coordinates where the cage was exported",
         .figure = least});
}

void examineSeams(const MapCase& map, const SeamReport& seams, Findings& findings) {
    const auto isFlip = [](const Finding& finding) { return finding.kind == FindingKind::flip; };
    if (!disagree(seams, map.map) || std::ranges::any_of(findings, isFlip)) return;
    const double range = rangeOf(map.map);
    const auto worst = std::ranges::max_element(seams.edges, {}, &SeamEdge::max);
    const auto count = std::ranges::count_if(seams.edges, [&](const SeamEdge& e) { return e.max > kSeamMost * range; });
    findings.push_back(
        {.kind = FindingKind::seam,
         .text = fmt::format("the two sides of seams differ by up to {:.3g} cage units, {:.0f} % of the heights' range "
                             "(mean {:.3g}), on {} of {} edges by more than {:.0f} %; worst at edge {}, {}",
                             map.cageUnits(seams.max), 100 * seams.max / range, map.cageUnits(seams.mean), count,
                             seams.seamEdgeCount, 100 * kSeamMost, worst->edge, describeSpot(map, worst->worst)),
         .advice = "bake with a margin of several texels around islands, and with the same heights on both sides",
         .figure = map.cageUnits(seams.max),
         .at = seams.worst});
}

// --- islands --------------------------------------------------------------------------------------------------------

std::vector<vec2> computeIslandRanges(const SurfaceLayout& layout, const HeightMap& map,
                                      std::span<const std::uint32_t> coverage) {
    std::vector<vec2> ranges(layout.islandFaces.size(), vec2(INFINITY, -INFINITY));
    const auto add = [&](std::uint32_t island, float value) {
        vec2& range = ranges[island];
        range = {std::min(range.x, value), std::max(range.y, value)};
    };
    const std::vector<float> values = valuesOf(map);
    for (std::size_t i = 0; i < coverage.size(); ++i)
        if (coverage[i] != kNoIsland) add(coverage[i], values[i]);
    // Islands smaller than a texel, and those that others lie over.
    for (const LayoutCell& cell : layout.cells)
        if (map.scale != 0) add(cell.island, float(sampleHeight(map, placeOf(cell)).h / map.scale + map.mid));
    return ranges;
}

bool isEmptyIsland(const vec2& range, const HeightMap& map) {
    const double whole = double(map.highest) - map.lowest;
    return whole > 0 && double(range.y) - range.x <= 1e-4 * whole;
}

void examineIslands(const MapCase& map, std::span<const vec2> ranges, Findings& findings) {
    const SurfaceLayout& layout = *map.subject.layout;
    if (!layout.hasTexCoords || layout.islandFaces.size() < 2) return;
    const LayoutCell* first = nullptr;
    std::size_t islands = 0, faces = 0;
    bool isMoved = false;
    std::vector<bool> isSeen(ranges.size(), false);
    // Each island once, at the first cell of it.
    for (const LayoutCell& cell : layout.cells) {
        if (isSeen[cell.island] || !isEmptyIsland(ranges[cell.island], map.map)) continue;
        isSeen[cell.island] = true;
        ++islands, faces += layout.islandFaces[cell.island];
        if (first == nullptr) first = &cell;
        isMoved =
            isMoved || std::abs(map.heightOf(ranges[cell.island].x)) > 0.01 * map.cageUnits(map.map.heightBound());
    }
    if (first == nullptr) return;
    // A part without details at the midlevel may be meant; one that is moved as a whole is not.
    const double value = double(ranges[first->island].x);
    findings.push_back(
        {.kind = FindingKind::island,
         .isFault = isMoved,
         .text = fmt::format("{} of {} islands hold one value, {} faces in all; the first, at {}, holds {:.4g}, "
                             "a height of {:.3g} cage units",
                             islands, ranges.size(), faces, describeSpot(map, first->at), value, map.heightOf(value)),
         .advice = isMoved ? "paint or bake them, or fill them with the midlevel"
                           : "nothing, if these parts are meant to stay smooth",
         .figure = double(islands),
         .at = first->at});
}

// --- stretched texels -----------------------------------------------------------------------------------------------

dvec2 texelExtents(const LayoutCell& cell, const HeightMap& map) {
    // Singular values of the map from texels to the surface, by the eigenvalues of its Gram matrix.
    const MapTile* tile = map.addressing == Addressing::tiles ? findTile(map.tiles, cell.st) : nullptr;
    const dvec2 size = tile != nullptr ? dvec2(tile->size) : dvec2(map.width, map.height);
    const dvec3 x = cell.tangents[0] / size.x, y = cell.tangents[1] / size.y;
    const double a = glm::dot(x, x), b = glm::dot(x, y), c = glm::dot(y, y);
    if (!std::isfinite(a + c)) return dvec2(INFINITY, 0);
    const double mean = 0.5 * (a + c), spread = std::sqrt(0.25 * (a - c) * (a - c) + b * b);
    return {std::sqrt(mean + spread), std::sqrt(std::max(mean - spread, 0.0))};
}

bool StretchLimit::isExceededBy(const dvec2& extents) const { return extents.x > longest; }

StretchLimit computeStretchLimit(const SurfaceLayout& layout, const HeightMap& map) {
    if (map.addressing == Addressing::faces) return {}; // nodes follow the faces
    constexpr double kMost = 6;                         // times the usual length
    std::vector<std::pair<double, double>> lengths;     // and area
    double area = 0;
    for (const LayoutCell& cell : layout.cells)
        lengths.emplace_back(texelExtents(cell, map).x, cell.area), area += cell.area;
    std::ranges::sort(lengths);
    double sum = 0;
    for (const auto& [length, share] : lengths)
        if ((sum += share) >= 0.5 * area) return {kMost * length};
    return {};
}

void examineStretch(const MapCase& map, Findings& findings) {
    constexpr double kNoticeable = 0.005; // of the area
    const SurfaceLayout& layout = *map.subject.layout;
    const StretchLimit limit = computeStretchLimit(layout, map.map);
    double area = 0, stretched = 0;
    dvec2 worst(0);
    const LayoutCell* at = nullptr;
    // The share of the area whose texels are too long, and the longest of them.
    for (const LayoutCell& cell : layout.cells) {
        const dvec2 extents = texelExtents(cell, map.map);
        area += cell.area;
        if (!limit.isExceededBy(extents)) continue;
        stretched += cell.area;
        if (at == nullptr || extents.x > worst.x) worst = extents, at = &cell;
    }
    if (at == nullptr || stretched <= kNoticeable * area) return;
    findings.push_back(
        {.kind = FindingKind::stretch,
         .text = fmt::format(
             "on {:.1f} % of the surface texels are more than 6 times as long as usual; worst at {}, where one "
             "is {:.3g} by {:.3g} cage units",
             100 * stretched / area, describeSpot(map, at->at), map.cageUnits(worst.x), map.cageUnits(worst.y)),
         .advice = "give these faces more of the layout: unwrap them again",
         .figure = stretched / area,
         .at = at->at});
}

// --- folds --------------------------------------------------------------------------------------------------------

double foldFactorOf(const LayoutCell& cell, const HeightMap& map, const ReferenceSurface& reference) {
    if (map.vectors) {
        const double turned = computeFoldFactor(displacedFrame(reference, &map, int(cell.at.face), dvec2(cell.at.uv)));
        return std::isfinite(turned) ? turned : 1;
    }
    if (!cell.curvature) return 1;
    const double h = sampleHeight(map, placeOf(cell)).h;
    const double factor = 1 + std::min(h * cell.curvature->lowest, h * cell.curvature->highest);
    return std::isfinite(factor) ? factor : 1;
}

void examineFolds(const MapCase& map, Findings& findings) {
    const SurfaceLayout& layout = *map.subject.layout;
    double area = 0, folded = 0, lowest = 1;
    const LayoutCell* at = nullptr;
    for (const LayoutCell& cell : layout.cells) {
        const double factor = foldFactorOf(cell, map.map, *map.subject.reference);
        area += cell.area;
        if (factor <= 0) folded += cell.area;
        if (factor < lowest) lowest = factor, at = &cell;
    }
    if (lowest > 0) return;
    // 1 + h kappa is linear in the scale: 0 where the scale is 1 / (1 - lowest) of this one.
    const double scale = 0.9 * map.cageUnits(map.map.scale) / (1 - lowest);
    findings.push_back(
        {.kind = FindingKind::fold,
         .text = fmt::format(
             "heights fold {:.2f} % of the surface over itself: 1 + h k is down to {:.3g} at {}, where h = {:.3g} "
             "cage units",
             100 * folded / area, lowest, describeSpot(map, at->at),
             map.cageUnits(sampleHeight(map.map, placeOf(*at)).h)),
         .advice = fmt::format(
             "--scale {:.3g} folds nothing; or lower the heights there, or model the form in the cage", scale),
         .figure = lowest,
         .at = at->at});
}

} // namespace relief
