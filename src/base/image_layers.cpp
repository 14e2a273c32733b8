// Channels and layers of picture files by name; texels that are no numbers.
#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/base.h"

namespace relief {
namespace {

/// What stands before the last dot of a channel's name.
std::string_view layerOf(std::string_view channel) {
    const std::size_t dot = channel.rfind('.');
    return dot == std::string_view::npos ? std::string_view() : channel.substr(0, dot);
}

/// How `word` may name a channel of the part: by its whole name, or by its layer's.
bool isNamed(const ImagePart& part, const std::string& channel, std::string_view word, bool byLayer) {
    const std::string full = part.name + "." + channel;
    if (!byLayer) return channel == word || full == word;
    return !word.empty() && (layerOf(channel) == word || layerOf(full) == word);
}

} // namespace

std::optional<ChannelIndex> findChannel(const ImageInfo& info, std::string_view word) {
    for (const bool byLayer : {false, true})
        for (std::size_t p = 0; p < info.parts.size(); ++p) {
            const std::vector<std::string>& names = info.parts[p].channelNames;
            for (std::size_t c = 0; c < names.size(); ++c)
                if (isNamed(info.parts[p], names[c], word, byLayer)) return ChannelIndex{int(p), int(c)};
        }
    int number = -1;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    const bool isNumber = error == std::errc() && end == word.data() + word.size();
    if (!isNumber || number < 0) return {};
    for (std::size_t p = 0; p < info.parts.size(); ++p) { // numbers count through all parts
        const int count = int(info.parts[p].channelNames.size());
        if (number < count) return ChannelIndex{int(p), number};
        number -= count;
    }
    return {};
}

std::vector<std::string> layersOf(const ImageInfo& info) {
    std::vector<std::string> layers;
    for (const ImagePart& part : info.parts)
        for (const std::string& channel : part.channelNames) {
            const std::string_view layer = layerOf(channel);
            // A part of an EXR is a layer of its own, by the name that its channels may bear too.
            std::string name = layer.empty() && info.parts.size() > 1 ? part.name : std::string(layer);
            if (std::ranges::find(layers, name) == layers.end()) layers.push_back(std::move(name));
        }
    return layers;
}

std::optional<BadTexel> findNotFinite(const Image& image) {
    const auto bad = std::ranges::find_if(image.texels, [](float texel) { return !std::isfinite(texel); });
    if (bad == image.texels.end()) return {};
    const auto index = std::size_t(bad - image.texels.begin()), texel = index / std::size_t(image.channels);
    return BadTexel{int(texel % std::size_t(image.width)), int(texel / std::size_t(image.width)),
                    int(index % std::size_t(image.channels)), *bad};
}

} // namespace relief
