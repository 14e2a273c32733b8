// What every shader stage is given: constants, push constants, set 0. Used here and by frame.
#pragma once

#include <map>

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
    bool hasWideNets = false;
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
                hasWideNets,
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

/// Passes that make no picture: everything of a scene and of set 0 up to the samples of a picture.
class GeometryInputs {
public:
    explicit GeometryInputs(Device& device);

    static PipelineLayoutDesc layout();
    /// Describes the model; what it does not fill is bound all the same: Mesa 22.3's CPU driver walks every descriptor
    /// of a set, whether or not a shader reads it.
    void fill(const Model& model, Scene& scene, std::span<Binding> bindings) const;
    const Buffer& scene() const { return scene_; }

private:
    Buffer scene_;
    TexelBuffer none_;
    Owned<VkSampler> sampler_;
};

/// Compute pipelines by shader and constants, made when first asked for.
class ComputeStages {
public:
    explicit ComputeStages(Device& device) : device_(device) {}
    const Pipeline& pipeline(const char* file, const Model& model, const ShaderConstants& constants);

private:
    Device& device_;
    std::map<std::pair<std::string, std::vector<std::uint32_t>>, Pipeline> pipelines_;
};

/// What shaders read of rates: the rates themselves and the levels of the height map.
struct RateTexels {
    TexelBuffer rates, levels;
};
RateTexels uploadRates(Device& device, const Model& model, const EdgeRates& rates);
/// Binds them and fills their part of the scene.
void useRates(const Model& model, const EdgeRates& rates, const RateTexels& texels, Scene& scene,
              std::span<Binding> bindings);

inline ShaderConstants constantsOf(const Model& model, NormalKind normal) {
    return {.hasTexCoords = model.hasTexCoords(),
            .hasHeight = model.hasHeight(),
            .normal = normal,
            .stretches = model.stretches(),
            .mapFormat = model.mapFormat(),
            .hasWideNets = model.hasWideNets(),
            .hasStraightCorners = model.hasStraightCorners()};
}

/// Two triangles a cell, row after row: the first rows of a larger grid with as many columns.
std::vector<std::uint32_t> gridIndices(std::uint32_t columns, std::uint32_t rows);
/// The same for triangles with n segments a side: one triangle in the last cell of a row.
std::vector<std::uint32_t> triangleGridIndices(std::uint32_t n);

} // namespace relief
