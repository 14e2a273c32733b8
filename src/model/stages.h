// What every shader stage is given: constants, push constants, set 0. Used here and by frame.
#pragma once

#include "model/model.h"
#include "model/shaders.h"

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

/// Two triangles a cell (one in the last of a triangle's row) over a grid of n segments a side.
std::vector<std::uint32_t> gridIndices(std::uint32_t n, bool isTriangles);

} // namespace relief
