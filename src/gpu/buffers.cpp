#include <algorithm>

#include "gpu/device_memory.h"
#include "gpu/uploads.h"

namespace relief {
namespace {

VkMemoryPropertyFlags toFlags(MemoryUse use) {
    if (use == MemoryUse::device) return VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    return VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
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
    buffer.handle = {device.handle(), handle, vkDestroyBuffer};
    device.setName(VK_OBJECT_TYPE_BUFFER, std::uint64_t(handle), desc.name);

    buffer.memory = bindMemory<BlockContent::buffers>(device, handle, toFlags(desc.memory),
                                                      vkGetBufferMemoryRequirements, vkBindBufferMemory);
    VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
    address.buffer = handle;
    buffer.address = vkGetBufferDeviceAddress(device.handle(), &address);
    if (desc.memory != MemoryUse::device) buffer.mapped = device.memory().map(buffer.memory.range());
    return buffer;
}

Buffer uploadBytes(Device& device, const BufferDesc& desc, std::span<const std::byte> data) {
    RELIEF_CHECK(data.size() <= std::max<std::uint64_t>(desc.bytes, 16));
    BufferDesc target = desc;
    target.usage |= VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    Buffer buffer = makeBuffer(device, target);
    if (!data.empty()) device.uploads().fill(buffer, data);
    return buffer;
}

Download::Download(Device& device, std::uint64_t bytes)
    : staging_(makeBuffer(device, {.name = "download",
                                   .bytes = bytes,
                                   .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                   .memory = MemoryUse::readback})),
      bytes_(bytes) {}

void Download::record(VkCommandBuffer commands, const Buffer& buffer) const {
    RELIEF_CHECK(bytes_ <= buffer.bytes);
    const VkBufferCopy region{0, 0, bytes_};
    barrier(commands);
    if (bytes_ > 0) vkCmdCopyBuffer(commands, buffer.handle.get(), staging_.handle.get(), 1, &region);
    barrier(commands);
}

std::span<const std::byte> Download::bytes() const {
    return {static_cast<const std::byte*>(staging_.mapped), std::size_t(bytes_)};
}

void downloadBytes(Device& device, const Buffer& buffer, std::span<std::byte> data) {
    if (data.empty()) return;
    const Download download(device, data.size());
    device.submitAndWait([&](VkCommandBuffer commands) { download.record(commands, buffer); });
    std::ranges::copy(download.bytes(), data.begin());
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
