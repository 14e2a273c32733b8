#include "gpu/gpu.h"

namespace relief {
namespace {

Owned<VkShaderModule> makeModule(Device& device, std::span<const std::uint32_t> code) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    VkShaderModule module = VK_NULL_HANDLE;
    checkVulkan(vkCreateShaderModule(device.handle(), &info, nullptr, &module), "vkCreateShaderModule");
    return {module, [d = device.handle()](VkShaderModule m) { vkDestroyShaderModule(d, m, nullptr); }};
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
    pipeline.setLayout = {
        setLayout, [d = device.handle()](VkDescriptorSetLayout l) { vkDestroyDescriptorSetLayout(d, l, nullptr); }};

    const VkPushConstantRange range{VK_SHADER_STAGE_ALL, 0, desc.pushBytes};
    VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    info.setLayoutCount = 1;
    info.pSetLayouts = &setLayout;
    info.pushConstantRangeCount = desc.pushBytes > 0 ? 1 : 0;
    info.pPushConstantRanges = &range;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    checkVulkan(vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout), "vkCreatePipelineLayout");
    pipeline.layout = {layout, [d = device.handle()](VkPipelineLayout l) { vkDestroyPipelineLayout(d, l, nullptr); }};
}

void own(Device& device, Pipeline& pipeline, VkPipeline handle, const std::string& name) {
    pipeline.handle = {handle, [d = device.handle()](VkPipeline p) { vkDestroyPipeline(d, p, nullptr); }};
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
    raster.depthBiasEnable = desc.depthBias ? VK_TRUE : VK_FALSE;
    raster.depthBiasConstantFactor = 64;
    raster.depthBiasSlopeFactor = 2;
    return raster;
}

} // namespace

Pipeline makeGraphics(Device& device, const GraphicsDesc& desc) {
    Pipeline pipeline;
    makeLayout(device, desc.layout, pipeline);
    const Constants constants(desc.constants);
    std::vector<Owned<VkShaderModule>> modules;
    std::vector<VkPipelineShaderStageCreateInfo> stages;
    for (const Stage& stage : desc.stages) {
        modules.push_back(makeModule(device, stage.code));
        stages.push_back(stageInfo(stage.stage, modules.back().get(), constants));
    }

    const VkPipelineVertexInputStateCreateInfo noVertices{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
    VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
    assembly.topology = desc.topology;
    VkPipelineTessellationStateCreateInfo tessellation{VK_STRUCTURE_TYPE_PIPELINE_TESSELLATION_STATE_CREATE_INFO};
    tessellation.patchControlPoints = 1;
    VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
    viewport.viewportCount = viewport.scissorCount = 1;
    const VkPipelineRasterizationStateCreateInfo raster = rasterState(desc);
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
    const VkDynamicState states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
    VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = states;
    VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
    rendering.colorAttachmentCount = blend.attachmentCount;
    rendering.pColorAttachmentFormats = desc.colorFormats.data();
    rendering.depthAttachmentFormat = desc.depthFormat;

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
    checkVulkan(vkCreateGraphicsPipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &handle),
                "vkCreateGraphicsPipelines");
    own(device, pipeline, handle, desc.name);
    return pipeline;
}

Pipeline makeCompute(Device& device, const ComputeDesc& desc) {
    Pipeline pipeline;
    pipeline.bindPoint = VK_PIPELINE_BIND_POINT_COMPUTE;
    makeLayout(device, desc.layout, pipeline);
    const Constants constants(desc.constants);
    const Owned<VkShaderModule> module = makeModule(device, desc.stage.code);
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.stage = stageInfo(VK_SHADER_STAGE_COMPUTE_BIT, module.get(), constants);
    info.layout = pipeline.layout.get();
    VkPipeline handle = VK_NULL_HANDLE;
    checkVulkan(vkCreateComputePipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &handle),
                "vkCreateComputePipelines");
    own(device, pipeline, handle, desc.name);
    return pipeline;
}

