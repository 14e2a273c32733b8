// A Vulkan layer that makes calls fail: what no driver does on request. RELIEF_FAULT="vkQueueSubmit2 5 -4" gives the
// fifth vkQueueSubmit2 of the process that VkResult instead of its own; after VK_ERROR_DEVICE_LOST the device stays
// lost.
#include <cstdlib>
#include <map>
#include <mutex>
#include <sstream>
#include <string>
#include <string_view>

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace {

struct Fault {
    std::string call;
    int countdown = 0; ///< the call that makes it 0 fails
    int result = VK_SUCCESS;
};

Fault readFault() {
    Fault fault;
    if (const char* text = std::getenv("RELIEF_FAULT"))
        std::istringstream(text) >> fault.call >> fault.countdown >> fault.result;
    return fault;
}

/// What lies below this layer, for each instance and device; their objects begin with the same pointer.
struct State {
    std::mutex mutex;
    Fault fault = readFault();
    bool isLost = false;
    std::map<const void*, PFN_vkGetInstanceProcAddr> instances;
    std::map<const void*, std::pair<VkDevice, PFN_vkGetDeviceProcAddr>> devices;
};

State& state() {
    static State only;
    return only;
}

const void* keyOf(const void* object) { return *static_cast<const void* const*>(object); }

/// A device's or queue's function below this layer.
template <typename Function>
Function nextOf(const void* object, const char* name) {
    const std::lock_guard lock(state().mutex);
    const auto found = state().devices.find(keyOf(object));
    if (found == state().devices.end()) return nullptr;
    const auto& [device, find] = found->second;
    return reinterpret_cast<Function>(find(device, name));
}

/// VK_SUCCESS: the call goes on.
VkResult resultOf(std::string_view call) {
    State& s = state();
    const std::lock_guard lock(s.mutex);
    if (s.isLost) return VK_ERROR_DEVICE_LOST;
    if (call != s.fault.call || --s.fault.countdown != 0) return VK_SUCCESS;
    s.isLost = s.fault.result == VK_ERROR_DEVICE_LOST;
    return VkResult(s.fault.result);
}

// --- calls that fail ------------------------------------------------------------------------------------------------

VKAPI_ATTR VkResult VKAPI_CALL submit(VkQueue queue, std::uint32_t count, const VkSubmitInfo2* infos, VkFence fence) {
    if (const VkResult result = resultOf("vkQueueSubmit2"); result != VK_SUCCESS) return result;
    return nextOf<PFN_vkQueueSubmit2>(queue, "vkQueueSubmit2")(queue, count, infos, fence);
}

VKAPI_ATTR VkResult VKAPI_CALL waitForFences(VkDevice device, std::uint32_t count, const VkFence* fences, VkBool32 all,
                                             std::uint64_t timeout) {
    // The work is done all the same: what it reads must not end before it.
    const VkResult real = nextOf<PFN_vkWaitForFences>(device, "vkWaitForFences")(device, count, fences, all, timeout);
    const VkResult result = resultOf("vkWaitForFences");
    return result != VK_SUCCESS ? result : real;
}

VKAPI_ATTR VkResult VKAPI_CALL waitIdle(VkDevice device) {
    const VkResult real = nextOf<PFN_vkDeviceWaitIdle>(device, "vkDeviceWaitIdle")(device);
    const VkResult result = resultOf("vkDeviceWaitIdle");
    return result != VK_SUCCESS ? result : real;
}

VKAPI_ATTR VkResult VKAPI_CALL acquire(VkDevice device, VkSwapchainKHR chain, std::uint64_t timeout,
                                       VkSemaphore semaphore, VkFence fence, std::uint32_t* index) {
    if (const VkResult result = resultOf("vkAcquireNextImageKHR"); result != VK_SUCCESS) return result;
    return nextOf<PFN_vkAcquireNextImageKHR>(device, "vkAcquireNextImageKHR")(device, chain, timeout, semaphore, fence,
                                                                              index);
}

VKAPI_ATTR VkResult VKAPI_CALL present(VkQueue queue, const VkPresentInfoKHR* info) {
    const VkResult real = nextOf<PFN_vkQueuePresentKHR>(queue, "vkQueuePresentKHR")(queue, info);
    const VkResult result = resultOf("vkQueuePresentKHR");
    return result != VK_SUCCESS ? result : real;
}

// --- the chain of layers --------------------------------------------------------------------------------------------

/// The structure of a list of extensions in which the loader says what lies below a layer.
template <typename Info>
Info* findLink(const void* chain, VkStructureType type) {
    auto* info = static_cast<Info*>(const_cast<void*>(chain));
    while (info != nullptr && (info->sType != type || info->function != VK_LAYER_LINK_INFO))
        info = static_cast<Info*>(const_cast<void*>(info->pNext));
    return info;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info, const VkAllocationCallbacks* allocator,
                                              VkInstance* instance) {
    auto* link = findLink<VkLayerInstanceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    const PFN_vkGetInstanceProcAddr find = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto make = reinterpret_cast<PFN_vkCreateInstance>(find(nullptr, "vkCreateInstance"));
    const VkResult result = make(info, allocator, instance);
    const std::lock_guard lock(state().mutex);
    if (result == VK_SUCCESS) state().instances[keyOf(*instance)] = find;
    return result;
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkDevice* device) {
    auto* link = findLink<VkLayerDeviceCreateInfo>(info->pNext, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    const PFN_vkGetInstanceProcAddr findInInstance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr find = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const auto make = reinterpret_cast<PFN_vkCreateDevice>(findInInstance(nullptr, "vkCreateDevice"));
    const VkResult result = make(physical, info, allocator, device);
    const std::lock_guard lock(state().mutex);
    if (result == VK_SUCCESS) state().devices[keyOf(*device)] = {*device, find};
    return result;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name);
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name);

/// The function of this layer, or null.
PFN_vkVoidFunction findOwn(std::string_view name) {
    const std::pair<std::string_view, PFN_vkVoidFunction> own[] = {
        {"vkGetInstanceProcAddr", PFN_vkVoidFunction(getInstanceProcAddr)},
        {"vkGetDeviceProcAddr", PFN_vkVoidFunction(getDeviceProcAddr)},
        {"vkCreateInstance", PFN_vkVoidFunction(createInstance)},
        {"vkCreateDevice", PFN_vkVoidFunction(createDevice)},
        {"vkQueueSubmit2", PFN_vkVoidFunction(submit)},
        {"vkWaitForFences", PFN_vkVoidFunction(waitForFences)},
        {"vkDeviceWaitIdle", PFN_vkVoidFunction(waitIdle)},
        {"vkAcquireNextImageKHR", PFN_vkVoidFunction(acquire)},
        {"vkQueuePresentKHR", PFN_vkVoidFunction(present)}};
    for (const auto& [each, function] : own)
        if (each == name) return function;
    return nullptr;
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
    if (const PFN_vkVoidFunction own = findOwn(name)) return own;
    return nextOf<PFN_vkVoidFunction>(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
    if (const PFN_vkVoidFunction own = findOwn(name)) return own;
    if (instance == nullptr) return nullptr;
    const std::lock_guard lock(state().mutex);
    const auto found = state().instances.find(keyOf(instance));
    return found != state().instances.end() ? found->second(instance, name) : nullptr;
}

} // namespace

extern "C" VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* version) {
    version->loaderLayerInterfaceVersion = CURRENT_LOADER_LAYER_INTERFACE_VERSION;
    version->pfnGetInstanceProcAddr = getInstanceProcAddr;
    version->pfnGetDeviceProcAddr = getDeviceProcAddr;
    version->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
