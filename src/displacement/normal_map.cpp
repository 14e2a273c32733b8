#include "displacement/normal_map.h"

#include <algorithm>
#include <cmath>

namespace relief {

namespace {

/// Below this length 2c - 1 says nothing of a direction: grey of 8 bits is 0.007 long.
constexpr float kShortest = 0.1f;

bool isBlack(const vec3& code) { return code == vec3(0); }

/// Takes the numbers of a picture row after row, and makes normals of them once it has seen all.
class NormalReader {
public:
    NormalReader(int width, int height, std::string name, const NormalOptions& options)
        : options_(options), name_(std::move(name)) {
        map_.width = width;
        map_.height = height;
        map_.space = options.space;
        map_.wrap = options.wrap;
        map_.normals.reserve(std::size_t(width) * std::size_t(height));
    }

    /// Adds whole texels of `channels` numbers each; the first three are used.
    void add(std::span<const float> texels, int channels) {
        for (std::size_t i = 0; i + 2 < texels.size(); i += std::size_t(channels)) {
            const vec3 numbers(texels[i], texels[i + 1], texels[i + 2]);
            checkFinite(numbers);
            lowest_ = std::min({lowest_, numbers.x, numbers.y, numbers.z});
            map_.normals.push_back(numbers);
        }
    }

    NormalMap finish(const Warn& warn) {
        RELIEF_CHECK(map_.normals.size() == std::size_t(map_.width) * std::size_t(map_.height));
        for (std::size_t i = 0; i < map_.normals.size(); ++i) decode(i);
        report(warn);
        return std::move(map_);
    }

private:
    [[nodiscard]] bool areVectors() const { return lowest_ < 0; }

    void checkFinite(const vec3& numbers) const {
        for (int k = 0; k < 3; ++k)
            if (!std::isfinite(numbers[k]))
                fail(Failure::input,
                     "{}: channel {} of the texel in column {}, row {} (from 0, top left) is {}; normals are finite "
                     "numbers",
                     name_, k, map_.normals.size() % std::size_t(map_.width),
                     map_.normals.size() / std::size_t(map_.width), numbers[k]);
    }

    void decode(std::size_t i) {
        vec3& texel = map_.normals[i];
        vec3 n = areVectors() ? texel : 2.0f * texel - 1.0f;
        const bool isEmpty = isBlack(texel) || glm::length(n) < kShortest;
        if (isEmpty) {
            ++map_.emptyCount;
            texel = vec3(0, 0, 1);
            return;
        }
        if (options_.space == NormalSpace::tangent) {
            if (n.z <= 0 && map_.belowCount++ == 0) map_.firstBelow = i;
            n.x *= float(options_.scale);
            n.y *= float(options_.y == NormalY::up ? options_.scale : -options_.scale);
        }
        texel = glm::length(n) > 0 ? glm::normalize(n) : vec3(0, 0, 1);
    }

    void report(const Warn& warn) const {
        const std::size_t count = map_.normals.size();
        if (areVectors())
            warn(fmt::format("{}: some numbers are negative: they are taken for components from -1 to 1, not for codes "
                             "from 0 to 1",
                             name_));
        if (map_.emptyCount > 0)
            warn(fmt::format("{}: {} of {} texels hold no normal (black, or a vector without length); they are taken "
                             "as (0,0,1)",
                             name_, map_.emptyCount, count));
        if (map_.belowCount > 0)
            warn(fmt::format("{}: {} of {} normals point below the surface; a map in object space needs --normal-space "
                             "object",
                             name_, map_.belowCount, count));
    }

    NormalOptions options_;
    std::string name_;
    NormalMap map_;
    float lowest_ = 0;
};

void checkChannels(int channels, const std::string& name) {
    if (channels < 3)
        fail(Failure::input, "{}: a normal map has 3 channels (x, y and z), this picture has {}", name, channels);
}

void warnOfFile(const ImageInfo& info, const std::string& path, const Warn& warn) {
    // A gamma alone is written into every PNG by some programs, and says nothing of this one.
    if (!info.colorTag.empty() && !info.colorTag.starts_with("gamma"))
        warn(fmt::format("{}: the file says that its numbers are colors ({}); normals are no colors, and are read as "
                         "they are stored",
                         path, info.colorTag));
    const std::vector<std::string> layers = layersOf(info);
    if (layers.size() > 1)
        warn(fmt::format("{}: there are {} layers; the normals are channels {}, {} and {}, the first ones", path,
                         layers.size(), info.channelNames[0], info.channelNames[1], info.channelNames[2]));
}

} // namespace

NormalMap makeNormalMap(const Image& picture, const std::string& name, const NormalOptions& options, const Warn& warn) {
    checkChannels(picture.channels, name);
    NormalReader reader(picture.width, picture.height, name, options);
    reader.add(picture.texels, picture.channels);
    return reader.finish(warn);
}

NormalMap loadNormalMap(const std::string& path, const NormalOptions& options, const Warn& warn) {
    const ImageInfo info = readImageInfo(path, options.limits);
    checkChannels(info.channels, path);
    warnOfFile(info, path, warn);
    NormalReader reader(info.width, info.height, path, options);
    const TakeRows take = [&](int, int, std::span<const float> texels) { reader.add(texels, info.channels); };
    readImageRows(path, take, options.limits);
    return reader.finish(warn);
}

} // namespace relief
