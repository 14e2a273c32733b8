// Maps that the command line names: heights, colors, light.
#include <algorithm>

#include "app/options.h"

namespace relief::app {
namespace {

/// Nothing for auto.
std::optional<MapFormat> mapFormatOf(const std::string& word) {
    for (const Word<MapFormat>& row : kMapFormats)
        if (word == row.word) return row.value;
    return {};
}

/// The box of the texture coordinates that corners use.
std::pair<vec2, vec2> texCoordRange(const Cage& cage) {
    vec2 lower(INFINITY), upper(-INFINITY);
    for (const std::uint32_t corner : cage.texCorners) {
        lower = glm::min(lower, cage.texCoords[corner]);
        upper = glm::max(upper, cage.texCoords[corner]);
    }
    return {lower, upper};
}

Image loadAlbedo(const std::string& path, const Warn& warn) {
    const ImageInfo info = readImageInfo(path);
    if (info.channels < 3)
        fail(Failure::input, "{}: an albedo map has 3 channels, this one has {}", path, info.channels);
    const std::vector<std::string> layers = layersOf(info);
    if (layers.size() > 1)
        warn(fmt::format("{}: there are {} layers; the colors are channels {}, {} and {}, the first ones", path,
                         layers.size(), info.channelNames[0], info.channelNames[1], info.channelNames[2]));
    Image image = readImage(path);
    if (const std::optional<BadTexel> bad = findNotFinite(image))
        fail(Failure::input,
             "{}: channel {} of the texel in column {}, row {} (from 0, top left) is {}; colors are finite numbers",
             path, info.channelNames[std::size_t(bad->channel)], bad->x, bad->y, bad->value);
    const auto clamped = std::ranges::count_if(image.texels, [](float value) { return value < 0 || value > 1; });
    if (clamped > 0)
        warn(fmt::format("{}: {} of {} values are no share of light in 0..1; they are clamped to it", path, clamped,
                         image.texels.size()));
    return image;
}

} // namespace

void warnOutsideMap(const SurfaceArgs& args, const Cage& cage, const std::string& map, const Warn& warn) {
    constexpr float kRounding = 1e-4f; // of programs that write texture coordinates with a few digits
    if (!args.wrap.empty() || !cage.hasTexCoords()) return;
    const auto [lower, upper] = texCoordRange(cage);
    const bool isInside =
        lower.x >= -kRounding && lower.y >= -kRounding && upper.x <= 1 + kRounding && upper.y <= 1 + kRounding;
    if (isInside) return;
    warn(fmt::format("{}: texture coordinates go from ({:.4g}, {:.4g}) to ({:.4g}, {:.4g}), outside of 0..1, where {} "
                     "repeats (sets of UDIM tiles are not read); --wrap repeat or clamp says what is meant",
                     args.cage, lower.x, lower.y, upper.x, upper.y, map));
}

std::optional<EncodedMap> loadHeights(const SurfaceArgs& args, const Cage& cage, const Warn& warn) {
    if (args.height.empty()) return {};
    EncodedMap map = loadHeightMap(args.height,
                                   {.mid = args.mid,
                                    .scale = args.scale,
                                    .channel = args.channel,
                                    .wrap = args.wrap == "clamp" ? Wrap::clamp : Wrap::repeat,
                                    .format = mapFormatOf(args.mapFormat),
                                    .limits = {}},
                                   warn);
    if (!cage.hasTexCoords())
        warn(fmt::format("{}: no texture coordinates: every face takes the whole map", args.cage));
    warnOutsideMap(args, cage, args.height, warn);
    return map;
}

Shading loadShading(const PictureArgs& args, const SurfaceArgs& surface, const Cage& cage, const Warn& warn) {
    Shading shading;
    if (!args.albedo.empty()) {
        shading.albedo = loadAlbedo(args.albedo, warn);
        if (surface.height.empty()) warnOutsideMap(surface, cage, args.albedo, warn); // else that map has been named
    }
    if (!args.environment.empty()) shading.environment = loadEnvironment(args.environment);
    return shading;
}

} // namespace relief::app
