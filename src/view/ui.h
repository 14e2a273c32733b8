// Internal: Dear ImGui in the window: its input, its look, its drawing by Vulkan.
#pragma once

#include "gpu/gpu.h"
#include "view/events.h"

namespace relief {

/// The one context of Dear ImGui of a process.
class Ui {
public:
    Ui(Device& device, const Swapchain& swapchain);
    ~Ui();
    Ui(const Ui&) = delete;
    Ui& operator=(const Ui&) = delete;

    /// Gives an event to the panels. Returns whether they take it, so that it is not for the picture.
    bool take(const Event& event);
    /// A frame in which panels are made follows; `seconds` since the one before.
    void begin(std::uint32_t width, std::uint32_t height, double seconds);
    /// Ends the frame that begin() started.
    void end();
    /// Draws the panels of the latest frame.
    void draw(VkCommandBuffer commands);
    /// Whether a text field has the keys.
    [[nodiscard]] bool wantsText() const;
    [[nodiscard]] bool isDragging() const; ///< a slider or a window

private:
    Device& device_;
    VkDescriptorPool pool_ = VK_NULL_HANDLE;
    std::vector<int> released_; ///< keys that are up from the next frame on
};

} // namespace relief
