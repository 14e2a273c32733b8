// Internal: the instance and what it says of physical devices.
#pragma once

#include <mutex>

#include "gpu/device.h"

namespace relief {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool hasLayer(const char* name);
bool hasInstanceExtension(const char* name);
bool hasExtension(VkPhysicalDevice physical, std::string_view name);

/// What the validation layer has said, on any thread.
struct MessageLog {
    std::mutex mutex;
    std::vector<std::string> lines;
};

/// A messenger that appends warnings and errors to `messages` and prints them to stderr.
VkDebugUtilsMessengerCreateInfoEXT messengerInfo(MessageLog* messages);

/// An instance with VK_EXT_debug_utils where there is one. `validate`: with the validation layer, which must be
/// installed; `messages` then gets what it says while the instance is made.
/// `surfaceExtensions`: those that a window's surface needs besides.
VkInstance createInstance(bool validate, MessageLog* messages, std::span<const char* const> surfaceExtensions = {});
std::vector<VkPhysicalDevice> physicalDevices(VkInstance instance);
/// `maxTexelBufferElements`: see DeviceDesc. Throws Failure::usage for a bad RELIEF_MAX_TEXEL_BUFFER_ELEMENTS.
DeviceTraits readTraits(VkPhysicalDevice physical, std::optional<std::uint32_t> maxTexelBufferElements = {});

/// The core 1.3 features that relief cannot do without.
struct NeededFeatures {
    VkPhysicalDeviceFeatures2 base{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    NeededFeatures() { base.pNext = &v12, v12.pNext = &v13; }
    NeededFeatures(const NeededFeatures&) = delete;
    NeededFeatures& operator=(const NeededFeatures&) = delete;
};

/// Whether relief can run on the device.
bool isUsable(VkPhysicalDevice physical);
/// The rank of a device for the default choice, lowest first: discrete GPUs before others, CPUs last.
int rank(VkPhysicalDevice physical);

} // namespace relief
