// The images that a window shows.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "gpu/memory.h"

namespace relief {

/// Shows pictures in the window whose surface a device was made with. The host prepares a frame while the device draws
/// the one before.
class Swapchain {
public:
    /// `width`, `height`: of the window in pixels, at least 1.
    /// Throws Failure::device where the surface has no format of 8-bit channels that are shown as they are.
    Swapchain(Device& device, std::uint32_t width, std::uint32_t height);
    ~Swapchain();
    Swapchain(const Swapchain&) = delete;
    Swapchain& operator=(const Swapchain&) = delete;

    /// Makes its images anew, for a window of another size.
    void resize(std::uint32_t width, std::uint32_t height);

    /// Scales the upper left part of `picture`, of that many texels, to the whole window, draws over it with `drawOver`
    /// within renderPass(), and shows the result. An equal size keeps every texel's codes.
    /// Returns while the device draws: what writes `picture` afterwards is a later submission with a barrier before it,
    /// and what `drawOver` reads stays as it is until show() has returned true twice more, or resize() has returned.
    /// Returns false where the window has another size by now, so that nothing may have been shown.
    bool show(const Texture& picture, VkExtent2D part, const std::function<void(VkCommandBuffer)>& drawOver);

    [[nodiscard]] VkExtent2D extent() const { return extent_; }
    [[nodiscard]] VkRenderPass renderPass() const { return renderPass_.get(); } ///< one color attachment
    [[nodiscard]] std::uint32_t imageCount() const { return std::uint32_t(images_.size()); }

private:
    static constexpr std::size_t kFramesInFlight = 2;
    struct Slot {
        Owned<VkCommandPool> pool;
        VkCommandBuffer commands = VK_NULL_HANDLE;
        Owned<VkFence> isDone;
        Owned<VkSemaphore> isFree; ///< signaled when an image may be written
    };
    struct Shown {
        VkImage image = VK_NULL_HANDLE;
        Owned<VkImageView> view;
        Owned<VkFramebuffer> framebuffer;
        Owned<VkSemaphore> isDrawn;
    };
    void chooseFormat();
    void makeRenderPass();
    void makeImages(std::uint32_t width, std::uint32_t height);
    [[nodiscard]] Slot makeSlot() const;
    [[nodiscard]] Shown makeShown(VkImage image) const;
    void submit(const Slot& slot, const Shown& shown) const;
    void copy(VkCommandBuffer commands, const Texture& picture, VkExtent2D part, VkImage target) const;

    Device& device_;
    VkSurfaceFormatKHR format_{};
    VkExtent2D extent_{};
    Owned<VkRenderPass> renderPass_;
    Owned<VkSwapchainKHR> chain_;
    std::vector<Shown> images_;
    std::array<Slot, kFramesInFlight> slots_;
    std::size_t nextSlot_ = 0;
};

} // namespace relief
