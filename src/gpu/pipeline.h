// Pipelines from SPIR-V, and what their shaders are given.
#pragma once

#include <functional>
#include <memory>

#include "gpu/memory.h"

namespace relief {

struct Stage {
    VkShaderStageFlagBits stage;
    std::span<const std::uint32_t> code; ///< SPIR-V words
    std::shared_ptr<const void> owner;   ///< keeps the code until the pipeline is made; null where it lasts anyway
};

/// What every pipeline is given: the kinds of set 0's bindings 0, 1, 2, ... and a block of push constants.
struct PipelineLayoutDesc {
    std::vector<VkDescriptorType> bindings;
    std::uint32_t pushBytes = 0;
};

struct GraphicsDesc {
    std::string name;
    std::vector<Stage> stages;
    std::vector<std::uint32_t> constants; ///< specialization constants 0, 1, 2, ... of every stage
    PipelineLayoutDesc layout;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPolygonMode polygonMode = VK_POLYGON_MODE_FILL;
    bool rasterizerDiscard = false;               ///< vertices alone: no rasterization
    bool additiveBlend = false;                   ///< colors are added, without depth
    float depthBiasUnits = 0, depthBiasSlope = 0; ///< for a wireframe over its own surface; 0: none
    std::vector<VkFormat> colorFormats;           ///< none: depth alone
    VkFormat depthFormat = VK_FORMAT_D32_SFLOAT;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
};

struct ComputeDesc {
    std::string name;
    Stage stage;
    std::vector<std::uint32_t> constants; ///< specialization constants 0, 1, 2, ...
    PipelineLayoutDesc layout;
};

struct Pipeline {
    Owned<VkDescriptorSetLayout> setLayout;
    Owned<VkPipelineLayout> layout;
    Owned<VkPipeline> handle;
    VkPipelineBindPoint bindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
};

/// Depth is reversed (1 near, 0 far) and compared greater-or-equal; viewport and scissor are dynamic.
Pipeline makeGraphics(Device& device, const GraphicsDesc& desc);
Pipeline makeCompute(Device& device, const ComputeDesc& desc);

/// A pipeline that a thread of the device makes while its caller goes on; copies are the same one. It has to end before
/// the device does.
class PendingPipeline {
public:
    PendingPipeline() = default;
    /// Starts to make it.
    PendingPipeline(Device& device, std::function<Pipeline()> make);
    /// Waits for the pipeline, or makes it here where no thread has begun to. Throws what making it throws.
    const Pipeline& get() const;

private:
    struct State;
    std::shared_ptr<State> state_;
};

/// Starts to make what makeGraphics and makeCompute make. Code without an owner must live until the pipeline is made.
PendingPipeline startGraphics(Device& device, GraphicsDesc desc);
PendingPipeline startCompute(Device& device, ComputeDesc desc);

struct DescriptorPool;

/// Set 0 of pipelines with one layout: movable, never copied. Its part of the device's pools is used again once all
/// sets of the same pool have ended.
struct BindingSet {
    BindingSet() = default;
    BindingSet(BindingSet&&) = default;
    BindingSet& operator=(BindingSet&&) = default;

    std::shared_ptr<DescriptorPool> pool;
    VkDescriptorSet handle = VK_NULL_HANDLE;
};

/// A set that binds `bindings` 0, 1, 2, ...; empty ones are not written: the pipeline's shaders must not read them.
/// Throws Failure::device where the layout asks for a texel buffer and the table is too large to have a view.
BindingSet makeBindingSet(Device& device, const Pipeline& pipeline, const PipelineLayoutDesc& layout,
                          std::span<const Binding> bindings);

void bind(VkCommandBuffer commands, const Pipeline& pipeline, const BindingSet& bindings);
void push(VkCommandBuffer commands, const Pipeline& pipeline, std::span<const std::byte> bytes);

} // namespace relief
