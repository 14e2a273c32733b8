// Internal: the matrices and images of a picture in the making.
#pragma once

#include "frame/frame.h"
#include "triangles/stages.h"

namespace relief {

/// Right-handed view, Y down in clip space, depth 1 at the near and 0 at the far distance.
mat4 perspectiveMatrix(const Camera& camera, double aspect);

/// Parallel projection along the key light, holding the whole object; nearer to the light is larger.
mat4 shadowMatrix(const dvec3& towardsLight, const Bounds& bounds);

constexpr VkFormat kNormalFormat = VK_FORMAT_R16G16_SFLOAT;
constexpr VkFormat kColorFormat = VK_FORMAT_A2B10G10R10_UNORM_PACK32; // codes that shaders/rounding.glsl chooses
constexpr VkFormat kCrackFormat = VK_FORMAT_R16_SFLOAT;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkFormat kShadowFormat = VK_FORMAT_D16_UNORM; // even steps suit a parallel projection

/// The images of a picture in the making.
struct Targets {
    Texture normals, colors, depths; ///< four samples a pixel, what surface.frag writes
    Texture shadow;
    Buffer picture; ///< four halves a pixel, mapped
};

Targets makeTargets(Device& device, const RendererDesc& desc);

constexpr VkFormat kLayerFormat = VK_FORMAT_R32G32B32A32_SFLOAT;

/// The images that layers are made from, one sample a pixel; made when layers are first asked for.
struct LayerTargets {
    Texture normals, places, depths; ///< what layers.frag writes
    Buffer values;                   ///< kLayerChannels floats a pixel, mapped
};

LayerTargets makeLayerTargets(Device& device, const RendererDesc& desc);

} // namespace relief
