// Front faces less back faces per pixel, by draws of the device and by the compute rasterizer.
#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/gtc/packing.hpp>

#include "frame/renderer_parts.h"

namespace relief {
namespace {

/// A half float that holds a whole number of at most 2048.
int toInt(std::uint16_t half) { return int(std::lround(glm::unpackHalf1x16(half))); }

} // namespace

std::vector<int> Renderer::Parts::crossingsOfDraws(Frame& frame) {
    // A target that adds signed numbers.
    makeSets(frame, DrawPass::cracks);
    const auto width = std::uint32_t(desc.width), height = std::uint32_t(desc.height);
    const Texture sums =
        makeTexture(device, {.name = "crossings",
                             .width = width,
                             .height = height,
                             .format = kCrackFormat,
                             .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    const Buffer read = makeBuffer(device, {.name = "crossings",
                                            .bytes = std::uint64_t(width) * height * 2,
                                            .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                            .memory = MemoryUse::readback});

    // One pass, copied to the host.
    device.submitAndWait([&](VkCommandBuffer commands) {
        writeInputs(commands, frame);
        Rendering rendering = begin(commands, frame, {{attachment(sums)}, {}, size()});
        draw(rendering, frame, DrawPass::cracks);
        rendering.end();
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {width, height, 1};
        vkCmdCopyImageToBuffer(commands, sums.handle.get(), VK_IMAGE_LAYOUT_GENERAL, read.handle.get(), 1, &region);
        barrier(commands);
    });
    const auto* halves = static_cast<const std::uint16_t*>(read.mapped);
    std::vector<int> crossings(std::size_t(width) * height);
    std::transform(halves, halves + crossings.size(), crossings.begin(), toInt);
    return crossings;
}

std::vector<int> Renderer::Parts::crossingsInCompute(Frame& frame) {
    constexpr VkBufferUsageFlags usage =
        VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    std::vector<int> crossings(std::size_t(desc.width) * std::size_t(desc.height));
    const Buffer sums = makeBuffer(device, {.name = "crossings", .bytes = crossings.size() * 4, .usage = usage});
    for (Drawn& drawn : frame.drawn) drawn.inputs.targets.crossings = sums.address;
    // This pass is not drawn again.
    const ListedTriangles drew = std::exchange(drawsListed, {.thin = true, .large = true});
    makeSets(frame, DrawPass::cracks);
    device.submitAndWait([&](VkCommandBuffer commands) {
        writeInputs(commands, frame);
        rasterize(commands, frame, {DrawPass::cracks, sums, size()});
    });
    drawsListed = drew;
    downloadBytes(device, sums, std::as_writable_bytes(std::span(crossings)));
    return crossings;
}

} // namespace relief
