#include "frame/passes.h"

namespace relief {

Targets makeTargets(Device& device, const RendererDesc& desc) {
    const auto width = std::uint32_t(desc.width), height = std::uint32_t(desc.height);
    const auto shadowSide = std::uint32_t(desc.shadowSide);
    const auto samples = [&](const char* name, VkFormat format, VkImageUsageFlags usage) {
        return makeTexture(device, {.name = name,
                                    .width = width,
                                    .height = height,
                                    .format = format,
                                    .usage = usage | VK_IMAGE_USAGE_SAMPLED_BIT,
                                    .samples = VK_SAMPLE_COUNT_4_BIT});
    };
    Targets t;
    t.normals = samples("normals", kNormalFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    t.colors = samples("colors", kColorFormat, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
    t.depths = samples("depths", kDepthFormat, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
    t.picture = makeTexture(device, {.name = "picture",
                                     .width = width,
                                     .height = height,
                                     .format = kPictureFormat,
                                     .usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    t.shadow = makeTexture(device, {.name = "shadow",
                                    .width = shadowSide,
                                    .height = shadowSide,
                                    .format = kDepthFormat,
                                    .usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT});
    t.readback = makeBuffer(device, {.name = "picture",
                                     .bytes = std::uint64_t(width) * height * 8,
                                     .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                     .memory = MemoryUse::readback});
    return t;
}

} // namespace relief
