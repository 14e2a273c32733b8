#include "gpu/swapchain.h"

#include <algorithm>

#include "gpu/device.h"

namespace relief {
namespace {

Owned<VkSemaphore> makeSemaphore(const Device& device) {
    const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
    VkSemaphore semaphore = VK_NULL_HANDLE;
    checkVulkan(vkCreateSemaphore(device.handle(), &info, nullptr, &semaphore), "vkCreateSemaphore");
    return {device.handle(), semaphore, vkDestroySemaphore};
}

constexpr VkImageSubresourceRange kWholeImage{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};

/// Everything before is done, and the image has the new layout.
void changeLayout(VkCommandBuffer commands, VkImage image, VkImageLayout from, VkImageLayout to) {
    VkImageMemoryBarrier2 change{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    change.srcStageMask = change.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    change.srcAccessMask = change.dstAccessMask = VK_ACCESS_2_MEMORY_READ_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;
    change.oldLayout = from;
    change.newLayout = to;
    change.image = image;
    change.subresourceRange = kWholeImage;
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &change;
    vkCmdPipelineBarrier2(commands, &info);
}

} // namespace

Swapchain::Swapchain(Device& device, std::uint32_t width, std::uint32_t height) : device_(device) {
    chooseFormat();
    makeRenderPass();
    for (Slot& slot : slots_) slot = makeSlot();
    makeImages(width, height);
}

Swapchain::~Swapchain() { vkDeviceWaitIdle(device_.handle()); }

void Swapchain::chooseFormat() {
    std::uint32_t count = 0;
    checkVulkan(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), device_.surface(), &count, nullptr),
                "vkGetPhysicalDeviceSurfaceFormatsKHR");
    std::vector<VkSurfaceFormatKHR> formats(count);
    checkVulkan(vkGetPhysicalDeviceSurfaceFormatsKHR(device_.physical(), device_.surface(), &count, formats.data()),
                "vkGetPhysicalDeviceSurfaceFormatsKHR");
    // Codes are sRGB already: formats that encode them once more would show them too light.
    const auto showsCodes = [](const VkSurfaceFormatKHR& f) {
        return f.format == VK_FORMAT_B8G8R8A8_UNORM || f.format == VK_FORMAT_R8G8B8A8_UNORM;
    };
    const auto found = std::ranges::find_if(formats, showsCodes);
    if (found == formats.end())
        fail(Failure::device, "the window's surface has no format of 8-bit channels without encoding");
    format_ = *found;
}

