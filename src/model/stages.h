// What every shader stage is given: constants, push constants, set 0. Used here and by frame.
#pragma once

#include "model/model.h"
#include "model/records.h"
#include "model/shaders.h"

namespace relief {

/// The block in scene.glsl.
struct PushConstants {
    std::uint32_t passNumber = 0;
    std::uint32_t drawsShadow = 0;
    std::uint32_t passRows = 0;
    std::uint32_t passFirst = 0;
};

/// Set 0 of every pass (kBind...).
PipelineLayoutDesc passLayout();

/// Specialization constants 0..14 in the order of the shaders' constant_id.
struct ShaderConstants {
    bool isGenericBasis = false, hasTexCoords = false, hasHeight = false;
    NormalKind normal = NormalKind::full;
    bool wantsTexCoords = false;
    std::uint32_t show = kShowShaded;
    bool hasAlbedoMap = false;
    std::uint32_t groupSize = 64; ///< dicing: invocations of a workgroup
    bool hasMips = false;
    bool isCommon = false;  ///< dicing: insides in bicubic patches, triangles between inner samples
    bool stretches = false; ///< heights grow with the surface
    bool hasMotion = false; ///< layers: the surface was in another pose before
    MapFormat mapFormat = MapFormat::real;
    bool hasWideIndices = false;
    bool hasStraightCorners = false;

    [[nodiscard]] std::vector<std::uint32_t> values() const {
        return {isGenericBasis,
                hasTexCoords,
                hasHeight,
                std::uint32_t(normal),
                wantsTexCoords,
                show,
                hasAlbedoMap,
                groupSize,
                hasMips,
                isCommon,
                stretches,
                hasMotion,
                std::uint32_t(mapFormat),
                hasWideIndices,
                hasStraightCorners};
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

inline ShaderConstants constantsOf(const Model& model, NormalKind normal) {
    return {.hasTexCoords = model.hasTexCoords(),
            .hasHeight = model.hasHeight(),
            .normal = normal,
            .stretches = model.stretches(),
            .mapFormat = model.mapFormat(),
            .hasWideIndices = model.hasWideIndices(),
            .hasStraightCorners = model.hasStraightCorners()};
}

} // namespace relief
