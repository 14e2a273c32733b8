#include <charconv>
#include <cmath>

#include "animation/gltf_bind.h"
#include "animation/gltf_keys.h"

namespace relief {
namespace {

class Skin : public Animation {
public:
    /// Without meshes; the clip is one of the scene's, or none.
    Skin(std::string path, GltfScene scene, GltfBinding binding, std::optional<std::size_t> clip)
        : Animation(binding.posed), path_(std::move(path)), scene_(std::move(scene)), binding_(std::move(binding)),
          clip_(clip) {}

    [[nodiscard]] Pose pose(double seconds) const override {
        GltfMotion motion{.transforms = restTransforms(scene_), .weights = {}};
        for (const GltfNode& node : scene_.nodes) motion.weights.push_back(node.weights);
        if (clip_) applyClip(scene_.clips[*clip_], seconds, motion);
        const std::vector<glm::dmat4> worlds = worldMatrices(scene_, motion.transforms);
        Pose pose;
        for (const GltfJoint& joint : binding_.joints) {
            pose.joints.emplace_back(leadingTo(binding_.posed, worlds[joint.node] * joint.inverseBind));
            for (int column = 0; column < 4; ++column)
                checkFinite(pose.joints.back()[column], "matrix", joint.node, seconds);
        }
        for (const GltfMorph& morph : binding_.morphs) {
            pose.morphWeights.push_back(float(motion.weights[morph.node][morph.target]));
            checkFinite(vec4(pose.morphWeights.back()), "weights", morph.node, seconds);
        }
        return pose;
    }

    [[nodiscard]] const Rig* rig() const override { return &binding_.rig; }

    [[nodiscard]] dvec2 keyRange() const override { return clip_ ? keyRangeOf(scene_.clips[*clip_]) : dvec2(0); }

private:
    /// Finite numbers may still multiply past all floats.
    void checkFinite(const vec4& numbers, const char* what, std::uint32_t node, double seconds) const {
        for (int k = 0; k < 4; ++k)
            if (!std::isfinite(numbers[k]))
                fail(Failure::input, "{}: the {} of node {} cannot be told by floats at {} s", path_, what, node,
                     seconds);
    }

    std::string path_;
    GltfScene scene_;
    GltfBinding binding_;
    std::optional<std::size_t> clip_;
};

std::string listOf(const std::vector<GltfClip>& clips) {
    constexpr std::size_t kMost = 20;
    std::string list;
    for (std::size_t i = 0; i < clips.size() && i < kMost; ++i)
        list += fmt::format("{}{} '{}'", i == 0 ? "" : ", ", i, printable(clips[i].name));
    return clips.size() > kMost ? list + ", ..." : list;
}

/// By name, else by number; the first where nothing is asked for.
std::size_t findClip(const std::vector<GltfClip>& clips, const std::string& asked, const std::string& path) {
    if (asked.empty()) return 0;
    for (std::size_t i = 0; i < clips.size(); ++i)
        if (clips[i].name == asked) return i;
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(asked.data(), asked.data() + asked.size(), number);
    if (error != std::errc() || end != asked.data() + asked.size() || number >= clips.size())
        fail(Failure::input, "{}: there is no animation '{}'; there are {}", path, printable(asked), listOf(clips));
    return number;
}

} // namespace

std::unique_ptr<Animation> readSkin(const std::string& path, const Cage& cage, const SkinOptions& options,
                                    const Warn& warn) {
    GltfScene scene = readGltf(path, warn);
    std::optional<std::size_t> clip;
    if (!scene.clips.empty())
        clip = findClip(scene.clips, options.clip, path);
    else if (options.clip.empty())
        warn(fmt::format("{}: there is no animation in it; the cage stands still", path));
    else
        fail(Failure::input, "{}: there is no animation '{}', nor any other", path, printable(options.clip));
    GltfBinding binding = bindCage(scene, cage, options.bindsNearest, path, warn);
    scene.meshes.clear();
    return std::make_unique<Skin>(path, std::move(scene), std::move(binding), clip);
}

} // namespace relief
