#include <algorithm>
#include <cstdlib>

#include "gpu/background_tasks.h"
#include "gpu/descriptor_pools.h"
#include "gpu/device_memory.h"
#include "gpu/physical.h"
#include "gpu/pipeline_cache.h"
#include "gpu/uploads.h"

namespace relief {
namespace {

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
    case VK_ERROR_DEVICE_LOST:
        return ": the device was lost; where it took too long, a lower --rate or a smaller --size helps";
    case VK_ERROR_SURFACE_LOST_KHR: return ": the window's surface was lost";
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
    for (VkPhysicalDevice physical : physicalDevices(instance)) list.push_back(readTraits(physical));
    vkDestroyInstance(instance, nullptr);
    return list;
}

Device::Device(const DeviceDesc& desc) {
    try {
        makeInstance(desc.validate || isAskedForByEnvironment(), desc);
        pickPhysical(desc);
        makeDevice();
        makeCommands();
        memory_ = std::make_unique<DeviceMemory>(*this);
        uploads_ = std::make_unique<PendingUploads>(*this);
        descriptorPools_ = std::make_unique<DescriptorPools>(*this);
        pipelineCache_ = std::make_unique<PipelineCache>(device_, physical_);
        backgroundTasks_ = std::make_unique<BackgroundTasks>();
    } catch (...) {
        destroy();
        throw;
    }
}

Device::~Device() { destroy(); }

void Device::destroy() {
    backgroundTasks_.reset(); // waits for pipelines in the making
    if (uploads_ != nullptr) uploads_->clear();
    uploads_.reset();
    pipelineCache_.reset();
    descriptorPools_.reset();
    memory_.reset();
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
    if (surface_ != VK_NULL_HANDLE) vkDestroySurfaceKHR(instance_, surface_, nullptr);
    if (instance_ != VK_NULL_HANDLE) vkDestroyInstance(instance_, nullptr);
}

void Device::makeInstance(bool validate, const DeviceDesc& desc) {
    if (validate && !hasLayer(kValidationLayer))
        fail(Failure::device,
             "validation was asked for but {} is not installed (on Debian: apt-get install "
             "vulkan-validationlayers)",
             kValidationLayer);
    isValidating_ = validate;
    messages_ = std::make_unique<MessageLog>();
    instance_ = createInstance(validate, messages_.get(), desc.surfaceExtensions);
    if (desc.makeSurface) surface_ = desc.makeSurface(instance_);
    if (!validate) return;
    auto make = PFN_vkCreateDebugUtilsMessengerEXT(vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
    const VkDebugUtilsMessengerCreateInfoEXT info = messengerInfo(messages_.get());
    checkVulkan(make(instance_, &info, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
}

void Device::pickPhysical(const DeviceDesc& desc) {
    std::vector<VkPhysicalDevice> devices = physicalDevices(instance_);
    std::erase_if(devices, [&](VkPhysicalDevice d) {
        return !isUsable(d) || readTraits(d).name.find(desc.name) == std::string::npos;
    });
    // A window is shown by those alone that present to its surface.
    const bool isAny = !devices.empty();
    if (surface_ != VK_NULL_HANDLE) std::erase_if(devices, [&](VkPhysicalDevice d) { return !findQueueFamily(d); });
    if (isAny && devices.empty())
        fail(Failure::device, "no Vulkan device presents to this display (it has no swapchain); relief render draws "
                              "without a window");
    if (devices.empty())
        fail(Failure::device, "no Vulkan 1.3 device{}{} (relief info --devices lists what there is)",
             desc.name.empty() ? "" : " whose name contains ", desc.name);
    physical_ = *std::ranges::min_element(devices, {}, rank);
    traits_ = readTraits(physical_, desc.maxTexelBufferElements);
}

bool Device::presents(VkPhysicalDevice physical, std::uint32_t family) const {
    VkBool32 presents = VK_FALSE;
    const bool isKnown = vkGetPhysicalDeviceSurfaceSupportKHR(physical, family, surface_, &presents) == VK_SUCCESS &&
                         presents == VK_TRUE;
    return isKnown && hasExtension(physical, VK_KHR_SWAPCHAIN_EXTENSION_NAME);
}

/// The first family of queues for graphics and compute, and for the window where there is one.
std::optional<std::uint32_t> Device::findQueueFamily(VkPhysicalDevice physical) const {
    std::uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    constexpr VkQueueFlags needed = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_COMPUTE_BIT;
    for (std::uint32_t i = 0; i < count; ++i)
        if ((families[i].queueFlags & needed) == needed && (surface_ == VK_NULL_HANDLE || presents(physical, i)))
            return i;
    return {};
}

void Device::makeDevice() {
    // One queue for everything: passes follow each other anyway.
    const std::optional<std::uint32_t> family = findQueueFamily(physical_);
    if (!family) fail(Failure::device, "{} has no queue for graphics and compute", traits_.name);
    queueFamily_ = *family;

    // Features of Vulkan 1.0 are used where the device has them; DeviceTraits says which.
    VkPhysicalDeviceFeatures has;
    vkGetPhysicalDeviceFeatures(physical_, &has);
    NeededFeatures use;
    use.base.features.tessellationShader = has.tessellationShader;
    use.base.features.samplerAnisotropy = has.samplerAnisotropy;
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
    std::vector<const char*> extensions;
    if (traits_.hasTransformFeedback) {
        use.v13.pNext = &feedback;
        extensions.push_back(VK_EXT_TRANSFORM_FEEDBACK_EXTENSION_NAME);
    }
    if (surface_ != VK_NULL_HANDLE) extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);

    // Required: devices without these are never picked (isUsable).
    use.v12.bufferDeviceAddress = use.v12.scalarBlockLayout = VK_TRUE;
    use.v12.shaderBufferInt64Atomics = traits_.hasLongAtomics ? VK_TRUE : VK_FALSE;
    use.v13.dynamicRendering = use.v13.synchronization2 = use.v13.maintenance4 = VK_TRUE;

    // The device, its queue, and what names its objects.
    const float priority = 1;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = queueFamily_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo info{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO};
    info.pNext = &use.base;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue;
    info.enabledExtensionCount = std::uint32_t(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    checkVulkan(vkCreateDevice(physical_, &info, nullptr, &device_), "vkCreateDevice");
    vkGetDeviceQueue(device_, queueFamily_, 0, &queue_);
    if (hasInstanceExtension(VK_EXT_DEBUG_UTILS_EXTENSION_NAME)) // then the instance was made with it
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

/// A command buffer that was recorded with a function and is freed when it ends.
class Device::Commands {
public:
    Commands(const Device& device, const std::function<void(VkCommandBuffer)>& record) : device_(device) {
        VkCommandBufferAllocateInfo allocation{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
        allocation.commandPool = device.pool_;
        allocation.commandBufferCount = 1;
        checkVulkan(vkAllocateCommandBuffers(device.device_, &allocation, &handle_), "vkAllocateCommandBuffers");
        try {
            VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
            begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
            checkVulkan(vkBeginCommandBuffer(handle_, &begin), "vkBeginCommandBuffer");
            record(handle_);
            checkVulkan(vkEndCommandBuffer(handle_), "vkEndCommandBuffer");
        } catch (...) {
            free();
            throw;
        }
    }
    ~Commands() { free(); }
    Commands(const Commands&) = delete;
    Commands& operator=(const Commands&) = delete;
    [[nodiscard]] VkCommandBuffer handle() const { return handle_; }

private:
    void free() const { vkFreeCommandBuffers(device_.device_, device_.pool_, 1, &handle_); }
    const Device& device_;
    VkCommandBuffer handle_ = VK_NULL_HANDLE;
};

void Device::submitAndWait(const std::function<void(VkCommandBuffer)>& record) {
    const Commands commands(*this, record);
    if (uploads_->isEmpty()) return submit({{commands.handle()}});
    // Recorded last, so that uploads made while `record` ran are among them; submitted first.
    const Commands uploads(*this, [&](VkCommandBuffer c) { uploads_->record(c); });
    submit({{uploads.handle(), commands.handle()}});
}

void Device::submitUploads() {
    if (uploads_->isEmpty()) return;
    const Commands uploads(*this, [&](VkCommandBuffer c) { uploads_->record(c); });
    submit({{uploads.handle()}});
}

/// All pending uploads are among `commands`.
void Device::submit(std::span<const VkCommandBuffer> commands) {
    std::vector<VkCommandBufferSubmitInfo> infos;
    for (const VkCommandBuffer each : commands)
        infos.push_back({.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO, .commandBuffer = each});
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = std::uint32_t(infos.size());
    submit.pCommandBufferInfos = infos.data();
    checkVulkan(vkQueueSubmit2(queue_, 1, &submit, fence_), "vkQueueSubmit2");
    ++submitCount_;
    checkVulkan(vkWaitForFences(device_, 1, &fence_, VK_TRUE, UINT64_MAX), "vkWaitForFences");
    checkVulkan(vkResetFences(device_, 1, &fence_), "vkResetFences");
    uploads_->clear();
}

std::vector<std::string> Device::validationMessages() const {
    backgroundTasks_->settle();
    const std::lock_guard lock(messages_->mutex);
    return messages_->lines;
}

std::uint64_t Device::allocatedBytes() const { return memory_->takenBytes() - uploads_->stagedBytes(); }
std::uint64_t Device::peakBytes() const { return memory_->peakBytes(); }
void Device::startPeak() { memory_->startPeak(); }
std::uint64_t Device::reservedBytes() const { return memory_->reservedBytes(); }

void Device::setName(VkObjectType type, std::uint64_t object, const std::string& name) const {
    if (nameObject_ == nullptr || name.empty()) return;
    VkDebugUtilsObjectNameInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_OBJECT_NAME_INFO_EXT};
    info.objectType = type;
    info.objectHandle = object;
    info.pObjectName = name.c_str();
    nameObject_(device_, &info);
}

} // namespace relief
