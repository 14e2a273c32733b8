#include <algorithm>
#include <cstring>

#include "gpu/gpu.h"

namespace relief {
namespace {

VkMemoryPropertyFlags flagsOf(MemoryUse use) {
    if (use == MemoryUse::device) return VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    return VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
}

Owned<VkDeviceMemory> allocateFor(Device& device, const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags,
                                  bool hasAddress) {
    return {device.allocate(needs, flags, hasAddress),
            [&device, bytes = needs.size](VkDeviceMemory m) { device.release(m, bytes); }};
}

VkImageSubresourceRange allMips(const TextureDesc& desc) {
    const bool isDepth = desc.format == VK_FORMAT_D32_SFLOAT || desc.format == VK_FORMAT_D16_UNORM;
    return {VkImageAspectFlags(isDepth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT), 0, desc.mipCount, 0,
            1};
}

Owned<VkImageView> makeView(Device& device, VkImage image, const TextureDesc& desc) {
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = image;
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = desc.format;
    info.subresourceRange = allMips(desc);
    VkImageView view = VK_NULL_HANDLE;
    checkVulkan(vkCreateImageView(device.handle(), &info, nullptr, &view), "vkCreateImageView");
    return {view, [d = device.handle()](VkImageView v) { vkDestroyImageView(d, v, nullptr); }};
}

void toGeneral(Device& device, VkImage image, const TextureDesc& desc) {
    device.run([&](VkCommandBuffer commands) {
        VkImageMemoryBarrier2 change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
        change.srcStageMask = change.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        change.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
        change.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
        change.newLayout = VK_IMAGE_LAYOUT_GENERAL;
        change.image = image;
        change.subresourceRange = allMips(desc);
        VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        info.imageMemoryBarrierCount = 1;
        info.pImageMemoryBarriers = &change;
        vkCmdPipelineBarrier2(commands, &info);
    });
}

} // namespace

Buffer makeBuffer(Device& device, const BufferDesc& desc) {
    Buffer buffer;
    buffer.bytes = std::max<std::uint64_t>(desc.bytes, 16);
    VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    info.size = buffer.bytes;
    info.usage = desc.usage | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT;
    VkBuffer handle = VK_NULL_HANDLE;
    checkVulkan(vkCreateBuffer(device.handle(), &info, nullptr, &handle), "vkCreateBuffer");
    buffer.handle = {handle, [d = device.handle()](VkBuffer b) { vkDestroyBuffer(d, b, nullptr); }};
    device.setName(VK_OBJECT_TYPE_BUFFER, std::uint64_t(handle), desc.name);

    VkMemoryRequirements needs;
    vkGetBufferMemoryRequirements(device.handle(), handle, &needs);
    buffer.memory = allocateFor(device, needs, flagsOf(desc.memory), true);
    checkVulkan(vkBindBufferMemory(device.handle(), handle, buffer.memory.get(), 0), "vkBindBufferMemory");
    VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    address.buffer = handle;
    buffer.address = vkGetBufferDeviceAddress(device.handle(), &address);
    if (desc.memory != MemoryUse::device)
        checkVulkan(vkMapMemory(device.handle(), buffer.memory.get(), 0, VK_WHOLE_SIZE, 0, &buffer.mapped),
                    "vkMapMemory");
    return buffer;
}

Buffer uploadBytes(Device& device, const BufferDesc& desc, std::span<const std::byte> data) {
    BufferDesc target = desc;
    target.usage |= VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    Buffer buffer = makeBuffer(device, target);
    if (data.empty()) return buffer;
    const Buffer staging = makeBuffer(device, {.name = desc.name + " staging",
                                               .bytes = data.size(),
                                               .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                               .memory = MemoryUse::upload});
    std::memcpy(staging.mapped, data.data(), data.size());
    device.run([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, data.size()};
        vkCmdCopyBuffer(commands, staging.handle.get(), buffer.handle.get(), 1, &region);
        barrier(commands);
    });
    return buffer;
}

namespace {

TexelBuffer viewed(Device& device, Buffer buffer, VkFormat format) {
    VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    info.buffer = buffer.handle.get();
    info.format = format;
    info.range = VK_WHOLE_SIZE;
    VkBufferView view = VK_NULL_HANDLE;
    checkVulkan(vkCreateBufferView(device.handle(), &info, nullptr, &view), "vkCreateBufferView");
    return {std::move(buffer), {view, [d = device.handle()](VkBufferView v) { vkDestroyBufferView(d, v, nullptr); }}};
}

BufferDesc asTexels(BufferDesc desc) {
    desc.usage |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT;
    return desc;
}

} // namespace

TexelBuffer makeTexels(Device& device, const BufferDesc& desc, VkFormat format) {
    return viewed(device, makeBuffer(device, asTexels(desc)), format);
}

