#include "gpu/uploads.h"

#include <cstring>

namespace relief {

void PendingUploads::toGeneral(const Texture& texture, const VkImageSubresourceRange& range) {
    VkImageMemoryBarrier2 change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    change.srcStageMask = change.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    change.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    change.oldLayout = VK_IMAGE_LAYOUT_UNDEFINED;
    change.newLayout = VK_IMAGE_LAYOUT_GENERAL;
    change.image = texture.handle.get();
    change.subresourceRange = range;
    images_.push_back({texture.memory.range(), change});
}

void PendingUploads::fill(const Buffer& target, std::span<const std::byte> data) {
    add({.target = target.memory.range(), .buffer = target.handle.get()}, data);
}

void PendingUploads::fill(const Texture& target, std::vector<VkBufferImageCopy> regions,
                          std::span<const std::byte> data) {
    add({.target = target.memory.range(), .image = target.handle.get(), .regions = std::move(regions)}, data);
}

void PendingUploads::add(Copy copy, std::span<const std::byte> data) {
    copy.bytes = data.size();
    copy.staging = makeBuffer(device_, {.name = "staging",
                                        .bytes = data.size(),
                                        .usage = VK_BUFFER_USAGE_TRANSFER_SRC_BIT,
                                        .memory = MemoryUse::upload});
    std::memcpy(copy.staging.mapped, data.data(), data.size());
    stagedBytes_ += copy.staging.memory.range().bytes;
    copies_.push_back(std::move(copy));
    if (stagedBytes_ > kMostStagedBytes) device_.submitUploads();
}

void PendingUploads::forget(const MemoryRange& target) {
    std::erase_if(images_, [&](const Image& image) { return image.target == target; });
    for (std::size_t i = copies_.size(); i-- > 0;) {
        if (copies_[i].target != target) continue;
        // Taken off the list before its staging buffer ends, because that calls this function, too.
        const Copy gone = std::move(copies_[i]);
        copies_.erase(copies_.begin() + std::ptrdiff_t(i));
        stagedBytes_ -= gone.staging.memory.range().bytes;
        return;
    }
}

void PendingUploads::record(VkCommandBuffer commands) const {
    // Nothing else is in flight: the host waits for every submission.
    std::vector<VkImageMemoryBarrier2> changes;
    for (const Image& image : images_) changes.push_back(image.change);
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = std::uint32_t(changes.size());
    info.pImageMemoryBarriers = changes.data();
    if (!changes.empty()) vkCmdPipelineBarrier2(commands, &info);

    for (const Copy& copy : copies_) {
        const VkBufferCopy all{0, 0, copy.bytes};
        if (copy.buffer != VK_NULL_HANDLE)
            vkCmdCopyBuffer(commands, copy.staging.handle.get(), copy.buffer, 1, &all);
        else
            vkCmdCopyBufferToImage(commands, copy.staging.handle.get(), copy.image, VK_IMAGE_LAYOUT_GENERAL,
                                   std::uint32_t(copy.regions.size()), copy.regions.data());
    }
    barrier(commands);
}

void PendingUploads::clear() {
    images_.clear();
    stagedBytes_ = 0;
    std::exchange(copies_, {}).clear();
}

} // namespace relief
