#include "displacement/displacement.h"

#include <algorithm>
#include <cmath>

namespace relief {

namespace {

/// The index of a texel that exists, for one that may lie outside.
std::size_t wrapped(std::int64_t index, int size, Wrap wrap) {
    if (wrap == Wrap::clamp) return std::size_t(std::clamp<std::int64_t>(index, 0, size - 1));
    const std::int64_t rest = index % size;
    return std::size_t(rest < 0 ? rest + size : rest);
}

/// The same place on the map, near [0,1], so that texel numbers stay small however far away it was named.
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
    const auto [lowest, highest] = std::minmax_element(map.texels.begin(), map.texels.end());
    map.lowest = *lowest;
    map.highest = *highest;
    return map;
}

void warnAbout(const ImageInfo& info, const std::string& path, const HeightOptions& options, const Warn& warn) {
    if (info.sampleBytes == 1) warn(fmt::format("{}: 8-bit heights show as stairs; use 16 bits or float", path));
    if (!info.isFloat && !options.scale)
        warn(fmt::format(
            "{}: integer heights have no unit and no scale is given; 1 is used, the map spans one cage unit", path));
}

} // namespace

MapFormat fileFormat(const ImageInfo& info) {
    if (info.sample == "half") return MapFormat::half;
    if (info.sample == "uint16") return MapFormat::unorm16;
    if (info.sample == "uint8") return MapFormat::unorm8;
    return MapFormat::real;
}

double HeightMap::reach() const { return std::abs(scale) * std::max(std::abs(lowest - mid), std::abs(highest - mid)); }

HeightMap loadHeightMap(const std::string& path, const HeightOptions& options, const Warn& warn) {
    const ImageInfo info = readImageInfo(path, options.limits);
    if (options.channel < 0 || options.channel >= info.channels)
        fail(Failure::input, "{}: there is no channel {}; channels 0 to {} exist", path, options.channel,
             info.channels - 1);
    warnAbout(info, path, options, warn);
    Image image = readImage(path, options.channel, options.limits);
    HeightMap map = finishMap({.width = image.width,
                               .height = image.height,
                               .texels = std::move(image.texels),
                               .mid = options.mid.value_or(info.isFloat ? 0.0 : 0.5),
                               .scale = options.scale.value_or(1.0),
                               .wrap = options.wrap},
                              path);
    if (options.format) return inFormat(map, *options.format);
    map.format = fileFormat(info);
    return map;
}

HeightMap makeHeightMap(int width, int height, std::vector<float> texels, double mid, double scale, Wrap wrap) {
    if (width < 1 || height < 1 || texels.size() != std::size_t(width) * height)
        fail(Failure::input, "a height map of {} x {} cannot have {} texels", width, height, texels.size());
    return finishMap(
        {.width = width, .height = height, .texels = std::move(texels), .mid = mid, .scale = scale, .wrap = wrap},
        "height map");
}

HeightSample sampleHeight(const HeightMap& map, const dvec2& st) {
    const double ds = 1.0 / map.width, dt = 1.0 / map.height;
    return {.h = heightAt(map, st.x, st.y),
            .hs = (heightAt(map, st.x + ds, st.y) - heightAt(map, st.x - ds, st.y)) / (2 * ds),
            .ht = (heightAt(map, st.x, st.y + dt) - heightAt(map, st.x, st.y - dt)) / (2 * dt)};
}

} // namespace relief
