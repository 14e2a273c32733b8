// Internal: what every shader that poses is given.
#pragma once

#include <cmath>

#include "model/shaders.h"
#include "pose/pose.h"
#include "shared/pose.h"

namespace relief {

constexpr std::uint32_t kGroupsAtOnce = 65535; ///< of a dispatch, in every device
constexpr std::uint32_t kFloatsAJoint = 12;    ///< three rows: joints are affine

/// The block in pose.glsl.
struct PosePush {
    std::uint64_t target = 0;
    std::uint32_t firstPoint = 0, pointCount = 0;
    std::uint32_t firstBlock = 0, endBlock = 0, firstBlockEntry = 0, firstTarget = 0, firstEntry = 0;
    std::uint32_t influenceCount = 0, morphCount = 0, isRigged = 0;
};

inline PipelineLayoutDesc poseLayout() {
    return {std::vector<VkDescriptorType>(kPoseBindCount, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER), sizeof(PosePush)};
}

inline std::vector<vec4> padded(std::span<const vec3> first, std::span<const vec3> second = {}) {
    std::vector<vec4> texels;
    texels.reserve(first.size() + second.size());
    for (const std::span<const vec3> all : {first, second})
        for (const vec3& v : all) texels.emplace_back(v, 0.0f);
    return texels;
}

inline Pipeline makePosePipeline(Device& device, const char* file, std::vector<std::uint32_t> constants) {
    return makeCompute(device, {.name = file,
                                .stage = {VK_SHADER_STAGE_COMPUTE_BIT, shaderCode(file)},
                                .constants = std::move(constants),
                                .layout = poseLayout()});
}

inline void checkFinite(std::span<const float> floats) {
    for (const float number : floats)
        if (!std::isfinite(number)) fail(Failure::input, "a pose holds a number that is not finite ({})", number);
}

/// Morph weights, then the upper three rows of each joint.
inline std::vector<float> rigFloats(const Pose& pose) {
    std::vector<float> floats = pose.morphWeights;
    for (const mat4& joint : pose.joints)
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column) floats.push_back(joint[column][row]);
    checkFinite(floats);
    return floats;
}

} // namespace relief
