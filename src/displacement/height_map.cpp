#include "displacement/tile_set.h"
#include "displacement/voids.h"

#include <algorithm>
#include <cmath>

namespace relief {

namespace {

/// Wraps the index of a texel into the map.
std::size_t wrapped(std::int64_t index, int size, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::size_t(std::clamp<std::int64_t>(index, 0, size - 1));
    const std::int64_t rest = index % size;
    return std::size_t(rest < 0 ? rest + size : rest);
}

/// Moves a texture coordinate to the same texel near [0,1], so that texel numbers stay small.
double nearUnit(double x, Wrap wrap) { return wrap == Wrap::repeat ? x - std::floor(x) : std::clamp(x, -1.0, 2.0); }

/// Bilinear between texel centres, which lie at ((i + 1/2) / width, 1 - (j + 1/2) / height).
double heightAt(const HeightMap& map, double s, double t) {
    const double x = nearUnit(s, map.wrap) * map.width - 0.5;
    const double y = (1 - nearUnit(t, map.wrap)) * map.height - 0.5;
    const double i = std::floor(x), j = std::floor(y);
    const auto texel = [&](double column, double row) {
        const std::size_t c = wrapped(std::int64_t(column), map.width, map.wrap);
        return double(map.texels[wrapped(std::int64_t(row), map.height, map.wrap) * map.width + c]);
    };
    const double upper = std::lerp(texel(i, j), texel(i + 1, j), x - i);
    const double lower = std::lerp(texel(i, j + 1), texel(i + 1, j + 1), x - i);
    return map.scale * (std::lerp(upper, lower, y - j) - map.mid);
}

void checkFinite(const HeightMap& map, const std::string& name) {
    const auto isBad = [](float texel) { return !std::isfinite(texel); };
    const auto bad = std::find_if(map.texels.begin(), map.texels.end(), isBad);
    if (bad == map.texels.end()) return;
    const auto index = bad - map.texels.begin();
    fail(Failure::input,
         "{}: the texel in column {}, row {} (from 0, top left) is {}; fill the map's gaps with numbers", name,
         index % map.width, index / map.width, *bad);
}

HeightMap finishMap(HeightMap map, const std::string& name) {
    if (!std::isfinite(map.mid)) fail(Failure::usage, "{}: the height map's mid is {}; give a number", name, map.mid);
    if (!std::isfinite(map.scale))
        fail(Failure::usage, "{}: the height map's scale is {}; give a number", name, map.scale);
    checkFinite(map, name);
    findRange(map);
    return map;
}

/// Names with commas between them, and how many more there are.
std::string listOf(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 8;
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i)
        list += fmt::format("{}{}", i == 0 ? "" : ", ", names[i].empty() ? "one without a name" : names[i]);
    return names.size() > kMost ? fmt::format("{} and {} more", list, names.size() - kMost) : list;
}

/// Voids become heights; throws where there is nothing to make them from.
void repairVoids(HeightMap& map, const MapEncoding& encoding, const ImageInfo& info, const std::string& path,
                 const Warn& warn) {
    HeightCensus census(info);
    for (const float texel : map.texels) census.add(texel);
    census.finish();
    const std::uint64_t count = census.voidCount();
    if (count == 0) return;
    if (count == map.texels.size())
        fail(Failure::input, "{}: all {} texels are voids ({}); there is no height in it", path, count,
             census.voidReason());
    if (census.notFiniteCount() > 0) return; // refused, with its texel
    warn(fmt::format("{}: {} of {} texels are voids ({}); they are filled from the heights around them", path, count,
                     map.texels.size(), census.voidReason()));
    std::vector<bool> isVoid(map.texels.size());
    for (std::size_t i = 0; i < isVoid.size(); ++i) isVoid[i] = census.isVoid(map.texels[i]);
    fillVoids(map.width, map.height, map.texels, isVoid);
    roundTo(encoding, map.texels);
}

} // namespace

