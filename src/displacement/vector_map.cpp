#include "displacement/vector_map.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

constexpr std::string_view kAxes = "xyz";

void checkAxes(const VectorOptions& options) {
    std::string sorted = options.order;
    std::ranges::sort(sorted);
    if (sorted != kAxes)
        fail(Failure::usage, "the order of a vector map's channels is x, y and z once each, such as xzy, not '{}'",
             options.order);
    for (const char axis : options.flip)
        if (kAxes.find(axis) == std::string_view::npos)
            fail(Failure::usage, "the axes of a vector map that are flipped are some of x, y and z, not '{}'",
                 options.flip);
}

/// One channel of an image.
std::vector<float> channelOf(const Image& image, std::size_t channel) {
    std::vector<float> texels;
    texels.reserve(std::size_t(image.width) * std::size_t(image.height));
    for (std::size_t i = channel; i < image.texels.size(); i += std::size_t(image.channels))
        texels.push_back(image.texels[i]);
    return texels;
}

/// The lengths of the vectors that a device decodes, in cage units.
HeightMap lengthsOf(const VectorMap& map) {
    const HeightMap& first = map.channels[0];
    std::vector<float> lengths(first.texels.size());
    for (std::size_t i = 0; i < lengths.size(); ++i) {
        double square = 0;
        for (const HeightMap& channel : map.channels)
            square += std::pow(channel.scale * (double(channel.texels[i]) - channel.mid), 2);
        lengths[i] = float(std::sqrt(square));
    }
    return makeHeightMap(first.width, first.height, std::move(lengths), 0, 1, first.wrap);
}

HeightMap assemble(const Image& image, std::size_t firstChannel, const VectorOptions& options, MapFormat format) {
    checkAxes(options);
    auto map = std::make_shared<VectorMap>();
    map->space = options.space;
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t axis = kAxes.find(options.order[k]);
        const double sign = options.flip.find(options.order[k]) != std::string::npos ? -1 : 1;
        EncodedMap encoded =
            encode(makeHeightMap(image.width, image.height, channelOf(image, firstChannel + k), options.mid.value_or(0),
                                 sign * options.scale.value_or(1), options.wrap),
                   format);
        map->channels[axis] = std::move(encoded.decoded);
        map->encodings[axis] = std::move(encoded.encoding);
    }
    HeightMap result = lengthsOf(*map);
    result.vectors = std::move(map);
    return result;
}

void warnAboutFile(const ImageInfo& info, const std::string& path, const VectorOptions& options, const Warn& warn) {
    if (info.sampleBytes == 1) warn(fmt::format("{}: 8-bit vectors show as stairs; use 16 bits or float", path));
    if (!info.hasUnit() && !options.scale)
        warn(
            fmt::format("{}: integer vectors have no unit and no scale is given; 1 is used: components are -0.5 to 0.5 "
                        "cage units",
                        path));
}

} // namespace

void applyPreset(VectorOptions& options, VectorPreset preset) {
    const bool isTangent = options.space == VectorSpace::tangent;
    if (preset == VectorPreset::mudbox && isTangent) options.order = "xzy";
    if (preset == VectorPreset::blender) options.order = "xzy", options.flip = isTangent ? "" : "z";
}

HeightMap makeVectorMap(const Image& components, const VectorOptions& options) {
    if (components.channels < 3)
        fail(Failure::input, "a vector map has 3 channels, this picture has {}", components.channels);
    return assemble(components, 0, options, options.format.value_or(MapFormat::real));
}

HeightMap loadVectorMap(const std::string& path, const VectorOptions& options, const Warn& warn) {
    checkAxes(options);
    const ImageInfo info = readImageInfo(path, options.limits);

    // Which three channels.
    ChannelIndex index;
    if (!options.channel.empty()) {
        const std::optional<ChannelIndex> found = findChannel(info, options.channel);
        if (!found) fail(Failure::input, "{}: there is no channel {}", path, options.channel);
        index = *found;
    }
    const std::size_t part = std::size_t(index.part);
    const std::size_t count =
        part < info.parts.size() ? info.parts[part].channelNames.size() : std::size_t(info.channels);
    if (std::size_t(index.channel) + 3 > count)
        fail(Failure::input, "{}: a vector map has 3 channels (x, y and z), this picture has {}{}", path,
             count - std::size_t(index.channel), index.channel > 0 ? " from that channel on" : "");
    warnAboutFile(info, path, options, warn);

    const Image image = readImage(path, -1, options.limits, index.part);
    if (const std::optional<BadTexel> bad = findNotFinite(image))
        fail(Failure::input, "{}: channel {} of the texel in column {}, row {} (from 0, top left) is {}", path,
             bad->channel, bad->x, bad->y, bad->value);
    VectorOptions own = options;
    own.mid = options.mid.value_or(info.hasUnit() ? 0.0 : 0.5);
    return assemble(image, std::size_t(index.channel), own, options.format.value_or(fileFormat(info)));
}

void scaleHeights(HeightMap& map, double factor) {
    if (factor == 1) return;
    map.scale *= factor;
    if (!map.vectors) return;
    auto scaled = std::make_shared<VectorMap>(*map.vectors);
    for (HeightMap& channel : scaled->channels) channel.scale *= factor;
    map.vectors = std::move(scaled);
}

VectorSample sampleVectors(const VectorMap& map, const dvec2& st) {
    VectorSample sample;
    for (int k = 0; k < 3; ++k) {
        const HeightSample one = sampleHeight(map.channels[std::size_t(k)], st);
        sample.c[k] = one.h, sample.cs[k] = one.hs, sample.ct[k] = one.ht;
    }
    return sample;
}

} // namespace relief
