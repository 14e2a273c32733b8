#include "gpu/memory.h"

namespace relief {
namespace {

/// Bytes of one texel of the formats that tables have.
std::uint64_t texelBytes(VkFormat format) {
    switch (format) {
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SFLOAT: return 4;
    case VK_FORMAT_R32G32_UINT:
    case VK_FORMAT_R32G32_SFLOAT: return 8;
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT: return 16;
    default: fail(Failure::internal, "VkFormat {} is not one of tables", int(format));
    }
}

/// Adds both usages, so that a buffer does not depend on how the device reads tables.
BufferDesc toTableDesc(BufferDesc desc) {
    desc.usage |= VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    return desc;
}

void checkTableSize(const DeviceTraits& traits, const BufferDesc& desc, VkFormat format) {
    const std::uint64_t elements = desc.bytes / texelBytes(format);
    if (traits.readsTablesAs == TableAccess::texelBuffers && elements > traits.maxTexelBufferElements)
        fail(Failure::device, "{}: {} elements are more than {} reads as one table ({})", desc.name, elements,
             traits.name, traits.maxTexelBufferElements);
    if (traits.readsTablesAs == TableAccess::storageBuffers && desc.bytes > traits.maxStorageBufferRange)
        fail(Failure::device, "{}: {} are more than {} reads as one table ({})", desc.name, humanBytes(desc.bytes),
             traits.name, humanBytes(traits.maxStorageBufferRange));
}

TexelBuffer withView(Device& device, Buffer buffer, const std::string& name, VkFormat format) {
    TexelBuffer table{std::move(buffer), {}};
    if (table.buffer.bytes / texelBytes(format) > device.traits().maxTexelBufferElements) return table;
    VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
    info.buffer = table.buffer.handle.get();
    info.format = format;
    info.range = VK_WHOLE_SIZE;
    VkBufferView view = VK_NULL_HANDLE;
    checkVulkan(vkCreateBufferView(device.handle(), &info, nullptr, &view), "vkCreateBufferView");
    device.setName(VK_OBJECT_TYPE_BUFFER_VIEW, std::uint64_t(view), name);
    table.view = {device.handle(), view, vkDestroyBufferView};
    return table;
}

} // namespace

TexelBuffer makeTexels(Device& device, const BufferDesc& desc, VkFormat format) {
    checkTableSize(device.traits(), desc, format);
    return withView(device, makeBuffer(device, toTableDesc(desc)), desc.name, format);
}

TexelBuffer uploadTexels(Device& device, const BufferDesc& desc, VkFormat format, std::span<const std::byte> data) {
    BufferDesc sized = toTableDesc(desc);
    sized.bytes = data.size();
    checkTableSize(device.traits(), sized, format);
    return withView(device, uploadBytes(device, sized, data), desc.name, format);
}

} // namespace relief
