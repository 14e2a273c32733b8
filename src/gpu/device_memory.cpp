#include "gpu/device_memory.h"

#include <algorithm>

#include "gpu/uploads.h"

namespace relief {
namespace {

// A cache line; shaders take addresses of buffers to be multiples of 16.
constexpr std::uint64_t kLeastAlignment = 64;

// The largest unused block that is kept for the next buffers, one per kind: frames make and end small buffers.
constexpr std::uint64_t kLargestSpare = 1 << 20;

} // namespace

Allocation& Allocation::operator=(Allocation&& other) noexcept {
    if (this != &other) {
        reset();
        device_ = std::exchange(other.device_, nullptr);
        range_ = std::exchange(other.range_, {});
    }
    return *this;
}

void Allocation::reset() {
    if (device_ == nullptr) return;
    device_->uploads().forget(range_);
    std::exchange(device_, nullptr)->memory().giveBack(range_);
}

DeviceMemory::DeviceMemory(Device& device) : device_(device) {
    vkGetPhysicalDeviceMemoryProperties(device.physical(), &properties_);
}

DeviceMemory::~DeviceMemory() {
    for (const auto& block : blocks_) vkFreeMemory(device_.handle(), block->handle, nullptr);
}

std::uint32_t DeviceMemory::typeOf(std::uint32_t allowedTypes, VkMemoryPropertyFlags flags) const {
    for (std::uint32_t type = 0; type < properties_.memoryTypeCount; ++type)
        if ((allowedTypes >> type & 1) != 0 && (properties_.memoryTypes[type].propertyFlags & flags) == flags)
            return type;
    fail(Failure::device, "{} has no memory of the kind {:#x}", device_.traits().name, flags);
}

MemoryRange DeviceMemory::take(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags, BlockContent content) {
    const std::uint32_t type = typeOf(needs.memoryTypeBits, flags);
    // Some drivers give more than there is, and are ended by the system when it is used.
    if (takenBytes_ + needs.size > device_.traits().heapBytes) failFull(needs.size);
    const MemoryRange range = place(type, content, needs.size, std::max(needs.alignment, kLeastAlignment));
    takenBytes_ += range.bytes;
    peakBytes_ = std::max(peakBytes_, takenBytes_);
    return range;
}

MemoryRange DeviceMemory::place(std::uint32_t type, BlockContent content, std::uint64_t bytes,
                                std::uint64_t alignment) {
    std::uint64_t sharedBytes = 0;
    for (const auto& block : blocks_) {
        if (!block->isShared || block->type != type || block->content != content) continue;
        sharedBytes += block->free.size();
        if (const auto offset = block->free.take(bytes, alignment)) return {block.get(), *offset, bytes};
    }
    const std::uint64_t blockBytes = std::clamp(sharedBytes, kSmallestBlock, kLargestBlock);
    MemoryBlock* block = nullptr;
    if (bytes <= blockBytes / 2 && reservedBytes_ + blockBytes <= device_.traits().heapBytes)
        block = addBlock(type, content, blockBytes, true);
    // Where a whole block is refused there may still be room for what is needed.
    if (block == nullptr) block = addBlock(type, content, bytes, false);
    if (block == nullptr) failFull(bytes);
    return {block, block->free.take(bytes, alignment).value(), bytes};
}

/// Adds a block; null where the driver has no memory for it.
MemoryBlock* DeviceMemory::addBlock(std::uint32_t type, BlockContent content, std::uint64_t bytes, bool isShared) {
    VkMemoryAllocateFlagsInfo addressable{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    addressable.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    if (content == BlockContent::buffers) info.pNext = &addressable;
    info.allocationSize = bytes;
    info.memoryTypeIndex = type;
    VkDeviceMemory handle = VK_NULL_HANDLE;
    const VkResult result = vkAllocateMemory(device_.handle(), &info, nullptr, &handle);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY) return nullptr;
    checkVulkan(result, "vkAllocateMemory");
    device_.setName(VK_OBJECT_TYPE_DEVICE_MEMORY, std::uint64_t(handle),
                    content == BlockContent::buffers ? "buffers" : "images");
    reservedBytes_ += bytes;
    blocks_.push_back(std::make_unique<MemoryBlock>(MemoryBlock{
        .handle = handle, .free = FreeRanges(bytes), .type = type, .content = content, .isShared = isShared}));
    return blocks_.back().get();
}

void DeviceMemory::failFull(std::uint64_t bytes) const {
    fail(Failure::device,
         "out of memory: {} more do not fit beside {} on {} ({}); try a lower --rate, a smaller map or --size",
         humanBytes(bytes), humanBytes(takenBytes_), device_.traits().name, humanBytes(device_.traits().heapBytes));
}

void DeviceMemory::giveBack(const MemoryRange& range) {
    MemoryBlock* const block = range.block;
    block->free.giveBack(range.offset, range.bytes);
    takenBytes_ -= range.bytes;
    if (!block->free.isUnused()) return;
    const auto isSpare = [&](const auto& other) {
        return other.get() != block && other->isShared && other->free.isUnused() && other->type == block->type &&
               other->content == block->content;
    };
    const bool isKept =
        block->isShared && block->free.size() <= kLargestSpare && std::ranges::none_of(blocks_, isSpare);
    if (!isKept) endBlock(block);
}

void DeviceMemory::endBlock(MemoryBlock* block) {
    vkFreeMemory(device_.handle(), block->handle, nullptr); // which unmaps it
    reservedBytes_ -= block->free.size();
    std::erase_if(blocks_, [&](const auto& each) { return each.get() == block; });
}

void* DeviceMemory::map(const MemoryRange& range) {
    MemoryBlock& block = *range.block;
    if (block.mapped == nullptr)
        checkVulkan(vkMapMemory(device_.handle(), block.handle, 0, VK_WHOLE_SIZE, 0, &block.mapped), "vkMapMemory");
    return static_cast<std::byte*>(block.mapped) + range.offset;
}

} // namespace relief
