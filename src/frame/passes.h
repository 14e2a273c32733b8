// What the renderer and the point sampler share: constants of the shaders, push constants, sampled textures.
#pragma once

#include "frame/frame.h"
#include "frame/shaders.h"

namespace relief {

struct PushConstants {
    std::uint32_t passNumber = 0;
    std::uint32_t drawsShadow = 0;
};

/// Set 0 of every pass (kBind...).
PipelineLayoutDesc passLayout();

/// Specialization constants 0..6 in the order of the shaders' constant_id.
struct ShaderConstants {
    bool isGenericBasis = false, hasTexCoords = false, hasHeight = false;
    NormalKind normal = NormalKind::full;
    bool wantsTexCoords = false;
    std::uint32_t show = kShowShaded;
    bool hasAlbedoMap = false;

    [[nodiscard]] std::vector<std::uint32_t> values() const {
        return {isGenericBasis, hasTexCoords, hasHeight, std::uint32_t(normal), wantsTexCoords, show, hasAlbedoMap};
    }
};

inline void pushConstants(VkCommandBuffer commands, const Pipeline& pipeline, const PushConstants& constants) {
    push(commands, pipeline, std::as_bytes(std::span(&constants, 1)));
}

/// Texel buffers that change from frame to frame.
TexelBuffer uploadWords(Device& device, const std::string& name, std::span<const std::uint32_t> words);

/// A uniform buffer that holds one Scene; written inside a command buffer.
Buffer makeSceneBuffer(Device& device);
void writeScene(VkCommandBuffer commands, const Buffer& buffer, const Scene& scene);

/// Right-handed view, Y down in clip space, depth 1 at the near and 0 at the far distance.
mat4 perspectiveMatrix(const Camera& camera, double aspect);

/// Parallel projection along the key light, holding the whole object; nearer to the light is larger.
mat4 shadowMatrix(const dvec3& towardsLight, const Bounds& bounds);

/// Two triangles a cell (one in the last of a triangle's row) over a grid of n segments a side.
std::vector<std::uint32_t> gridIndices(std::uint32_t n, bool isTriangles);

constexpr VkFormat kNormalFormat = VK_FORMAT_R16G16_SFLOAT;
constexpr VkFormat kColorFormat = VK_FORMAT_R8G8B8A8_SRGB;
constexpr VkFormat kDepthFormat = VK_FORMAT_D32_SFLOAT;
constexpr VkFormat kShadowFormat = VK_FORMAT_D16_UNORM; // even steps suit a parallel projection

/// The images of a picture in the making.
struct Targets {
    Texture normals, colors, depths; ///< four samples a pixel, what surface.frag writes
    Texture shadow;
    Buffer picture; ///< four halves a pixel, mapped
};

Targets makeTargets(Device& device, const RendererDesc& desc);

} // namespace relief
