#include <algorithm>
#include <set>

#include "cage/gltf_model.h"

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
    ClipReader(const GltfModel& model, const GltfScene& scene, GltfAccessors& accessors, std::size_t clip)
        : model_(model), scene_(scene), accessors_(accessors), from_(model.model.animations[clip]),
          place_(fmt::format("animations/{}", clip)) {}

    GltfClip read(const Warn& warn);

private:
    GltfChannel readChannel(const tinygltf::AnimationChannel& from, GltfPath path);
    void readKeys(const tinygltf::AnimationSampler& from, const std::string& place, GltfChannel& channel);
    void checkTimes(const GltfChannel& channel, const std::string& place) const;
    void checkRotations(const GltfChannel& channel, const std::string& place) const;
    [[nodiscard]] GltfInterpolation interpolationOf(const std::string& name, const std::string& place) const;

    const GltfModel& model_;
    const GltfScene& scene_;
    GltfAccessors& accessors_;
    const tinygltf::Animation& from_;
    std::string place_;
};

GltfClip ClipReader::read(const Warn& warn) {
    GltfClip clip{.name = from_.name, .channels = {}};
    std::set<std::pair<int, GltfPath>> moved;
    for (const tinygltf::AnimationChannel& from : from_.channels) {
        if (from.target_node < 0 || std::size_t(from.target_node) >= scene_.nodes.size())
            failAtElement(model_.path, place_, "node {} does not exist; there are {} (from 0)", from.target_node,
                          scene_.nodes.size());
        const GltfNode& node = scene_.nodes[std::size_t(from.target_node)];
        const std::optional<GltfPath> path = pathOf(from.target_path);
        if (!path || (path == GltfPath::weights && node.weights.empty())) {
            warn(fmt::format("{}: {}: the {} of node {} cannot be moved; ignored", model_.path, place_,
                             path ? "weights" : "path", from.target_node));
            continue;
        }
        if (!moved.emplace(from.target_node, *path).second)
            failAtElement(model_.path, place_, "moves the {} of node {} twice", from.target_path, from.target_node);
        if (node.matrix && path != GltfPath::weights)
            failAtElement(model_.path, place_,
                          "moves the {} of node {}, which has a matrix; give it translation, rotation and scale",
                          from.target_path, from.target_node);
        clip.channels.push_back(readChannel(from, *path));
    }
    return clip;
}

GltfChannel ClipReader::readChannel(const tinygltf::AnimationChannel& from, GltfPath path) {
    if (std::size_t(from.sampler) >= from_.samplers.size())
        failAtElement(model_.path, place_, "sampler {} does not exist; there are {} (from 0)", from.sampler,
                      from_.samplers.size());
    const auto node = std::uint32_t(from.target_node);
    GltfChannel channel{.node = node, .path = path};
    channel.width = path == GltfPath::weights    ? std::uint32_t(scene_.nodes[node].weights.size())
                    : path == GltfPath::rotation ? 4
                                                 : 3;
    readKeys(from_.samplers[std::size_t(from.sampler)], fmt::format("{}/samplers/{}", place_, from.sampler), channel);
    return channel;
}

void ClipReader::readKeys(const tinygltf::AnimationSampler& from, const std::string& place, GltfChannel& channel) {
    channel.interpolation = interpolationOf(from.interpolation, place);
    channel.times = accessors_.floats(from.input, {.place = place + "/input", .count = {}});
    checkTimes(channel, place);
    const std::size_t perKey = channel.interpolation == GltfInterpolation::cubicSpline ? 3 : 1;
    const bool areWeights = channel.path == GltfPath::weights;
    const bool isRotation = channel.path == GltfPath::rotation;
    channel.values =
        accessors_.floats(from.output, {.place = place + "/output",
                                        .type = areWeights   ? TINYGLTF_TYPE_SCALAR
                                                : isRotation ? TINYGLTF_TYPE_VEC4
                                                             : TINYGLTF_TYPE_VEC3,
                                        .takesNormalized = areWeights || isRotation,
                                        .count = channel.times.size() * perKey * (areWeights ? channel.width : 1)});
    if (isRotation) checkRotations(channel, place);
}

void ClipReader::checkTimes(const GltfChannel& channel, const std::string& place) const {
    for (std::size_t i = 1; i < channel.times.size(); ++i)
        if (channel.times[i] <= channel.times[i - 1])
            failAtElement(model_.path, place, "key {} is at {} s, the one before at {} s; times must rise", i,
                          channel.times[i], channel.times[i - 1]);
}

/// Nothing can be turned by a quaternion without length.
void ClipReader::checkRotations(const GltfChannel& channel, const std::string& place) const {
    const bool isCubic = channel.interpolation == GltfInterpolation::cubicSpline;
    for (std::size_t key = 0; key < channel.times.size(); ++key) {
        const float* q = &channel.values[isCubic ? 12 * key + 4 : 4 * key];
        if (q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0)
            failAtElement(model_.path, place, "the rotation of key {} is 0; it must be a unit quaternion", key);
    }
}

GltfInterpolation ClipReader::interpolationOf(const std::string& name, const std::string& place) const {
    if (name == "LINEAR") return GltfInterpolation::linear;
    if (name == "STEP") return GltfInterpolation::step;
    if (name == "CUBICSPLINE") return GltfInterpolation::cubicSpline;
    failAtElement(model_.path, place, "unknown interpolation; it is LINEAR, STEP or CUBICSPLINE");
}

} // namespace

std::vector<GltfClip> readGltfClips(const GltfModel& model, const GltfScene& scene, GltfAccessors& accessors,
                                    const Warn& warn) {
    std::vector<GltfClip> clips;
    for (std::size_t i = 0; i < model.model.animations.size(); ++i)
        clips.push_back(ClipReader(model, scene, accessors, i).read(warn));
    return clips;
}

} // namespace relief
