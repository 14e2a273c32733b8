// Buffers, textures and samplers, and how bytes come to them and back.
#pragma once

#include <span>

#include "gpu/device.h"
#include "gpu/owned.h"

namespace relief {

struct MemoryBlock;

/// A range of a block of device memory.
struct MemoryRange {
    MemoryBlock* block = nullptr;
    std::uint64_t offset = 0, bytes = 0;

    bool operator==(const MemoryRange&) const = default;
};

/// The memory of one buffer or image, given back to the device's blocks when it ends: movable, never copied.
class Allocation {
public:
    Allocation() = default;
    Allocation(Device& device, const MemoryRange& range) : device_(&device), range_(range) {}
    ~Allocation() { reset(); }
    Allocation(Allocation&& other) noexcept
        : device_(std::exchange(other.device_, nullptr)), range_(std::exchange(other.range_, {})) {}
    Allocation& operator=(Allocation&& other) noexcept;
    [[nodiscard]] const MemoryRange& range() const { return range_; }

private:
    void reset();
    Device* device_ = nullptr;
    MemoryRange range_;
};

/// device: the fastest for the device; upload and readback: mapped, for the host to write or to read.
enum class MemoryUse { device, upload, readback };

struct BufferDesc {
    std::string name;
    std::uint64_t bytes = 0;
    VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    MemoryUse memory = MemoryUse::device;
};

struct Buffer {
    Allocation memory;
    Owned<VkBuffer> handle;
    VkDeviceAddress address = 0;
    void* mapped = nullptr;  ///< upload and readback buffers; coherent
    std::uint64_t bytes = 0; ///< at least 16
};

/// A buffer with an address and undefined content, of 16 bytes where fewer are asked for (empty arrays are bound too).
/// Throws Failure::device where the device's memory does not hold it, before the driver is asked: some give more than
/// there is.
Buffer makeBuffer(Device& device, const BufferDesc& desc);

/// A device buffer that holds `data` for all commands submitted from now on: the copy is made before the next
/// Device::submitAndWait(). `data` may end at once.
Buffer uploadBytes(Device& device, const BufferDesc& desc, std::span<const std::byte> data);

template <typename T>
Buffer uploadArray(Device& device, const std::string& name, std::span<const T> data,
                   VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
    return uploadBytes(device, {.name = name, .bytes = data.size_bytes(), .usage = usage}, std::as_bytes(data));
}

/// What a shader reads through one binding: an image with its sampler, a texel buffer or storage buffer (makeBindingSet
/// takes the one that the layout asks for), or a uniform buffer.
struct Binding {
    VkImageView view = VK_NULL_HANDLE;
    VkSampler sampler = VK_NULL_HANDLE;
    VkBufferView texels = VK_NULL_HANDLE;
    VkBuffer storage = VK_NULL_HANDLE;
    VkBuffer uniform = VK_NULL_HANDLE;

    [[nodiscard]] bool isEmpty() const {
        return view == VK_NULL_HANDLE && texels == VK_NULL_HANDLE && storage == VK_NULL_HANDLE &&
               uniform == VK_NULL_HANDLE;
    }
};

/// A table that shaders read as texels of a format or as a storage buffer (DeviceTraits::readsTablesAs).
struct TexelBuffer {
    Buffer buffer;
    /// Null where the device reads storage buffers and the table has more elements than a view may hold.
    Owned<VkBufferView> view;

    [[nodiscard]] Binding binding() const { return {.texels = view.get(), .storage = buffer.handle.get()}; }
};

/// A table of `desc.bytes` with undefined content.
/// Throws Failure::device where it is larger than the device reads in the way that it reads tables.
TexelBuffer makeTexels(Device& device, const BufferDesc& desc, VkFormat format);
/// The table that holds `data`; `desc.bytes` is ignored. Throws as makeTexels() does.
TexelBuffer uploadTexels(Device& device, const BufferDesc& desc, VkFormat format, std::span<const std::byte> data);

/// Copies the first bytes of a buffer made with VK_BUFFER_USAGE_TRANSFER_SRC_BIT to the host, and waits for it.
void downloadBytes(Device& device, const Buffer& buffer, std::span<std::byte> data);

/// Copies the first bytes of a buffer to the host as a part of other commands, which saves a wait.
class Download {
public:
    Download(Device& device, std::uint64_t bytes);
    /// Copies the first bytes of `buffer` after everything recorded so far.
    void record(VkCommandBuffer commands, const Buffer& buffer) const;
    /// What was copied, after the commands are done.
    [[nodiscard]] std::span<const std::byte> bytes() const;

private:
    Buffer staging_;
    std::uint64_t bytes_;
};

struct TextureDesc {
    std::string name;
    std::uint32_t width = 1, height = 1, mipCount = 1; ///< texels
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
};

/// An image that is in the GENERAL layout for all commands submitted after it was made.
struct Texture {
    Allocation memory;
    Owned<VkImage> handle;
    Owned<VkImageView> view;
    TextureDesc desc;
};

/// A texture with undefined content. Throws Failure::device for a side longer than DeviceTraits::maxImageSide and where
/// the device's memory does not hold it.
Texture makeTexture(Device& device, const TextureDesc& desc);

/// A texture that holds tightly packed mips, largest first, of `texelBytes` per texel: for all commands submitted from
/// now on, as uploadBytes().
Texture uploadTexture(Device& device, TextureDesc desc, std::span<const std::byte> mips, std::uint32_t texelBytes);

struct SamplerDesc {
    VkFilter filter = VK_FILTER_LINEAR;
    VkSamplerAddressMode wrapU = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    VkSamplerAddressMode wrapV = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    bool readsMips = true;
    float anisotropy = 1; ///< samples along the longest axis of a footprint, at most DeviceTraits::maxAnisotropy
};
Owned<VkSampler> makeSampler(Device& device, const SamplerDesc& desc);

/// Everything before is done and visible to everything after, the host included. Frames here are a few passes; one
/// barrier serves them all.
void barrier(VkCommandBuffer commands);

} // namespace relief
