// Internal: what every shader that poses is given.
#pragma once

#include <array>
#include <cmath>

#include "model/stages.h"
#include "pose/pose.h"
#include "shared/pose.h"

namespace relief {

constexpr std::uint32_t kFloatsPerJoint = 12;  ///< three rows: joints are affine
constexpr std::uint32_t kStraightEntries = 32; ///< stencil blocks of more are pose_points.comp's on every device

inline PipelineLayoutDesc poseLayout(const Device& device) {
    return tableLayout(device, kPoseBindCount, sizeof(PosePush));
}

using PoseBindings = std::array<Binding, kPoseBindCount>;

inline std::vector<vec4> padded(std::span<const vec3> first, std::span<const vec3> second = {}) {
    std::vector<vec4> texels;
    texels.reserve(first.size() + second.size());
    for (const std::span<const vec3> all : {first, second})
        for (const vec3& v : all) texels.emplace_back(v, 0.0f);
    return texels;
}

inline Pipeline makePosePipeline(Device& device, const char* file, const ShaderConstants& constants = {}) {
    return makeCompute(device, {.name = file,
                                .stage = shaderStage(device, VK_SHADER_STAGE_COMPUTE_BIT, file),
                                .constants = constants.values(),
                                .layout = poseLayout(device)});
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
