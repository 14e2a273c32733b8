#include "gpu/descriptor_pools.h"

namespace relief {
namespace {

// Descriptors of each kind for each set of a pool: as many as a set of the widest layout has.
constexpr VkDescriptorPoolSize kPerSet[] = {{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 2},
                                            {VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 24},
                                            {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, 24},
                                            {VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 12}};

void failWithoutView(const Device& device, std::uint32_t binding) {
    fail(Failure::device, "the table of binding {} has more elements than a texel buffer of {} may have ({})", binding,
         device.traits().name, device.traits().maxTexelBufferElements);
}

} // namespace

std::shared_ptr<DescriptorPool> DescriptorPools::makePool() const {
    std::vector<VkDescriptorPoolSize> sizes(std::begin(kPerSet), std::end(kPerSet));
    for (VkDescriptorPoolSize& size : sizes) size.descriptorCount *= DescriptorPool::kSets;
    VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
    info.maxSets = DescriptorPool::kSets;
    info.poolSizeCount = std::uint32_t(sizes.size());
    info.pPoolSizes = sizes.data();
    VkDescriptorPool handle = VK_NULL_HANDLE;
    checkVulkan(vkCreateDescriptorPool(device_.handle(), &info, nullptr, &handle), "vkCreateDescriptorPool");
    auto pool = std::make_shared<DescriptorPool>();
    pool->handle = {device_.handle(), handle, vkDestroyDescriptorPool};
    return pool;
}

/// A set without a handle where the pool has no room.
BindingSet DescriptorPools::allocateFrom(const std::shared_ptr<DescriptorPool>& pool,
                                         VkDescriptorSetLayout layout) const {
    BindingSet set;
    if (pool->isFull) return set;
    VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
    info.descriptorPool = pool->handle.get();
    info.descriptorSetCount = 1;
    info.pSetLayouts = &layout;
    const VkResult result = vkAllocateDescriptorSets(device_.handle(), &info, &set.handle);
    if (result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL) {
        pool->isFull = true;
        return {};
    }
    checkVulkan(result, "vkAllocateDescriptorSets");
    // Counted here: drivers need not.
    pool->isFull = ++pool->setCount == DescriptorPool::kSets;
    set.pool = pool;
    return set;
}

BindingSet DescriptorPools::allocate(VkDescriptorSetLayout layout) {
    for (const std::shared_ptr<DescriptorPool>& pool : pools_) {
        if (pool.use_count() == 1 && pool->setCount > 0) { // all its sets have ended
            checkVulkan(vkResetDescriptorPool(device_.handle(), pool->handle.get(), 0), "vkResetDescriptorPool");
            pool->setCount = 0;
            pool->isFull = false;
        }
        if (BindingSet set = allocateFrom(pool, layout); set.pool != nullptr) return set;
    }
    pools_.push_back(makePool());
    BindingSet set = allocateFrom(pools_.back(), layout);
    RELIEF_CHECK(set.pool != nullptr);
    return set;
}

BindingSet makeBindingSet(Device& device, const Pipeline& pipeline, const PipelineLayoutDesc& layout,
                          std::span<const Binding> bindings) {
    RELIEF_CHECK(bindings.size() <= layout.bindings.size());
    BindingSet set = device.descriptorPools().allocate(pipeline.setLayout.get());

    // Writes point into these arrays, which therefore must not grow any more.
    const auto count = std::uint32_t(bindings.size());
    std::vector<VkDescriptorImageInfo> images(count);
    std::vector<VkDescriptorBufferInfo> buffers(count);
    std::vector<VkWriteDescriptorSet> writes;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Binding& binding = bindings[i];
        if (binding.isEmpty()) continue; // the pipeline's shaders do not read it
        const VkDescriptorType type = layout.bindings[i];
        if (type == VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER && binding.texels == VK_NULL_HANDLE)
            failWithoutView(device, i);
        // Vulkan reads the one of the three that the type asks for.
        images[i] = {binding.sampler, binding.view, VK_IMAGE_LAYOUT_GENERAL};
        buffers[i] = {type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER ? binding.storage : binding.uniform, 0, VK_WHOLE_SIZE};
        VkWriteDescriptorSet& write = writes.emplace_back(VkWriteDescriptorSet{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET});
        write.dstSet = set.handle;
        write.dstBinding = i;
        write.descriptorCount = 1;
        write.descriptorType = type;
        write.pImageInfo = &images[i];
        write.pBufferInfo = &buffers[i];
        write.pTexelBufferView = &bindings[i].texels;
    }
    vkUpdateDescriptorSets(device.handle(), std::uint32_t(writes.size()), writes.data(), 0, nullptr);
    return set;
}

} // namespace relief
