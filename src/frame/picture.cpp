#include <algorithm>
#include <cmath>

#include <glm/gtc/packing.hpp>

#include "frame/frame.h"

namespace relief {
namespace {

/// Fit of the ACES tone curve by Narkowicz ("ACES filmic tone mapping curve", 2015), on each channel.
float toneMapped(float x) {
    const float y = 0.8f * x;
    return std::clamp(y * (2.51f * y + 0.03f) / (y * (2.43f * y + 0.59f) + 0.14f), 0.0f, 1.0f);
}

float srgbOf(float linear) {
    return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

/// A calm gradient, lighter behind the object: sRGB 0..1.
vec3 studioBackground(double x, double y, double aspect) {
    const double dx = (x - 0.5) * aspect, dy = y - 0.56;
    const double glow = std::exp(-2.2 * (dx * dx + dy * dy));
    const double fade = glm::mix(0.86, 0.70, y);
    return vec3(glm::mix(dvec3(0.80, 0.815, 0.83) * fade, dvec3(0.93, 0.935, 0.94), 0.85 * glow));
}

} // namespace

Image Picture::image() const {
    Image image{width, height, 4, std::vector<float>(halves.size())};
    std::transform(halves.begin(), halves.end(), image.texels.begin(), glm::unpackHalf1x16);
    return image;
}

namespace {

/// Channels of a layer, as they are called in a file and where they lie in Picture::layerValues.
struct LayerChannels {
    std::vector<const char*> names;
    std::uint32_t first;
};

LayerChannels channelsOf(Layer layer) {
    switch (layer) {
    case Layer::depth: return {{"Z"}, kLayerDepth};
    case Layer::normal: return {{"N.X", "N.Y", "N.Z"}, kLayerNormal};
    case Layer::face: return {{"face.ID"}, kLayerFace};
    case Layer::uv: return {{"uv.U", "uv.V"}, kLayerTexCoords};
    case Layer::height: return {{"height.H"}, kLayerHeight};
    case Layer::motion: return {{"motion.X", "motion.Y"}, kLayerMotion};
    }
    fail(Failure::internal, "layer {} does not exist", int(layer));
}

void writeLayers(const std::string& path, const Picture& picture) {
    const Image light = picture.image();
    std::vector<ImageChannel> channels;
    for (const char* name : {"R", "G", "B", "A"}) channels.push_back({name, SampleType::half});
    std::vector<std::uint32_t> sources; ///< of each channel of the layers
    for (const Layer layer : picture.layers) {
        const LayerChannels own = channelsOf(layer);
        for (std::uint32_t i = 0; i < own.names.size(); ++i) {
            channels.push_back({own.names[i], SampleType::real});
            sources.push_back(own.first + i);
        }
    }
    Image all{picture.width, picture.height, int(channels.size()), {}};
    all.texels.reserve(light.texels.size() / 4 * channels.size());
    for (std::size_t pixel = 0; pixel < light.texels.size() / 4; ++pixel) {
        all.texels.insert(all.texels.end(), &light.texels[4 * pixel], &light.texels[4 * pixel] + 4);
        for (const std::uint32_t source : sources)
            all.texels.push_back(picture.layerValues[kLayerChannels * pixel + source]);
    }
    writeImage(path, all, channels);
}

} // namespace

Image displayed(const Picture& picture, const Finish& finish) {
    const Image from = picture.image();
    const bool isOpaque = finish.background != Background::transparent;
    Image to{from.width, from.height, isOpaque ? 3 : 4, {}};
    to.texels.resize(std::size_t(to.width) * to.height * to.channels);
    const double aspect = double(from.width) / from.height;
    const auto gain = float(std::exp2(finish.exposure)); // 1 keeps every bit
    for (int y = 0; y < to.height; ++y)
        for (int x = 0; x < to.width; ++x) {
            // The curve is for the object's own color: alpha is divided out.
            const float* in = from.at(x, y);
            float* out = to.at(x, y);
            const float alpha = std::clamp(in[3], 0.0f, 1.0f);
            vec3 color(0);
            for (int c = 0; alpha > 0 && c < 3; ++c) {
                const float value = in[c] / alpha;
                color[c] = picture.isDisplayReferred ? std::clamp(value, 0.0f, 1.0f) : srgbOf(toneMapped(gain * value));
            }
            // Over the background in display values, as programs that show pictures compose them.
            if (isOpaque) {
                const vec3 behind = finish.background == Background::color
                                        ? finish.color
                                        : studioBackground((x + 0.5) / to.width, (y + 0.5) / to.height, aspect);
                color = glm::mix(behind, color, alpha);
                // Gradients of 8 bits show their steps: interleaved gradient noise hides them (Jimenez, "Next
                // Generation Post Processing in Call of Duty: Advanced Warfare", 2014).
                const auto noise =
                    float(std::fmod(52.9829189 * std::fmod(0.06711056 * x + 0.00583715 * y, 1.0), 1.0) - 0.5);
                if (alpha == 0 && finish.background == Background::studio) color += noise / 255.0f;
            } else {
                out[3] = alpha;
            }
            for (int c = 0; c < 3; ++c) out[c] = color[c];
        }
    return to;
}

void writePicture(const std::string& path, const Picture& picture, const Finish& finish) {
    if (path.ends_with(".exr") && !picture.layers.empty())
        writeLayers(path, picture);
    else if (path.ends_with(".exr"))
        writeImage(path, picture.image(), SampleType::half);
    else if (path.ends_with(".png"))
        writeImage(path, displayed(picture, finish), SampleType::uint8);
    else
        fail(Failure::usage, "{}: pictures are written as .png or .exr", path);
}

} // namespace relief
