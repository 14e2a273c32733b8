#include <algorithm>

#include "gpu/device_memory.h"
#include "gpu/uploads.h"

namespace relief {
namespace {

VkImageSubresourceRange allMips(const TextureDesc& desc) {
    const bool isDepth = desc.format == VK_FORMAT_D32_SFLOAT || desc.format == VK_FORMAT_D16_UNORM;
    return {VkImageAspectFlags(isDepth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT), 0, desc.mipCount, 0,
            1};
}

Owned<VkImageView> makeView(Device& device, const Texture& texture) {
    const TextureDesc& desc = texture.desc;
    VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    info.image = texture.handle.get();
    info.viewType = VK_IMAGE_VIEW_TYPE_2D;
    info.format = desc.format;
    info.subresourceRange = allMips(desc);
    VkImageView view = VK_NULL_HANDLE;
    checkVulkan(vkCreateImageView(device.handle(), &info, nullptr, &view), "vkCreateImageView");
    device.setName(VK_OBJECT_TYPE_IMAGE_VIEW, std::uint64_t(view), desc.name);
    return {device.handle(), view, vkDestroyImageView};
}

} // namespace

Texture makeTexture(Device& device, const TextureDesc& desc) {
    const std::uint32_t side = std::max(desc.width, desc.height);
    if (side > device.traits().maxImageSide)
        fail(Failure::device, "an image of {} x {} is larger than {} takes ({})", desc.width, desc.height,
             device.traits().name, device.traits().maxImageSide);

    // The image.
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
    texture.handle = {device.handle(), handle, vkDestroyImage};
    device.setName(VK_OBJECT_TYPE_IMAGE, std::uint64_t(handle), desc.name);

    // Its memory, its layout, which stays GENERAL, and its view.
    texture.memory = bindMemory<BlockContent::images>(device, handle, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                                      vkGetImageMemoryRequirements, vkBindImageMemory);
    device.uploads().toGeneral(texture, allMips(desc));
    texture.view = makeView(device, texture);
    return texture;
}

Texture uploadTexture(Device& device, TextureDesc desc, std::span<const std::byte> mips, std::uint32_t texelBytes) {
    desc.usage |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    Texture texture = makeTexture(device, desc);
    std::vector<VkBufferImageCopy> regions(desc.mipCount);
    std::uint64_t offset = 0;
    for (std::uint32_t level = 0; level < desc.mipCount; ++level) {
        const std::uint32_t width = std::max(1u, desc.width >> level), height = std::max(1u, desc.height >> level);
        regions[level].bufferOffset = offset;
        regions[level].imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
        regions[level].imageExtent = {width, height, 1};
        offset += std::uint64_t(width) * height * texelBytes;
    }
    RELIEF_CHECK(offset == mips.size());
    device.uploads().fill(texture, std::move(regions), mips);
    return texture;
}

Owned<VkSampler> makeSampler(Device& device, const SamplerDesc& desc) {
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = desc.filter;
    info.mipmapMode = desc.filter == VK_FILTER_LINEAR ? VK_SAMPLER_MIPMAP_MODE_LINEAR : VK_SAMPLER_MIPMAP_MODE_NEAREST;
    info.addressModeU = desc.wrapU;
    info.addressModeV = desc.wrapV;
    info.addressModeW = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    info.maxLod = desc.readsMips ? VK_LOD_CLAMP_NONE : 0;
    info.anisotropyEnable = desc.anisotropy > 1 ? VK_TRUE : VK_FALSE;
    info.maxAnisotropy = desc.anisotropy;
    VkSampler sampler = VK_NULL_HANDLE;
    checkVulkan(vkCreateSampler(device.handle(), &info, nullptr, &sampler), "vkCreateSampler");
    return {device.handle(), sampler, vkDestroySampler};
}

} // namespace relief
