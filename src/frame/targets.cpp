#include "frame/passes.h"

namespace relief {

SampleImages makeSampleImages(Device& device, const RendererDesc& desc) {
    const auto width = std::uint32_t(desc.width), height = std::uint32_t(desc.height);
    const auto samples = [&](const char* name, VkFormat format, VkImageUsageFlags usage) {
        return makeTexture(device, {.name = name,
                                    .width = width,
                                    .height = height,
                                    .format = format,
                                    .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT,
                                    .samples = VK_SAMPLE_COUNT_4_BIT});
    };
    // The G-buffer. Numbers of instances get their full size once a picture has several.
    SampleImages t;
    t.normals = samples("normals", kNormalFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    t.colors = samples("colors", kColorFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    t.depths = samples("depths", kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    t.instances = makeInstanceTarget(device, {.width = 1, .height = 1}, VK_SAMPLE_COUNT_4_BIT);
    return t;
}

Texture makeShadowImage(Device& device, const RendererDesc& desc) {
    const auto shadowSide = std::uint32_t(desc.shadowSide);
    return makeTexture(device, {.name = "shadow",
                                .width = shadowSide,
                                .height = shadowSide,
                                .format = kShadowFormat,
                                .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
}

SampleBuffers makeSampleBuffers(Device& device, const RendererDesc& desc) {
    constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    const std::uint64_t pixels = std::uint64_t(desc.width) * std::uint64_t(desc.height);
    const std::uint64_t texels = std::uint64_t(desc.shadowSide) * std::uint64_t(desc.shadowSide);
    SampleBuffers b;
    b.samples = makeTexels(device, {.name = "samples", .bytes = pixels * kSampleBytes, .usage = usage},
                           VK_FORMAT_R32G32B32A32_UINT);
    b.shadow = makeTexels(device, {.name = "shadow", .bytes = texels * 4, .usage = usage}, VK_FORMAT_R32_UINT);
    return b;
}

TexelBuffer makeSampleTable(Device& device, const RendererDesc& desc, const char* name, std::uint64_t pixelBytes) {
    const std::uint64_t pixels = std::uint64_t(desc.width) * std::uint64_t(desc.height);
    return makeTexels(device, {.name = name, .bytes = pixels * pixelBytes}, VK_FORMAT_R32G32B32A32_UINT);
}

Buffer makePictureBuffer(Device& device, const RendererDesc& desc) {
    const std::uint64_t pixels = std::uint64_t(desc.width) * std::uint64_t(desc.height);
    return makeBuffer(device, {.name = "picture", .bytes = pixels * 8, .memory = MemoryUse::readback});
}

Texture makeInstanceTarget(Device& device, const RendererDesc& desc, VkSampleCountFlagBits samples) {
    return makeTexture(device, {.name = "instances",
                                .width = std::uint32_t(desc.width),
                                .height = std::uint32_t(desc.height),
                                .format = kInstanceFormat,
                                .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT,
                                .samples = samples});
}

LayerTargets makeLayerTargets(Device& device, const RendererDesc& desc) {
    const auto width = std::uint32_t(desc.width), height = std::uint32_t(desc.height);
    const auto target = [&](const char* name, VkFormat format, VkImageUsageFlags usage) {
        return makeTexture(device, {.name = name,
                                    .width = width,
                                    .height = height,
                                    .format = format,
                                    .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT});
    };
    LayerTargets t;
    t.normals = target("layer normals", kLayerFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    t.surfacePoints = target("layer surface points", kLayerFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    t.depths = target("layer depths", kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    return t;
}

Buffer makeLayerBuffer(Device& device, const RendererDesc& desc) {
    const std::uint64_t pixels = std::uint64_t(desc.width) * std::uint64_t(desc.height);
    return makeBuffer(
        device, {.name = "layers", .bytes = pixels * kLayerChannels * sizeof(float), .memory = MemoryUse::readback});
}

} // namespace relief
