// Internal: device memory in blocks that many buffers or images share.
#pragma once

#include <memory>

#include "gpu/free_ranges.h"
#include "gpu/memory.h"

namespace relief {

/// Buffers and images never share a block, so that bufferImageGranularity does not matter.
enum class BlockContent { buffers, images };

/// One vkAllocateMemory.
struct MemoryBlock {
    VkDeviceMemory handle = VK_NULL_HANDLE;
    FreeRanges free;
    std::uint32_t type = 0;
    BlockContent content = BlockContent::buffers;
    bool isShared = true;   ///< else made for one buffer or image
    void* mapped = nullptr; ///< from when a mapped buffer is first placed in it
};

/// Places buffers and images in blocks. A block is as large as all shared blocks of its kind together, so that at most
/// half of what is reserved is unused after growing, between kSmallestBlock and kLargestBlock; what would fill more
/// than half of it gets an allocation of its own.
class DeviceMemory {
public:
    static constexpr std::uint64_t kSmallestBlock = 256 << 10, kLargestBlock = 16 << 20;

    explicit DeviceMemory(Device& device);
    ~DeviceMemory();
    DeviceMemory(const DeviceMemory&) = delete;
    DeviceMemory& operator=(const DeviceMemory&) = delete;

    /// Throws Failure::device where the heap does not hold `needs` beside what is taken, or the driver refuses.
    MemoryRange take(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags, BlockContent content);
    void giveBack(const MemoryRange& range);
    /// Maps the range for the host; only of memory taken with VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT.
    void* map(const MemoryRange& range);

    [[nodiscard]] std::uint64_t takenBytes() const { return takenBytes_; }
    [[nodiscard]] std::uint64_t peakBytes() const { return peakBytes_; }
    [[nodiscard]] std::uint64_t reservedBytes() const { return reservedBytes_; }
    [[nodiscard]] std::size_t blockCount() const { return blocks_.size(); }
    void startPeak() { peakBytes_ = takenBytes_; }

private:
    std::uint32_t typeOf(std::uint32_t allowedTypes, VkMemoryPropertyFlags flags) const;
    MemoryRange place(std::uint32_t type, BlockContent content, std::uint64_t bytes, std::uint64_t alignment);
    MemoryBlock* addBlock(std::uint32_t type, BlockContent content, std::uint64_t bytes, bool isShared);
    void endBlock(MemoryBlock* block);
    [[noreturn]] void failFull(std::uint64_t bytes) const;

    Device& device_;
    VkPhysicalDeviceMemoryProperties properties_{};
    std::vector<std::unique_ptr<MemoryBlock>> blocks_;
    std::uint64_t takenBytes_ = 0, peakBytes_ = 0, reservedBytes_ = 0;
};

/// Takes memory for a new buffer or image and binds it. `getNeeds` and `bind` are Vulkan's functions for its
/// kind. Throws as DeviceMemory::take().
template <BlockContent kContent, typename Handle, typename GetNeeds, typename Bind>
Allocation bindMemory(Device& device, Handle handle, VkMemoryPropertyFlags flags, GetNeeds getNeeds, Bind bind) {
    VkMemoryRequirements needs;
    getNeeds(device.handle(), handle, &needs);
    const MemoryRange range = device.memory().take(needs, flags, kContent);
    Allocation allocation(device, range);
    checkVulkan(bind(device.handle(), handle, range.block->handle, range.offset),
                kContent == BlockContent::buffers ? "vkBindBufferMemory" : "vkBindImageMemory");
    return allocation;
}

} // namespace relief
