#include <mutex>

#include "gpu/background_tasks.h"
#include "gpu/gpu.h"
#include "gpu/pipeline_cache.h"
#include "gpu/specialize.h"

namespace relief {
namespace {

Owned<VkShaderModule> makeModule(Device& device, std::span<const std::uint32_t> stageCode,
                                 std::span<const std::uint32_t> constants) {
    const std::vector<std::uint32_t> code = specialize(stageCode, constants);
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code.size() * 4;
    info.pCode = code.data();
    VkShaderModule module = VK_NULL_HANDLE;
    checkVulkan(vkCreateShaderModule(device.handle(), &info, nullptr, &module), "vkCreateShaderModule");
    return {device.handle(), module, vkDestroyShaderModule};
}

/// Constant ids 0, 1, 2, ...: four bytes each.
struct Constants {
    explicit Constants(const std::vector<std::uint32_t>& values) : entries(values.size()) {
        for (std::uint32_t i = 0; i < values.size(); ++i) entries[i] = {i, i * 4, 4};
        info = {std::uint32_t(entries.size()), entries.data(), values.size() * 4, values.data()};
    }
    std::vector<VkSpecializationMapEntry> entries;
    VkSpecializationInfo info{};
};

void makeLayout(Device& device, const PipelineLayoutDesc& desc, Pipeline& pipeline) {
    const auto count = std::uint32_t(desc.bindings.size());
    std::vector<VkDescriptorSetLayoutBinding> bindings(count);
    for (std::uint32_t i = 0; i < count; ++i) bindings[i] = {i, desc.bindings[i], 1, VK_SHADER_STAGE_ALL, nullptr};
    VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
    set.bindingCount = count;
    set.pBindings = bindings.data();
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE;
    checkVulkan(vkCreateDescriptorSetLayout(device.handle(), &set, nullptr, &setLayout), "vkCreateDescriptorSetLayout");
    pipeline.setLayout = {device.handle(), setLayout, vkDestroyDescriptorSetLayout};

    const VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, desc.pushBytes};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = 1;
    info.pSetLayouts = &setLayout;
    info.pushConstantRangeCount = desc.pushBytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    checkVulkan(vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout), "vkCreatePipelineLayout");
    pipeline.layout = {device.handle(), layout, vkDestroyPipelineLayout};
}

void own(Device& device, Pipeline& pipeline, VkPipeline handle, const std::string& name) {
    pipeline.handle = {device.handle(), handle, vkDestroyPipeline};
    device.setName(VK_OBJECT_TYPE_PIPELINE, std::uint64_t(handle), name);
}

VkPipelineShaderStageCreateInfo stageInfo(VkShaderStageFlagBits stage, VkShaderModule module,
                                          const Constants& constants) {
    VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
    info.stage = stage;
    info.module = module;
    info.pName = "main";
    info.pSpecializationInfo = &constants.info;
    return info;
}

VkPipelineRasterizationStateCreateInfo rasterState(const GraphicsDesc& desc) {
    VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
    raster.rasterizerDiscardEnable = desc.rasterizerDiscard ? VK_TRUE : VK_FALSE;
    raster.polygonMode = desc.polygonMode;
    raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    raster.lineWidth = 1;
    raster.depthBiasEnable = desc.depthBiasUnits != 0 || desc.depthBiasSlope != 0 ? VK_TRUE : VK_FALSE;
    raster.depthBiasConstantFactor = desc.depthBiasUnits;
    raster.depthBiasSlopeFactor = desc.depthBiasSlope;
    return raster;
}

} // namespace

