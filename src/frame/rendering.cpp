#include "frame/rendering.h"

#include <algorithm>

namespace relief {

Rendering::Rendering(VkCommandBuffer commands, std::uint32_t trianglesInFlight, Targets targets)
    : commands_(commands), targets_(std::move(targets)), most_(trianglesInFlight), room_(most_) {
    begin();
    setViewport(commands, targets_.size.x, targets_.size.y);
}

void Rendering::begin() const {
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea = {{0, 0}, {targets_.size.x, targets_.size.y}};
    info.layerCount = 1;
    info.colorAttachmentCount = std::uint32_t(targets_.colors.size());
    info.pColorAttachments = targets_.colors.data();
    info.pDepthAttachment = targets_.depth ? &*targets_.depth : nullptr;
    vkCmdBeginRendering(commands_, &info);
}

void Rendering::end() {
    vkCmdEndRendering(commands_);
    barrier(commands_);
}

void Rendering::restart() {
    end();
    for (VkRenderingAttachmentInfo& color : targets_.colors) color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    if (targets_.depth) targets_.depth->loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    begin();
    room_ = most_;
}

void Rendering::drawMesh(std::uint32_t first, std::uint32_t count) {
    while (count > 0) {
        if (room_ == 0) restart();
        const std::uint32_t part = std::min(count, room_);
        vkCmdDrawIndexed(commands_, 3 * part, 1, 3 * first, 0, 0);
        first += part, count -= part, room_ -= part;
    }
}

void Rendering::drawGrids(std::uint32_t trianglesEach, std::uint32_t first, std::uint32_t count) {
    while (count > 0) {
        if (room_ < std::min(trianglesEach, most_)) restart();
        const std::uint32_t part = std::clamp(room_ / trianglesEach, 1u, count);
        vkCmdDrawIndexed(commands_, 3 * trianglesEach, part, 0, 0, first);
        first += part, count -= part, room_ -= std::min(room_, part * trianglesEach);
    }
}

} // namespace relief