void Swapchain::makeRenderPass() {
    VkAttachmentDescription color{};
    color.format = format_.format;
    color.samples = VK_SAMPLE_COUNT_1_BIT;
    color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    color.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
    color.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
    color.initialLayout = color.finalLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    const VkAttachmentReference reference{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
    VkSubpassDescription subpass{};
    subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
    subpass.colorAttachmentCount = 1;
    subpass.pColorAttachments = &reference;
    VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
    info.attachmentCount = 1;
    info.pAttachments = &color;
    info.subpassCount = 1;
    info.pSubpasses = &subpass;
    VkRenderPass pass = VK_NULL_HANDLE;
    checkVulkan(vkCreateRenderPass(device_.handle(), &info, nullptr, &pass), "vkCreateRenderPass");
    renderPass_ = {device_.handle(), pass, vkDestroyRenderPass};
}

void Swapchain::resize(std::uint32_t width, std::uint32_t height) {
    checkVulkan(vkDeviceWaitIdle(device_.handle()), "vkDeviceWaitIdle");
    images_.clear();
    makeImages(width, height);
}

void Swapchain::makeImages(std::uint32_t width, std::uint32_t height) {
    VkSurfaceCapabilitiesKHR can;
    checkVulkan(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_.physical(), device_.surface(), &can),
                "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
    // Most windows decide the size themselves; 0xffffffff means that the images do.
    extent_ = can.currentExtent;
    if (extent_.width == 0xffffffffu)
        extent_ = {std::clamp(width, can.minImageExtent.width, can.maxImageExtent.width),
                   std::clamp(height, can.minImageExtent.height, can.maxImageExtent.height)};
    extent_ = {std::max(extent_.width, 1u), std::max(extent_.height, 1u)};

    VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
    info.surface = device_.surface();
    info.minImageCount = std::max(can.minImageCount, 2u);
    if (can.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, can.maxImageCount);
    info.imageFormat = format_.format;
    info.imageColorSpace = format_.colorSpace;
    info.imageExtent = extent_;
    info.imageArrayLayers = 1;
    info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
    info.preTransform = can.currentTransform;
    info.compositeAlpha = (can.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0
                              ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                              : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
    info.presentMode = VK_PRESENT_MODE_FIFO_KHR;
    info.clipped = VK_TRUE;
    info.oldSwapchain = chain_.get();
    VkSwapchainKHR chain = VK_NULL_HANDLE;
    checkVulkan(vkCreateSwapchainKHR(device_.handle(), &info, nullptr, &chain), "vkCreateSwapchainKHR");
    chain_ = {device_.handle(), chain, vkDestroySwapchainKHR};

    std::uint32_t count = 0;
    checkVulkan(vkGetSwapchainImagesKHR(device_.handle(), chain, &count, nullptr), "vkGetSwapchainImagesKHR");
    std::vector<VkImage> handles(count);
    checkVulkan(vkGetSwapchainImagesKHR(device_.handle(), chain, &count, handles.data()), "vkGetSwapchainImagesKHR");
    for (const VkImage image : handles) images_.push_back(makeShown(image));
}

Swapchain::Shown Swapchain::makeShown(VkImage image) const {
    Shown shown{.image = image};
    VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
    view.image = image;
    view.viewType = VK_IMAGE_VIEW_TYPE_2D;
    view.format = format_.format;
    view.subresourceRange = kWholeImage;
    VkImageView handle = VK_NULL_HANDLE;
    checkVulkan(vkCreateImageView(device_.handle(), &view, nullptr, &handle), "vkCreateImageView");
    shown.view = {device_.handle(), handle, vkDestroyImageView};

    VkFramebufferCreateInfo target{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
    target.renderPass = renderPass_.get();
    target.attachmentCount = 1;
    target.pAttachments = &handle;
    target.width = extent_.width;
    target.height = extent_.height;
    target.layers = 1;
    VkFramebuffer framebuffer = VK_NULL_HANDLE;
    checkVulkan(vkCreateFramebuffer(device_.handle(), &target, nullptr, &framebuffer), "vkCreateFramebuffer");
    shown.framebuffer = {device_.handle(), framebuffer, vkDestroyFramebuffer};
    shown.isDrawn = makeSemaphore(device_);
    return shown;
}

void Swapchain::copy(VkCommandBuffer commands, const Texture& picture, VkExtent2D part, VkImage target) const {
    VkImageBlit region{};
    region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
    region.srcOffsets[1] = {std::int32_t(part.width), std::int32_t(part.height), 1};
    region.dstOffsets[1] = {std::int32_t(extent_.width), std::int32_t(extent_.height), 1};
    const bool isExact = part.width == extent_.width && part.height == extent_.height;
    vkCmdBlitImage(commands, picture.handle.get(), VK_IMAGE_LAYOUT_GENERAL, target,
                   VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region, isExact ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
}

Swapchain::Slot Swapchain::makeSlot() const {
    Slot slot;
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = device_.queueFamily();
    VkCommandPool poolHandle = VK_NULL_HANDLE;
    checkVulkan(vkCreateCommandPool(device_.handle(), &pool, nullptr, &poolHandle), "vkCreateCommandPool");
    slot.pool = {device_.handle(), poolHandle, vkDestroyCommandPool};
    VkCommandBufferAllocateInfo buffer{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    buffer.commandPool = poolHandle;
    buffer.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    buffer.commandBufferCount = 1;
    checkVulkan(vkAllocateCommandBuffers(device_.handle(), &buffer, &slot.commands), "vkAllocateCommandBuffers");

    // Signaled, as if a frame had ended: the first one does not wait.
    VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    fence.flags = VK_FENCE_CREATE_SIGNALED_BIT;
    VkFence fenceHandle = VK_NULL_HANDLE;
    checkVulkan(vkCreateFence(device_.handle(), &fence, nullptr, &fenceHandle), "vkCreateFence");
    slot.isDone = {device_.handle(), fenceHandle, vkDestroyFence};
    slot.isFree = makeSemaphore(device_);
    return slot;
}

void Swapchain::submit(const Slot& slot, const Shown& shown) const {
    const auto infoOf = [](VkSemaphore semaphore) {
        VkSemaphoreSubmitInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_SUBMIT_INFO};
        info.semaphore = semaphore;
        info.stageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
        return info;
    };
    const VkSemaphoreSubmitInfo waited = infoOf(slot.isFree.get()), signaled = infoOf(shown.isDrawn.get());
    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = slot.commands;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.waitSemaphoreInfoCount = submit.commandBufferInfoCount = submit.signalSemaphoreInfoCount = 1;
    submit.pWaitSemaphoreInfos = &waited;
    submit.pCommandBufferInfos = &commands;
    submit.pSignalSemaphoreInfos = &signaled;
    const VkFence fence = slot.isDone.get();
    checkVulkan(vkResetFences(device_.handle(), 1, &fence), "vkResetFences");
    checkVulkan(vkQueueSubmit2(device_.queue(), 1, &submit, fence), "vkQueueSubmit2");
}

bool Swapchain::show(const Texture& picture, VkExtent2D part, const std::function<void(VkCommandBuffer)>& drawOver) {
    // The frame before the last one has to be done: its command buffer and semaphore are used again.
    const Slot& slot = slots_[nextSlot_];
    const VkFence fence = slot.isDone.get();
    checkVulkan(vkWaitForFences(device_.handle(), 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    device_.submitUploads(); // before an image is acquired: it may throw
    std::uint32_t index = 0;
    const VkResult acquired =
        vkAcquireNextImageKHR(device_.handle(), chain_.get(), UINT64_MAX, slot.isFree.get(), VK_NULL_HANDLE, &index);
    if (acquired == VK_ERROR_OUT_OF_DATE_KHR) return false;
    if (acquired != VK_SUBOPTIMAL_KHR) checkVulkan(acquired, "vkAcquireNextImageKHR");
    const Shown& shown = images_[index];

    // The picture, what is drawn over it, and the layout that the window system reads.
    constexpr VkImageLayout drawn = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    VkCommandBuffer commands = slot.commands;
    VkCommandBufferBeginInfo once{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    once.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    checkVulkan(vkResetCommandPool(device_.handle(), slot.pool.get(), 0), "vkResetCommandPool");
    checkVulkan(vkBeginCommandBuffer(commands, &once), "vkBeginCommandBuffer");
    changeLayout(commands, shown.image, VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    copy(commands, picture, part, shown.image);
    changeLayout(commands, shown.image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, drawn);
    VkRenderPassBeginInfo begin{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
    begin.renderPass = renderPass_.get();
    begin.framebuffer = shown.framebuffer.get();
    begin.renderArea.extent = extent_;
    vkCmdBeginRenderPass(commands, &begin, VK_SUBPASS_CONTENTS_INLINE);
    drawOver(commands);
    vkCmdEndRenderPass(commands);
    changeLayout(commands, shown.image, drawn, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
    checkVulkan(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
    submit(slot, shown);
    nextSlot_ = (nextSlot_ + 1) % slots_.size();

    const VkSemaphore isDrawn = shown.isDrawn.get();
    const VkSwapchainKHR chain = chain_.get();
    VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
    info.waitSemaphoreCount = 1;
    info.pWaitSemaphores = &isDrawn;
    info.swapchainCount = 1;
    info.pSwapchains = &chain;
    info.pImageIndices = &index;
    const VkResult presented = vkQueuePresentKHR(device_.queue(), &info);
    if (presented == VK_ERROR_OUT_OF_DATE_KHR || presented == VK_SUBOPTIMAL_KHR) return false;
    checkVulkan(presented, "vkQueuePresentKHR");
    return acquired == VK_SUCCESS;
}

} // namespace relief