BindingSet makeBindingSet(Device& device, const Pipeline& pipeline, const PipelineLayoutDesc& layoutDesc,
                          std::span<const Binding> bindings) {
    const auto count = std::uint32_t(bindings.size());
    std::vector<VkDescriptorPoolSize> sizes;
    for (const VkDescriptorType type : layoutDesc.bindings) sizes.push_back({type, 1});
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.maxSets = 1;
    info.poolSizeCount = std::uint32_t(sizes.size());
    info.pPoolSizes = sizes.data();
    VkDescriptorPool pool = VK_NULL_HANDLE;
    checkVulkan(vkCreateDescriptorPool(device.handle(), &info, nullptr, &pool), "vkCreateDescriptorPool");
    BindingSet set;
    set.pool = {pool, [d = device.handle()](VkDescriptorPool p) { vkDestroyDescriptorPool(d, p, nullptr); }};

    const VkDescriptorSetLayout layout = pipeline.setLayout.get();
    VkDescriptorSetAllocateInfo allocation{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    allocation.descriptorPool = pool;
    allocation.descriptorSetCount = 1;
    allocation.pSetLayouts = &layout;
    checkVulkan(vkAllocateDescriptorSets(device.handle(), &allocation, &set.handle), "vkAllocateDescriptorSets");

    std::vector<VkDescriptorImageInfo> images(count);
    std::vector<VkDescriptorBufferInfo> buffers(count);
    std::vector<VkWriteDescriptorSet> writes;
    for (std::uint32_t i = 0; i < count; ++i) {
        if (bindings[i].isEmpty()) continue; // the pipeline's shaders do not read it
        images[i] = {bindings[i].sampler, bindings[i].view, VK_IMAGE_LAYOUT_GENERAL};
        buffers[i] = {bindings[i].uniform, 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet& write = writes.emplace_back(VkWriteDescriptorSet{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET});
        write.dstSet = set.handle;
        write.dstBinding = i;
        write.descriptorCount = 1;
        write.descriptorType = layoutDesc.bindings[i];
        write.pImageInfo = &images[i];
        write.pBufferInfo = &buffers[i];
        write.pTexelBufferView = &bindings[i].texels;
    }
    vkUpdateDescriptorSets(device.handle(), std::uint32_t(writes.size()), writes.data(), 0, nullptr);
    return set;
}

void bind(VkCommandBuffer commands, const Pipeline& pipeline, const BindingSet& bindings) {
    vkCmdBindPipeline(commands, pipeline.bindPoint, pipeline.handle.get());
    vkCmdBindDescriptorSets(commands, pipeline.bindPoint, pipeline.layout.get(), 0, 1, &bindings.handle, 0, nullptr);
}

void push(VkCommandBuffer commands, const Pipeline& pipeline, std::span<const std::byte> bytes) {
    vkCmdPushConstants(commands, pipeline.layout.get(), VK_SHADER_STAGE_ALL, 0, std::uint32_t(bytes.size()),
                       bytes.data());
}

namespace {

Owned<VkQueryPool> makeQueries(Device& device, const VkQueryPoolCreateInfo& info) {
    VkQueryPool pool = VK_NULL_HANDLE;
    checkVulkan(vkCreateQueryPool(device.handle(), &info, nullptr, &pool), "vkCreateQueryPool");
    return {pool, [d = device.handle()](VkQueryPool p) { vkDestroyQueryPool(d, p, nullptr); }};
}

} // namespace

Timer::Timer(Device& device, std::uint32_t capacity) : device_(&device), capacity_(capacity) {
    if (device.traits().timestampNanoseconds == 0) return;
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = capacity;
    pool_ = makeQueries(device, info);
}

void Timer::reset(VkCommandBuffer commands) {
    count_ = 0;
    if (pool_.get() != VK_NULL_HANDLE) vkCmdResetQueryPool(commands, pool_.get(), 0, capacity_);
}

void Timer::stamp(VkCommandBuffer commands) {
    if (pool_.get() == VK_NULL_HANDLE || count_ == capacity_) return;
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_.get(), count_++);
}

std::vector<double> Timer::intervals() const {
    std::vector<double> intervals;
    if (pool_.get() == VK_NULL_HANDLE || count_ < 2) return intervals;
    std::vector<std::uint64_t> ticks(count_);
    checkVulkan(vkGetQueryPoolResults(device_->handle(), pool_.get(), 0, count_, count_ * sizeof(std::uint64_t),
                                      ticks.data(), sizeof(std::uint64_t),
                                      VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                "vkGetQueryPoolResults");
    for (std::uint32_t i = 1; i < count_; ++i)
        intervals.push_back(double(ticks[i] - ticks[i - 1]) * device_->traits().timestampNanoseconds * 1e-6);
    return intervals;
}

PipelineCounter::PipelineCounter(Device& device) : device_(&device) {
    if (!device.traits().countsPipeline) return;
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_PIPELINE_STATISTICS;
    info.queryCount = 1;
    info.pipelineStatistics = VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
                              VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT |
                              VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT |
                              VK_QUERY_PIPELINE_STATISTIC_CLIPPING_PRIMITIVES_BIT |
                              VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT;
    if (device.traits().hasTessellation)
        info.pipelineStatistics |= VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_CONTROL_SHADER_PATCHES_BIT |
                                   VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_EVALUATION_SHADER_INVOCATIONS_BIT;
    pool_ = makeQueries(device, info);
}

void PipelineCounter::begin(VkCommandBuffer commands) const {
    if (pool_.get() == VK_NULL_HANDLE) return;
    vkCmdResetQueryPool(commands, pool_.get(), 0, 1);
    vkCmdBeginQuery(commands, pool_.get(), 0, 0);
}

void PipelineCounter::end(VkCommandBuffer commands) const {
    if (pool_.get() != VK_NULL_HANDLE) vkCmdEndQuery(commands, pool_.get(), 0);
}

PipelineCounts PipelineCounter::counts() const {
    if (pool_.get() == VK_NULL_HANDLE) return {};
    std::uint64_t values[7] = {}; // in the order of the bits
    checkVulkan(vkGetQueryPoolResults(device_->handle(), pool_.get(), 0, 1, sizeof values, values, sizeof values,
                                      VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                "vkGetQueryPoolResults");
    return {.vertices = values[0],
            .primitives = values[1],
            .vertexCalls = values[2],
            .tessellationPatches = values[5],
            .tessellationCalls = values[6],
            .drawnPrimitives = values[3],
            .fragmentCalls = values[4]};
}

} // namespace relief