Pipeline makeGraphics(Device& device, const GraphicsDesc& desc) {
    // Layout and stages. All stages get the same constants.
    Pipeline pipeline;
    makeLayout(device, desc.layout, pipeline);
    const Constants constants(desc.constants);
    std::vector<Owned<VkShaderModule>> modules;
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (const Stage& stage : desc.stages) {
        modules.push_back(makeModule(device, stage.code, desc.constants));
        stages.push_back(stageInfo(stage.stage, modules.back().get(), constants));
    }

    // Primitives: vertices come from tables, never from vertex buffers, and patches have one point each.
    const VkPipelineVertexInputStateCreateInfo noVertices{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = desc.topology;
    VkPipelineTessellationStateCreateInfo tessellation{VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO};
    tessellation.patchControlPoints = 1;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    const VkPipelineRasterizationStateCreateInfo raster = rasterState(desc);

    // Samples. Blending adds, where it is on, and then every triangle counts: no depth.
    VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
    samples.rasterizationSamples = desc.samples;
    VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
    depth.depthTestEnable = depth.depthWriteEnable = desc.additiveBlend ? VK_FALSE : VK_TRUE;
    depth.depthCompareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;
    VkPipelineColorBlendAttachmentState each{};
    each.colorWriteMask = 0xf;
    each.blendEnable = desc.additiveBlend ? VK_TRUE : VK_FALSE;
    each.srcColorBlendFactor = each.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    each.srcAlphaBlendFactor = each.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    const std::vector<VkPipelineColorBlendAttachmentState> attachments(desc.colorFormats.size(), each);
    VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
    blend.attachmentCount = std::uint32_t(attachments.size());
    blend.pAttachments = attachments.data();

    // The size of pictures is dynamic, so that pipelines serve all of them.
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = states;
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = blend.attachmentCount;
    rendering.pColorAttachmentFormats = desc.colorFormats.data();
    rendering.depthAttachmentFormat = desc.depthFormat;

    // All together.
    VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
    info.pNext = &rendering;
    info.stageCount = std::uint32_t(stages.size());
    info.pStages = stages.data();
    info.pVertexInputState = &noVertices;
    info.pInputAssemblyState = &assembly;
    info.pTessellationState = &tessellation;
    info.pViewportState = &viewport;
    info.pRasterizationState = &raster;
    info.pMultisampleState = &samples;
    info.pDepthStencilState = &depth;
    info.pColorBlendState = &blend;
    info.pDynamicState = &dynamic;
    info.layout = pipeline.layout.get();
    VkPipeline handle = VK_NULL_HANDLE;
    checkVulkan(vkCreateGraphicsPipelines(device.handle(), device.pipelineCache().handle(), 1, &info, nullptr, &handle),
                "vkCreateGraphicsPipelines");
    own(device, pipeline, handle, desc.name);
    return pipeline;
}

Pipeline makeCompute(Device& device, const ComputeDesc& desc) {
    Pipeline pipeline;
    pipeline.bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
    makeLayout(device, desc.layout, pipeline);
    const Constants constants(desc.constants);
    const Owned<VkShaderModule> module = makeModule(device, desc.stage.code, desc.constants);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = stageInfo(VK_SHADER_STAGE_COMPUTE_BIT, module.get(), constants);
    info.layout = pipeline.layout.get();
    VkPipeline handle = VK_NULL_HANDLE;
    checkVulkan(vkCreateComputePipelines(device.handle(), device.pipelineCache().handle(), 1, &info, nullptr, &handle),
                "vkCreateComputePipelines");
    own(device, pipeline, handle, desc.name);
    return pipeline;
}

struct PendingPipeline::State {
    std::mutex mutex;
    std::function<Pipeline()> make; ///< empty once the pipeline is made
    Pipeline pipeline;

    /// The mutex is locked.
    void finish() {
        if (!make) return;
        pipeline = make();
        make = nullptr;
    }
};

PendingPipeline::PendingPipeline(Device& device, std::function<Pipeline()> make) : state_(std::make_shared<State>()) {
    state_->make = std::move(make);
    device.backgroundTasks().add([state = state_] {
        const std::unique_lock lock(state->mutex, std::try_to_lock);
        if (!lock.owns_lock()) return; // somebody who needs it makes it already
        try {
            state->finish();
        } catch (...) { // it fails again for those who need it, and they report it
        }
    });
}

const Pipeline& PendingPipeline::get() const {
    const std::lock_guard lock(state_->mutex);
    state_->finish();
    return state_->pipeline;
}

PendingPipeline startGraphics(Device& device, GraphicsDesc desc) {
    return {device, [&device, desc = std::move(desc)] { return makeGraphics(device, desc); }};
}

PendingPipeline startCompute(Device& device, ComputeDesc desc) {
    return {device, [&device, desc = std::move(desc)] { return makeCompute(device, desc); }};
}

void bind(VkCommandBuffer commands, const Pipeline& pipeline, const BindingSet& bindings) {
    vkCmdBindPipeline(commands, pipeline.bindPoint, pipeline.handle.get());
    vkCmdBindDescriptorSets(commands, pipeline.bindPoint, pipeline.layout.get(), 0, 1, &bindings.handle, 0, nullptr);
}

void push(VkCommandBuffer commands, const Pipeline& pipeline, std::span<const std::byte> bytes) {
    vkCmdPushConstants(commands, pipeline.layout.get(), VK_SHADER_STAGE_ALL, 0, std::uint32_t(bytes.size()),
                       bytes.data());
}

} // namespace relief
