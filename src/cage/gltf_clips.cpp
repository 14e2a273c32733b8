#include <charconv>
#include <set>

#include "cage/gltf_reader.h"

namespace relief {
namespace {

std::optional<GltfPath> pathOf(const std::string& name) {
    if (name == "translation") return GltfPath::translation;
    if (name == "rotation") return GltfPath::rotation;
    if (name == "scale") return GltfPath::scale;
    if (name == "weights") return GltfPath::weights;
    return std::nullopt;
}

class ClipReader {
public:
    ClipReader(const GltfElement& from, const GltfScene& scene, GltfAccessors& accessors, GltfOddities& oddities)
        : from_(from), scene_(scene), accessors_(accessors), oddities_(oddities), isUsed_(scene.nodes.size(), false) {
        for (const std::uint32_t node : scene.order) isUsed_[node] = true;
    }

    GltfClip read();

private:
    /// What a channel moves, or nothing where that is not shown or cannot be moved.
    std::optional<GltfChannel> channelOf(const GltfElement& target);
    void readKeys(const GltfElement& channelFrom, GltfChannel& channel);
    void checkTimes(const GltfChannel& channel, const GltfElement& sampler) const;
    void checkRotations(const GltfChannel& channel, const GltfElement& sampler) const;
    [[nodiscard]] GltfInterpolation interpolationOf(const GltfElement& sampler) const;

