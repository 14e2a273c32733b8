#include <algorithm>
#include <cstdlib>
#include <iostream>

#include "gpu/gpu.h"

namespace relief {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

// Past this the CPU driver's tessellated draws slow down with the square of their vertices (measured: `relief_bench
// split`).
constexpr std::uint32_t kLavapipeVerticesPerDraw = 5000;
// Measured with 10 M diced triangles: 50 MB beside the buffers at no cost; with 75,000 draws take 1.5 times as long.
constexpr std::uint32_t kLavapipeTrianglesInFlight = 131072;

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
    static_cast<std::vector<std::string>*>(user)->emplace_back(data->pMessage);
    std::cerr << "vulkan: " << data->pMessage << '\n';
    return VK_FALSE;
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo(std::vector<std::string>* messages) {
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

bool hasInstanceExtension(const char* name, const char* layer = nullptr) {
    std::uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(layer, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateInstanceExtensionProperties(layer, &count, extensions.data());
    return std::ranges::any_of(extensions, [&](const auto& e) { return std::string_view(e.extensionName) == name; });
}

VkInstance createInstance(bool validate, std::vector<std::string>* messages) {
    VkApplicationInfo app{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    app.pApplicationName = app.pEngineName = "relief";
    app.apiVersion = VK_API_VERSION_1_3;
    const VkValidationFeatureEnableEXT synchronization = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkDebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(messages);
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.pNext = &messenger;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &synchronization;

    std::vector<const char*> extensions;
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

bool hasExtension(VkPhysicalDevice physical, std::string_view name) {
    std::uint32_t count = 0;
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data());
    return std::ranges::any_of(extensions, [&](const auto& e) { return name == e.extensionName; });
}

DeviceTraits traitsOf(VkPhysicalDevice physical) {
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    properties.pNext = &driver;
    VkPhysicalDeviceSubgroupProperties subgroup{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    driver.pNext = &subgroup;
    vkGetPhysicalDeviceProperties2(physical, &properties);
    VkPhysicalDeviceFeatures features;
    vkGetPhysicalDeviceFeatures(physical, &features);
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);

    const VkPhysicalDeviceLimits& limits = properties.properties.limits;
    const std::uint32_t api = properties.properties.apiVersion;
    DeviceTraits traits;
    traits.name = properties.properties.deviceName;
    traits.driver = fmt::format("{} {}", driver.driverName, driver.driverInfo);
    traits.api =
        fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(api), VK_API_VERSION_MINOR(api), VK_API_VERSION_PATCH(api));
    traits.isCpu = properties.properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU;
    if (traits.isCpu) traits.smallGroup = std::max(subgroup.subgroupSize, 1u);
    traits.hasTessellation = features.tessellationShader == VK_TRUE;
    traits.hasWireframe = features.fillModeNonSolid == VK_TRUE;
    traits.maxTessellationLevel = traits.hasTessellation ? limits.maxTessellationGenerationLevel : 0;
    traits.hasVertexStores = features.vertexPipelineStoresAndAtomics == VK_TRUE;
    traits.hasTransformFeedback = hasExtension(physical, VK_EXT_TRANSFORM_FEEDBACK_EXTENSION_NAME);
    traits.maxTexelBufferElements = limits.maxTexelBufferElements;
    traits.maxImageSide = limits.maxImageDimension2D;
    traits.maxDrawIndirectCount = features.multiDrawIndirect == VK_TRUE ? limits.maxDrawIndirectCount : 1;
    traits.countsPipeline = features.pipelineStatisticsQuery == VK_TRUE;
    traits.timestampNanoseconds = limits.timestampComputeAndGraphics == VK_TRUE ? limits.timestampPeriod : 0;
    for (std::uint32_t i = 0; i < memory.memoryHeapCount; ++i)
        if ((memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT) != 0)
            traits.heapBytes = std::max<std::uint64_t>(traits.heapBytes, memory.memoryHeaps[i].size);
    if (driver.driverID == VK_DRIVER_ID_MESA_LLVMPIPE) {
        traits.tessellatedVerticesPerDraw = kLavapipeVerticesPerDraw;
        traits.meshTrianglesInFlight = kLavapipeTrianglesInFlight;
    }
    return traits;
}

/// The core 1.3 features that relief cannot do without.
struct NeededFeatures {
    VkPhysicalDeviceFeatures2 base{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceVulkan13Features v13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    NeededFeatures() { base.pNext = &v12, v12.pNext = &v13; }
    NeededFeatures(const NeededFeatures&) = delete;
    NeededFeatures& operator=(const NeededFeatures&) = delete;
};

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

/// RELIEF_VALIDATE=1 or 0; without it the build decides (on in the dev preset).
bool isAskedForByEnvironment() {
    const char* value = std::getenv("RELIEF_VALIDATE");
    return value != nullptr ? std::string_view(value) == "1" : RELIEF_VALIDATE_BY_DEFAULT != 0;
}

/// What a person can do about it; drivers and layers say little of memory that they could not get.
const char* hintFor(VkResult result) {
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
    case VK_ERROR_OUT_OF_DEVICE_MEMORY: return ": out of memory; try a lower --rate or a smaller --size";
    case VK_ERROR_DEVICE_LOST: return ": the device was lost";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return ": no Vulkan driver is installed (on Debian: apt-get install mesa-vulkan-drivers), or there is no "
               "memory to load it";
    case VK_ERROR_INITIALIZATION_FAILED:
    case VK_ERROR_LAYER_NOT_PRESENT:
    case VK_ERROR_UNKNOWN: return ": the driver cannot start; is there memory for it?";
    default: return "";
    }
}

} // namespace

void checkVulkan(VkResult result, const char* call) {
    if (result == VK_SUCCESS) return;
    fail(Failure::device, "{} failed with VkResult {}{}", call, int(result), hintFor(result));
}

std::vector<DeviceTraits> listDevices() {
    VkInstance instance = createInstance(false, nullptr);
    std::vector<DeviceTraits> list;
    for (VkPhysicalDevice physical : physicalDevices(instance)) list.push_back(traitsOf(physical));
    vkDestroyInstance(instance, nullptr);
    return list;
}

Device::Device(const DeviceDesc& desc) {
    try {
        makeInstance(desc.validate || isAskedForByEnvironment());
        pickPhysical(desc.name);
        makeDevice();
        makeCommands();
    } catch (...) {
        destroy();
        throw;
    }
}

Device::~Device() { destroy(); }

void Device::destroy() {
    if (device_ != VK_NULL_HANDLE) {
        vkDestroyFence(device_, fence_, nullptr);
        vkDestroyCommandPool(device_, pool_, nullptr);
        vkDestroyDevice(device_, nullptr);
    }
    if (messenger_ != VK_NULL_HANDLE) {
        auto end =
            PFN_vkDestroyDebugUtilsMessengerEXT(vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
        end(instance_, messenger_, nullptr);
    }
    if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

void Device::makeInstance(bool validate) {
    if (validate && !hasLayer(kValidationLayer))
        fail(Failure::device,
             "validation was asked for but {} is not installed (on Debian: apt-get install "
             "vulkan-validationlayers)",
             kValidationLayer);
    isValidating_ = validate;
    instance_ = createInstance(validate, messages_.get());
    if (!validate) return;
    auto make = PFN_vkCreateDebugUtilsMessengerEXT(vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    const VkDebugUtilsMessengerCreateInfoEXT info = messengerInfo(messages_.get());
    checkVulkan(make(instance_, &info, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
}

void Device::pickPhysical(const std::string& wanted) {
    std::vector<VkPhysicalDevice> devices = physicalDevices(instance_);
    std::erase_if(devices, [&](VkPhysicalDevice d) {
        return !isUsable(d) || traitsOf(d).name.find(wanted) == std::string::npos;
    });
    if (devices.empty())
        fail(Failure::device, "no Vulkan 1.3 device{}{} (relief info --devices lists what there is)",
             wanted.empty() ? "" : " whose name contains ", wanted);
    physical_ = *std::ranges::min_element(devices, {}, rank);
    traits_ = traitsOf(physical_);
    vkGetPhysicalDeviceMemoryProperties(physical_, &memory_);
}

void Device::makeDevice() {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical_, &count, families.data());
    constexpr VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    const auto family = std::ranges::find_if(families, [](const auto& f) { return (f.queueFlags & needed) == needed; });
    if (family == families.end()) fail(Failure::device, "{} has no queue for graphics and compute", traits_.name);
    queueFamily_ = std::uint32_t(family - families.begin());

    VkPhysicalDeviceFeatures has;
    vkGetPhysicalDeviceFeatures(physical_, &has);
    NeededFeatures use;
    use.base.features.tessellationShader = has.tessellationShader;
    use.base.features.fillModeNonSolid = has.fillModeNonSolid;
    use.base.features.multiDrawIndirect = has.multiDrawIndirect;
    use.base.features.drawIndirectFirstInstance = has.drawIndirectFirstInstance;
    use.base.features.shaderInt64 = has.shaderInt64;
    use.base.features.pipelineStatisticsQuery = has.pipelineStatisticsQuery;
    use.base.features.vertexPipelineStoresAndAtomics = has.vertexPipelineStoresAndAtomics;
    // Optional: how certificates read tessellated triangles back.
    VkPhysicalDeviceTransformFeedbackFeaturesEXT feedback{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TRANSFORM_FEEDBACK_FEATURES_EXT};
    feedback.transformFeedback = VK_TRUE;
    const char* const extension = VK_EXT_TRANSFORM_FEEDBACK_EXTENSION_NAME;
    if (traits_.hasTransformFeedback) use.v13.pNext = &feedback;
    use.v12.bufferDeviceAddress = use.v12.scalarBlockLayout = VK_TRUE;
    use.v13.dynamicRendering = use.v13.synchronization2 = use.v13.maintenance4 = VK_TRUE;

    const float priority = 1;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = queueFamily_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = &use.base;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = traits_.hasTransformFeedback ? 1 : 0;
    info.ppEnabledExtensionNames = &extension;
    checkVulkan(vkCreateDevice(physical_, &info, nullptr, &device_), "vkCreateDevice");
    vkGetDeviceQueue(device_, queueFamily_, 0, &queue_);
    if (isValidating_)
        nameObject_ = PFN_vkSetDebugUtilsObjectNameEXT(vkGetDeviceProcAddr(device_, "vkSetDebugUtilsObjectNameEXT"));
}

void Device::makeCommands() {
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.flags = VK_COMMAND_POOL_CREATE_TRANSIENT_BIT;
    pool.queueFamilyIndex = queueFamily_;
    checkVulkan(vkCreateCommandPool(device_, &pool, nullptr, &pool_), "vkCreateCommandPool");
    const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    checkVulkan(vkCreateFence(device_, &fence, nullptr, &fence_), "vkCreateFence");
}

void Device::run(const std::function<void(VkCommandBuffer)>& record) {
    VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocation.commandPool = pool_;
    allocation.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    checkVulkan(vkAllocateCommandBuffers(device_, &allocation, &commands), "vkAllocateCommandBuffers");
    const Owned<VkCommandBuffer> owned(commands,
                                       [this](VkCommandBuffer c) { vkFreeCommandBuffers(device_, pool_, 1, &c); });

    VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    checkVulkan(vkBeginCommandBuffer(commands, &begin), "vkBeginCommandBuffer");
    record(commands);
    checkVulkan(vkEndCommandBuffer(commands), "vkEndCommandBuffer");

    VkCommandBufferSubmitInfo one{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    one.commandBuffer = commands;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &one;
    checkVulkan(vkQueueSubmit2(queue_, 1, &submit, fence_), "vkQueueSubmit2");
    checkVulkan(vkWaitForFences(device_, 1, &fence_, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    checkVulkan(vkResetFences(device_, 1, &fence_), "vkResetFences");
}

VkDeviceMemory Device::allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags, bool hasAddress) {
    std::uint32_t type = 0;
    while (type < memory_.memoryTypeCount &&
           ((needs.memoryTypeBits >> type & 1) == 0 || (memory_.memoryTypes[type].propertyFlags & flags) != flags))
        ++type;
    if (type == memory_.memoryTypeCount)
        fail(Failure::device, "{} has no memory of the kind {:#x}", traits_.name, flags);
    VkMemoryAllocateFlagsInfo addressable{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
    addressable.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
    VkMemoryAllocateInfo info{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
    if (hasAddress) info.pNext = &addressable;
    info.allocationSize = needs.size;
    info.memoryTypeIndex = type;
    VkDeviceMemory memory = VK_NULL_HANDLE;
    // Some drivers give more than there is, and are ended by the system when it is used.
    const bool isTooMuch = allocatedBytes_ + needs.size > traits_.heapBytes;
    const VkResult result =
        isTooMuch ? VK_ERROR_OUT_OF_DEVICE_MEMORY : vkAllocateMemory(device_, &info, nullptr, &memory);
    if (result == VK_ERROR_OUT_OF_DEVICE_MEMORY || result == VK_ERROR_OUT_OF_HOST_MEMORY)
        fail(Failure::device,
             "out of memory: {} more do not fit beside {} on {} ({}); try a lower --rate, a smaller map or --size",
             humanBytes(needs.size), humanBytes(allocatedBytes_), traits_.name, humanBytes(traits_.heapBytes));
    checkVulkan(result, "vkAllocateMemory");
    allocatedBytes_ += needs.size;
    peakBytes_ = std::max(peakBytes_, allocatedBytes_);
    return memory;
}

void Device::release(VkDeviceMemory memory, std::uint64_t bytes) {
    vkFreeMemory(device_, memory, nullptr);
    allocatedBytes_ -= bytes;
}

void Device::setName(VkObjectType type, std::uint64_t object, const std::string& name) const {
    if (nameObject_ == nullptr || name.empty()) return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = name.c_str();
    nameObject_(device_, &info);
}

} // namespace relief
