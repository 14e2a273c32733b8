#include "gpu/physical.h"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <iostream>
#include <mutex>

namespace relief {
namespace {

// Past this the CPU driver's tessellated draws slow down with the square of their vertices (measured: `relief_bench
// split`).
constexpr std::uint32_t kLavapipeVerticesPerDraw = 5000;
// Measured with 10 M triangles, diced or of grids: 50 MB beside the buffers at no cost; with 75,000 draws take 1.5
// times as long.
constexpr std::uint32_t kLavapipeTrianglesInFlight = 131072;

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    auto& log = *static_cast<MessageLog*>(user);
    const std::lock_guard lock(log.mutex); // pipelines are made by several threads
    log.lines.emplace_back(data->pMessage);
    std::cerr << "vulkan: " << data->pMessage << '\n';
    return VK_FALSE;
}

/// What DeviceTraits::maxTexelBufferElements is lowered to; the largest number where nobody asked.
std::uint32_t texelBufferElementsAsked(std::optional<std::uint32_t> asked) {
    const char* variable = "RELIEF_MAX_TEXEL_BUFFER_ELEMENTS";
    const char* text = std::getenv(variable);
    if (asked || text == nullptr) return asked.value_or(0xffffffffu);
    const std::string_view digits = text;
    std::uint32_t number = 0;
    const auto [end, error] = std::from_chars(digits.begin(), digits.end(), number);
    if (error != std::errc{} || end != digits.end() || number == 0)
        fail(Failure::usage, "{} is \"{}\", not a whole number above 0", variable, digits);
    return number;
}

} // namespace

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(MessageLog* messages) {
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = onMessage;
    info.pUserData = messages;
    return info;
}

bool hasLayer(const char* name) {
    std::uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    return std::ranges::any_of(layers, [&](const auto& l) { return std::string_view(l.layerName) == name; });
}

bool hasExtension(VkPhysicalDevice physical, std::string_view name) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data());
    return std::ranges::any_of(extensions, [&](const auto& e) { return name == e.extensionName; });
}

bool hasInstanceExtension(const char* name) {
    std::uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data());
    return std::ranges::any_of(extensions, [&](const auto& e) { return std::string_view(e.extensionName) == name; });
}

VkInstance createInstance(bool validate, MessageLog* messages, std::span<const char* const> surfaceExtensions) {
    VkApplicationInfo app{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    app.pApplicationName = app.pEngineName = "relief";
    app.apiVersion = VK_API_VERSION_1_3;

    // The messenger hangs off the creation, too, so that messages about it are not lost.
    const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(messages);
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.pNext = &messenger;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronization;

    // Debug utilities also give objects names for debuggers, so they are on wherever they exist.
    std::vector<const char*> extensions(surfaceExtensions.begin(), surfaceExtensions.end());
    if (validate) extensions.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    if (validate || hasInstanceExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME))
        extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &app;
    info.enabledExtensionCount = std::uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    if (validate) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kValidationLayer;
    }
    VkInstance instance = VK_NULL_HANDLE;
    checkVulkan(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
    return instance;
}

std::vector<VkPhysicalDevice> physicalDevices(VkInstance instance) {
    std::uint32_t count = 0;
    checkVulkan(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    checkVulkan(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
    return devices;
}

DeviceTraits readTraits(VkPhysicalDevice physical, std::optional<std::uint32_t> maxTexelBufferElements) {
    // What Vulkan says of the device.
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    properties.pNext = &driver;
    VkPhysicalDeviceSubgroupProperties subgroup{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    driver.pNext = &subgroup;
    vkGetPhysicalDeviceProperties2(physical, &properties);
    NeededFeatures has;
    vkGetPhysicalDeviceFeatures2(physical, &has.base);
    const VkPhysicalDeviceFeatures& features = has.base.features;
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);

    // Who it is.
    const VkPhysicalDeviceLimits& limits = properties.properties.limits;
    const std::uint32_t api = properties.properties.apiVersion;
    DeviceTraits traits;
    traits.name = properties.properties.deviceName;
    traits.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    traits.api =
        fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(api), VK_API_VERSION_MINOR(api), VK_API_VERSION_PATCH(api));
    traits.isCpu = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    if (traits.isCpu) traits.smallGroup = std::max(subgroup.subgroupSize, 1u);
    traits.hasSubgroupShuffle = (subgroup.supportedOperations & VK_SUBGROUP_FEATURE_SHUFFLE_BIT) != 0 &&
                                (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0;

    // Which paths it can draw by, and how shaders read tables.
    traits.hasTessellation = features.tessellationShader == VK_TRUE;
    traits.maxAnisotropy = features.samplerAnisotropy == VK_TRUE ? limits.maxSamplerAnisotropy : 1;
    traits.hasWireframe = features.fillModeNonSolid == VK_TRUE;
    traits.maxTessellationLevel = traits.hasTessellation ? limits.maxTessellationGenerationLevel : 0;
    traits.hasLongAtomics = features.shaderInt64 == VK_TRUE && has.v12.shaderBufferInt64Atomics == VK_TRUE;
    traits.hasVertexStores = features.vertexPipelineStoresAndAtomics == VK_TRUE;
    traits.hasTransformFeedback = hasExtension(physical, VK_EXT_TRANSFORM_FEEDBACK_EXTENSION_NAME);
    traits.maxTexelBufferElements =
        std::min(limits.maxTexelBufferElements, texelBufferElementsAsked(maxTexelBufferElements));
    traits.maxStorageBufferRange = limits.maxStorageBufferRange;
    traits.readsTablesAs = traits.maxTexelBufferElements < kEnoughTexelBufferElements ? TableAccess::storageBuffers
                                                                                      : TableAccess::texelBuffers;

    // Its limits.
    traits.maxImageSide = limits.maxImageDimension2D;
    traits.maxDrawIndirectCount = features.multiDrawIndirect == VK_TRUE ? limits.maxDrawIndirectCount : 1;
    traits.countsPipeline = features.pipelineStatisticsQuery == VK_TRUE;
    traits.timestampNanoseconds = limits.timestampComputeAndGraphics == VK_TRUE ? limits.timestampPeriod : 0;
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0)
            traits.heapBytes = std::max<std::uint64_t>(traits.heapBytes, memory.memoryHeaps[i].size);

    // Measured properties of one driver, which no query reports.
    if (driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE) {
        traits.tessellatedVerticesPerDraw = kLavapipeVerticesPerDraw;
        traits.meshTrianglesInFlight = kLavapipeTrianglesInFlight;
        traits.rastersFasterInCompute = traits.hasLongAtomics;
        traits.dicesFaster = true;
        traits.evaluatesInVertexStages = traits.readsTablesAs == TableAccess::texelBuffers;
    }
    return traits;
}

bool isUsable(VkPhysicalDevice physical) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    if (properties.apiVersion < VK_API_VERSION_1_3) return false;
    NeededFeatures has;
    vkGetPhysicalDeviceFeatures2(physical, &has.base);
    return has.v12.bufferDeviceAddress && has.v12.scalarBlockLayout && has.v13.dynamicRendering &&
           has.v13.synchronization2 && has.v13.maintenance4;
}

int rank(VkPhysicalDevice physical) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(physical, &properties);
    switch (properties.deviceType) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU: return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU: return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU: return 2;
    default: return 3;
    }
}

} // namespace relief
