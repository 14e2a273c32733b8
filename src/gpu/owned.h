// Vulkan handles with one owner each.
#pragma once

#include <utility>

#include <vulkan/vulkan.h>

namespace relief {

/// A handle of a device with the Vulkan function that destroys it: movable, never copied.
template <typename Handle>
class Owned {
public:
    using Destroy = void(VKAPI_PTR*)(VkDevice, Handle, const VkAllocationCallbacks*);

    Owned() = default;
    Owned(VkDevice device, Handle handle, Destroy destroy) : device_(device), handle_(handle), destroy_(destroy) {}
    ~Owned() { reset(); }
    Owned(Owned&& other) noexcept
        : device_(other.device_), handle_(std::exchange(other.handle_, Handle{})), destroy_(other.destroy_) {}
    Owned& operator=(Owned&& other) noexcept {
        if (this != &other) {
            reset();
            device_ = other.device_;
            handle_ = std::exchange(other.handle_, Handle{});
            destroy_ = other.destroy_;
        }
        return *this;
    }
    [[nodiscard]] Handle get() const { return handle_; }

private:
    void reset() {
        if (handle_ != Handle{}) destroy_(device_, std::exchange(handle_, Handle{}), nullptr);
    }
    VkDevice device_ = VK_NULL_HANDLE;
    Handle handle_{};
    Destroy destroy_ = nullptr;
};

} // namespace relief