TexelBuffer uploadTexels(Device& device, const BufferDesc& desc, VkFormat format, std::span<const std::byte> data) {
    BufferDesc sized = asTexels(desc);
    sized.bytes = data.size();
    return viewed(device, uploadBytes(device, sized, data), format);
}

void downloadBytes(Device& device, const Buffer& buffer, std::span<std::byte> data) {
    if (data.empty()) return;
    const Buffer staging = makeBuffer(device, {.name = "download",
                                               .bytes = data.size(),
                                               .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                               .memory = MemoryUse::readback});
    device.run([&](VkCommandBuffer commands) {
        const VkBufferCopy region{0, 0, data.size()};
        barrier(commands);
        vkCmdCopyBuffer(commands, buffer.handle.get(), staging.handle.get(), 1, &region);
        barrier(commands);
    });
    std::memcpy(data.data(), staging.mapped, data.size());
}

Texture makeTexture(Device& device, const TextureDesc& desc) {
    const std::uint32_t side = std::max(desc.width, desc.height);
    if (side > device.traits().maxImageSide)
        fail(Failure::device, "an image of {} x {} is larger than {} takes ({})", desc.width, desc.height,
             device.traits().name, device.traits().maxImageSide);
    Texture texture;
    texture.desc = desc;
    VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
    info.imageType = VK_IMAGE_TYPE_2D;
    info.format = desc.format;
    info.extent = {desc.width, desc.height, 1};
    info.mipLevels = desc.mipCount;
    info.arrayLayers = 1;
    info.samples = desc.samples;
    info.usage = desc.usage;
    VkImage handle = VK_NULL_HANDLE;
    checkVulkan(vkCreateImage(device.handle(), &info, nullptr, &handle), "vkCreateImage");
    texture.handle = {handle, [d = device.handle()](VkImage i) { vkDestroyImage(d, i, nullptr); }};
    device.setName(VK_OBJECT_TYPE_IMAGE, std::uint64_t(handle), desc.name);

    VkMemoryRequirements needs;
    vkGetImageMemoryRequirements(device.handle(), handle, &needs);
    texture.memory = allocateFor(device, needs, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, false);
    checkVulkan(vkBindImageMemory(device.handle(), handle, texture.memory.get(), 0), "vkBindImageMemory");
    texture.view = makeView(device, handle, desc);
    toGeneral(device, handle, desc);
    return texture;
}

Texture uploadTexture(Device& device, TextureDesc desc, std::span<const std::byte> mips, std::uint32_t texelBytes) {
    desc.usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    Texture texture = makeTexture(device, desc);
    const Buffer staging = makeBuffer(device, {.name = desc.name + " staging",
                                               .bytes = mips.size(),
                                               .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                               .memory = MemoryUse::upload});
    std::memcpy(staging.mapped, mips.data(), mips.size());
    std::vector<VkBufferImageCopy> regions(desc.mipCount);
    std::uint64_t offset = 0;
    for (std::uint32_t level = 0; level < desc.mipCount; ++level) {
        const std::uint32_t width = std::max(1u, desc.width >> level), height = std::max(1u, desc.height >> level);
        regions[level].bufferOffset = offset;
        regions[level].imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
        regions[level].imageExtent = {width, height, 1};
        offset += std::uint64_t(width) * height * texelBytes;
    }
    device.run([&](VkCommandBuffer commands) {
        vkCmdCopyBufferToImage(commands, staging.handle.get(), texture.handle.get(), VK_IMAGE_LAYOUT_GENERAL,
                               desc.mipCount, regions.data());
        barrier(commands);
    });
    return texture;
}

Owned<VkSampler> makeSampler(Device& device, const SamplerDesc& desc) {
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = desc.filter;
    info.mipmapMode = desc.filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    info.addressModeU = desc.wrapU;
    info.addressModeV = desc.wrapV;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    info.maxLod = VK_LOD_CLAMP_NONE;
    VkSampler sampler = VK_NULL_HANDLE;
    checkVulkan(vkCreateSampler(device.handle(), &info, nullptr, &sampler), "vkCreateSampler");
    return {sampler, [d = device.handle()](VkSampler s) { vkDestroySampler(d, s, nullptr); }};
}

void barrier(VkCommandBuffer commands) {
    VkMemoryBarrier2 all{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    all.srcStageMask = all.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT | VK_PIPELINE_STAGE_2_HOST_BIT;
    all.srcAccessMask = VK_ACCESS_2_MEMORY_WRITE_BIT;
    all.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.memoryBarrierCount = 1;
    info.pMemoryBarriers = &all;
    vkCmdPipelineBarrier2(commands, &info);
}

} // namespace relief