    const GltfElement& from_;
    const GltfScene& scene_;
    GltfAccessors& accessors_;
    GltfOddities& oddities_;
    std::vector<bool> isUsed_; ///< nodes
};

GltfClip ClipReader::read() {
    GltfClip clip{.name = from_.name(), .channels = {}};
    std::set<std::pair<std::uint32_t, GltfPath>> moved;
    for (std::size_t i = 0; i < from_.count("channels"); ++i) {
        const GltfElement from = from_.at("channels", i);
        const GltfElement target = *from.need("target").object("target");
        std::optional<GltfChannel> channel = channelOf(target);
        if (!channel) continue;
        if (!moved.emplace(channel->node, channel->path).second)
            from_.fail("moves the {} of node {} twice", target.text("path"), channel->node);
        if (scene_.nodes[channel->node].matrix && channel->path != GltfPath::weights)
            from_.fail("moves the {} of node {}, which has a matrix; give it translation, rotation and scale",
                       target.text("path"), channel->node);
        readKeys(from, *channel);
        clip.channels.push_back(std::move(*channel));
    }
    return clip;
}

std::optional<GltfChannel> ClipReader::channelOf(const GltfElement& target) {
    const std::optional<std::uint32_t> node = target.integer("node");
    const std::optional<GltfPath> path = pathOf(target.need("path").text("path"));
    if (node && *node >= scene_.nodes.size())
        from_.fail("node {} does not exist; there are {} (from 0)", *node, scene_.nodes.size());
    if (!node || !path) {
        oddities_.add("channels that move no node's translation, rotation, scale or weights are ignored",
                      target.place());
        return std::nullopt;
    }
    if (!isUsed_[*node]) return std::nullopt;
    const std::vector<double>& weights = scene_.nodes[*node].weights;
    if (path == GltfPath::weights && weights.empty()) {
        oddities_.add("channels that move the weights of a node without morph targets are ignored", target.place());
        return std::nullopt;
    }
    const bool isRotation = path == GltfPath::rotation;
    return GltfChannel{.node = *node,
                       .path = *path,
                       .width = path == GltfPath::weights ? std::uint32_t(weights.size())
                                : isRotation              ? 4u
                                                          : 3u};
}

void ClipReader::readKeys(const GltfElement& channelFrom, GltfChannel& channel) {
    const std::uint32_t number = *channelFrom.need("sampler").integer("sampler");
    const std::size_t samplerCount = from_.count("samplers");
    if (number >= samplerCount) from_.fail("sampler {} does not exist; there are {} (from 0)", number, samplerCount);
    const GltfElement sampler = from_.at("samplers", number);
    channel.interpolation = interpolationOf(sampler);
    const GltfUse input{.place = sampler.place() + "/input", .count = {}};
    channel.times = accessors_.floats(*sampler.need("input").integer("input"), input);
    checkTimes(channel, sampler);
    const std::size_t perKey = channel.interpolation == GltfInterpolation::cubicSpline ? 3 : 1;
    const bool areWeights = channel.path == GltfPath::weights;
    const bool isRotation = channel.path == GltfPath::rotation;
    const GltfUse output{.place = sampler.place() + "/output",
                         .type = areWeights   ? TINYGLTF_TYPE_SCALAR
                                 : isRotation ? TINYGLTF_TYPE_VEC4
                                              : TINYGLTF_TYPE_VEC3,
                         .takesNormalized = areWeights || isRotation,
                         .count = channel.times.size() * perKey * (areWeights ? channel.width : 1)};
    channel.values = accessors_.floats(*sampler.need("output").integer("output"), output);
    if (isRotation) checkRotations(channel, sampler);
}

void ClipReader::checkTimes(const GltfChannel& channel, const GltfElement& sampler) const {
    for (std::size_t i = 1; i < channel.times.size(); ++i)
        if (channel.times[i] <= channel.times[i - 1])
            sampler.fail("key {} is at {} s, the one before at {} s; times must rise", i, channel.times[i],
                         channel.times[i - 1]);
}

/// Nothing can be turned by a quaternion without length.
void ClipReader::checkRotations(const GltfChannel& channel, const GltfElement& sampler) const {
    const bool isCubic = channel.interpolation == GltfInterpolation::cubicSpline;
    for (std::size_t key = 0; key < channel.times.size(); ++key) {
        const float* q = &channel.values[isCubic ? 12 * key + 4 : 4 * key];
        if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0)
            sampler.fail("the rotation of key {} is 0; it must be a unit quaternion", key);
    }
}

GltfInterpolation ClipReader::interpolationOf(const GltfElement& sampler) const {
    const std::string name = sampler.text("interpolation");
    if (name.empty() || name == "LINEAR") return GltfInterpolation::linear;
    if (name == "STEP") return GltfInterpolation::step;
    if (name == "CUBICSPLINE") return GltfInterpolation::cubicSpline;
    sampler.fail("unknown interpolation; it is LINEAR, STEP or CUBICSPLINE");
}

/// Lists the names of all animations; "" for entries that are no objects.
std::vector<std::string> namesOfClips(const GltfDocument& document) {
    std::vector<std::string> names(document.root().count("animations"));
    for (std::size_t i = 0; i < names.size(); ++i)
        if (document.json["animations"][i].is_object()) names[i] = document.root().at("animations", i).name();
    return names;
}

std::string listOf(const std::vector<std::string>& names) {
    constexpr std::size_t kMost = 20;
    std::string list;
    for (std::size_t i = 0; i < names.size() && i < kMost; ++i)
        list += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, printable(names[i]));
    return names.size() > kMost ? list + ", ..." : list;
}

/// Finds a clip by its name, else by its number; the first one where `asked` is empty.
std::size_t findClip(const std::vector<std::string>& names, const std::string& asked, const std::string& path) {
    if (asked.empty()) return 0;
    for (std::size_t i = 0; i < names.size(); ++i)
        if (names[i] == asked) return i;
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(asked.data(), asked.data() + asked.size(), number);
    if (error != std::errc() || end != asked.data() + asked.size() || number >= names.size())
        fail(Failure::input, "{}: there is no animation '{}'; there are {}", path, printable(asked), listOf(names));
    return number;
}

} // namespace

std::optional<GltfClip> readGltfClip(const GltfDocument& document, const std::string& asked, const GltfScene& scene,
                                     GltfAccessors& accessors, GltfOddities& oddities) {
    const std::vector<std::string> names = namesOfClips(document);
    if (names.empty() && asked.empty()) return std::nullopt;
    if (names.empty())
        fail(Failure::input, "{}: there is no animation '{}', nor any other", document.path, printable(asked));
    const GltfElement from = document.root().at("animations", findClip(names, asked, document.path));
    return ClipReader(from, scene, accessors, oddities).read();
}

} // namespace relief
