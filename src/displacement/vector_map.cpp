#include "displacement/vector_parts.h"

#include <algorithm>
#include <cmath>

#include "displacement/voids.h"

namespace relief {
namespace {

constexpr std::string_view kAxes = "xyz";

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
    HeightMap result = map.channels[0];
    for (std::size_t i = 0; i < result.texels.size(); ++i) {
        double square = 0;
        for (const HeightMap& channel : map.channels)
            square += std::pow(channel.scale * (double(channel.texels[i]) - channel.mid), 2);
        result.texels[i] = float(std::sqrt(square));
    }
    result.mid = 0, result.scale = 1;
    findRange(result);
    return result;
}

} // namespace

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

void applyPreset(VectorOptions& options, VectorPreset preset) {
    const bool isTangent = options.space == VectorSpace::tangent;
    if (preset == VectorPreset::mudbox && isTangent) options.order = "xzy";
    if (preset == VectorPreset::blender) options.order = "xzy", options.flip = isTangent ? "" : "z";
}

std::array<HeightMap, 3> takeComponents(const Image& image, std::size_t firstChannel, const VectorOptions& options) {
    std::array<HeightMap, 3> components;
    for (std::size_t k = 0; k < 3; ++k) {
        const double sign = options.flip.find(options.order[k]) != std::string::npos ? -1 : 1;
        components[kAxes.find(options.order[k])] =
            makeHeightMap(image.width, image.height, channelOf(image, firstChannel + k), options.mid.value_or(0),
                          sign * options.scale.value_or(1), options.wrap);
    }
    return components;
}

HeightMap makeVectorMap(const Image& components, const VectorOptions& options) {
    if (components.channels < 3)
        fail(Failure::input, "a vector map has 3 channels, this picture has {}", components.channels);
    checkAxes(options);
    return joinComponents(takeComponents(components, 0, options), options.space,
                          options.format.value_or(MapFormat::real));
}

HeightMap joinComponents(const std::array<HeightMap, 3>& components, VectorSpace space, MapFormat format) {
    auto map = std::make_shared<VectorMap>();
    map->space = space;
    for (std::size_t k = 0; k < 3; ++k) {
        RELIEF_CHECK(components[k].texels.size() == components[0].texels.size());
        EncodedMap encoded = encode(components[k], format);
        map->channels[k] = std::move(encoded.decoded);
        map->encodings[k] = std::move(encoded.encoding);
    }
    HeightMap result = lengthsOf(*map);
    result.vectors = std::move(map);
    return result;
}

void scaleHeights(HeightMap& map, double factor) {
    if (factor == 1) return;
    map.scale *= factor;
    if (!map.vectors) return;
    auto scaled = std::make_shared<VectorMap>(*map.vectors);
    for (HeightMap& channel : scaled->channels) channel.scale *= factor;
    map.vectors = std::move(scaled);
}

VectorSample sampleVectors(const VectorMap& map, const MapPlace& place) {
    VectorSample sample;
    for (int k = 0; k < 3; ++k) {
        const HeightSample one = sampleHeight(map.channels[std::size_t(k)], place);
        sample.c[k] = one.h, sample.cs[k] = one.hs, sample.ct[k] = one.ht;
    }
    return sample;
}

VectorSample sampleVectors(const VectorMap& map, const dvec2& st) { return sampleVectors(map, MapPlace{.st = st}); }

} // namespace relief