void warnAbout(const ImageInfo& info, const std::string& path, const HeightOptions& options, const Warn& warn) {
    if (info.sampleBytes == 1) warn(fmt::format("{}: 8-bit heights show as stairs; use 16 bits or float", path));
    if (!info.hasUnit() && !options.scale)
        warn(fmt::format(
            "{}: integer heights have no unit and no scale is given; 1 is used, the map spans one cage unit", path));
}

ChannelIndex chooseChannel(const ImageInfo& info, const std::string& path, const std::string& word, const Warn& warn) {
    if (word.empty()) {
        const std::vector<std::string> layers = layersOf(info);
        if (layers.size() > 1)
            warn(fmt::format("{}: there are {} layers ({}); channel {} is taken: choose with --channel NAME", path,
                             layers.size(), listOf(layers), info.channelNames.front()));
        return {};
    }
    if (const std::optional<ChannelIndex> index = findChannel(info, word)) return *index;
    std::vector<std::string> names;
    for (const ImagePart& part : info.parts)
        for (const std::string& name : part.channelNames)
            names.push_back(info.parts.size() > 1 ? part.name + "." + name : name);
    fail(Failure::input, "{}: there is no channel {}; channels 0 to {} exist: {}", path, word, names.size() - 1,
         listOf(names));
}

MapFormat fileFormat(const ImageInfo& info) {
    if (info.sample == "half") return MapFormat::half;
    if (info.sample == "uint16") return MapFormat::unorm16;
    if (info.sample == "uint8") return MapFormat::unorm8;
    return MapFormat::real;
}

double HeightMap::heightBound() const {
    return std::abs(scale) * std::max(std::abs(lowest - mid), std::abs(highest - mid));
}

HeightMap loadTexels(const std::string& path, const HeightOptions& options, const ImageInfo& info, const Warn& warn) {
    const ChannelIndex index = chooseChannel(info, path, options.channel, warn);
    Image image = readImage(path, index.channel, options.limits, index.part);
    HeightMap map{.width = image.width,
                  .height = image.height,
                  .texels = std::move(image.texels),
                  .mid = options.mid.value_or(info.hasUnit() ? 0.0 : 0.5),
                  .scale = options.scale.value_or(1.0),
                  .wrap = options.wrap};
    // Texels of integer files are 0..1 already: their own steps, over the range that an encoding has by default.
    repairVoids(map, {.format = fileFormat(info), .blocks = {}}, info, path, warn);
    return finishMap(std::move(map), path);
}

EncodedMap loadHeightMap(const std::string& path, const HeightOptions& options, const Warn& warn) {
    if (findTilePattern(path)) return loadTileSet(path, options, warn);
    const ImageInfo info = readImageInfo(path, options.limits);
    if (isFaceMap(info)) return loadFaceMap(path, options, info);
    warnAbout(info, path, options, warn);
    HeightMap map = loadTexels(path, options, info, warn);
    if (options.format) return encode(map, *options.format);
    return {std::move(map), {.format = fileFormat(info), .blocks = {}}};
}

HeightMap makeHeightMap(int width, int height, std::vector<float> texels, double mid, double scale, Wrap wrap) {
    if (width < 1 || height < 1 || texels.size() != std::size_t(width) * height)
        fail(Failure::input, "a height map of {} x {} cannot have {} texels", width, height, texels.size());
    return finishMap(
        {.width = width, .height = height, .texels = std::move(texels), .mid = mid, .scale = scale, .wrap = wrap},
        "height map");
}

HeightSample sampleHeight(const HeightMap& map, const dvec2& st) {
    RELIEF_CHECK(map.addressing != Addressing::faces);
    if (map.addressing == Addressing::tiles) return sampleHeight(map, MapPlace{.st = st});
    const double ds = 1.0 / map.width, dt = 1.0 / map.height;
    return {.h = heightAt(map, st.x, st.y),
            .hs = (heightAt(map, st.x + ds, st.y) - heightAt(map, st.x - ds, st.y)) / (2 * ds),
            .ht = (heightAt(map, st.x, st.y + dt) - heightAt(map, st.x, st.y - dt)) / (2 * dt)};
}

} // namespace relief
