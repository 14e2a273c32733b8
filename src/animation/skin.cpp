#include <cmath>

#include "animation/gltf_bind.h"
#include "animation/gltf_keys.h"

namespace relief {
namespace {

class Skin : public Animation {
public:
    /// `scene`: without its meshes, which are not needed any more.
    Skin(std::string path, GltfScene scene, GltfBinding binding)
        : Animation(binding.posed), path_(std::move(path)), scene_(std::move(scene)), binding_(std::move(binding)) {}

    [[nodiscard]] Pose pose(double seconds) const override {
        GltfMotion motion{.transforms = restTransforms(scene_), .weights = {}};
        for (const GltfNode& node : scene_.nodes) motion.weights.push_back(node.weights);
        if (scene_.clip) applyClip(*scene_.clip, seconds, motion);
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

    [[nodiscard]] dvec2 keyRange() const override { return scene_.clip ? keyRangeOf(*scene_.clip) : dvec2(0); }

private:
    /// Throws where products of finite numbers are beyond the range of floats.
    void checkFinite(const vec4& numbers, const char* what, std::uint32_t node, double seconds) const {
        for (int k = 0; k < 4; ++k)
            if (!std::isfinite(numbers[k]))
                fail(Failure::input, "{}: the {} of node {} is too large for floats at {} s", path_, what, node,
                     seconds);
    }

    std::string path_;
    GltfScene scene_;
    GltfBinding binding_;
};

} // namespace

std::unique_ptr<Animation> readSkin(const std::string& path, const Cage& cage, const SkinOptions& options,
                                    const Warn& warn) {
    GltfScene scene = readGltf(path, options.clip, warn);
    if (!scene.clip) warn(fmt::format("{}: there is no animation in it; the cage stands still", path));
    GltfBinding binding = bindCage(scene, cage, options.bindsNearest, path, warn);
    scene.meshes.clear();
    return std::make_unique<Skin>(path, std::move(scene), std::move(binding));
}

} // namespace relief
