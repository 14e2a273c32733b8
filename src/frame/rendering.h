// Internal: draws into cleared targets.
#pragma once

#include <optional>
#include <vector>

#include "gpu/gpu.h"

namespace relief {

inline VkRenderingAttachmentInfo attachment(const Texture& target) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = target.view.get();
    info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    return info; // cleared to zero: nothing, farthest depth
}

inline void setViewport(VkCommandBuffer commands, std::uint32_t width, std::uint32_t height) {
    const VkViewport viewport{0, 0, float(width), float(height), 0, 1};
    const VkRect2D scissor{{0, 0}, {width, height}};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
}

/// Cleared targets of one size, drawn over as a whole. A mesh of more triangles than the device should keep in flight
/// is drawn in parts with a barrier between them (DeviceTraits::meshTrianglesInFlight).
class Rendering {
public:
    struct Targets {
        std::vector<VkRenderingAttachmentInfo> colors;
        std::optional<VkRenderingAttachmentInfo> depth;
        uvec2 size;
    };
    Rendering(VkCommandBuffer commands, std::uint32_t trianglesInFlight, Targets targets);
    Rendering(const Rendering&) = delete;
    Rendering& operator=(const Rendering&) = delete;

    [[nodiscard]] VkCommandBuffer commands() const { return commands_; }
    /// Triangles of the bound indices; where they are more than the device should keep it finishes some in between.
    void drawMesh(std::uint32_t first, std::uint32_t count);
    /// Instances [first, first + count) of the first triangles of the bound indices, in as many draws.
    void drawGrids(std::uint32_t trianglesEach, std::uint32_t first, std::uint32_t count);
    void end();

private:
    void begin() const;
    void restart(); ///< when all that was drawn is done

    VkCommandBuffer commands_;
    Targets targets_;
    std::uint32_t most_, room_; ///< triangles until the next wait
};

} // namespace relief
