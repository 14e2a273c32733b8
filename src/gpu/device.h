// The device: what it can do, how commands run on it, how much of its memory is in use.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <vulkan/vulkan.h>

#include "base/base.h"

namespace relief {

class BackgroundTasks;
struct MessageLog;
class DescriptorPools;
class PipelineCache;
class DeviceMemory;
class PendingUploads;

/// Throws Failure::device with the call's name unless `result` is VK_SUCCESS.
void checkVulkan(VkResult result, const char* call);

struct DeviceDesc {
    std::string name;      ///< part of the device's name to prefer; empty: a discrete GPU before others, CPU last
    bool validate = false; ///< Khronos layer with synchronization validation; RELIEF_VALIDATE=1 turns it on as well
    /// Lowers DeviceTraits::maxTexelBufferElements to this, for tests of devices that read less. Unset: the environment
    /// variable RELIEF_MAX_TEXEL_BUFFER_ELEMENTS if it is set, else what the device states.
    std::optional<std::uint32_t> maxTexelBufferElements;
    /// For a window: the instance's extensions that its surface needs, and what makes the surface, which the device
    /// owns. Devices that cannot present to it are left out. Null: no window.
    std::vector<const char*> surfaceExtensions;
    std::function<VkSurfaceKHR(VkInstance)> makeSurface;
};

/// How shaders read tables of words and floats.
enum class TableAccess {
    texelBuffers,   ///< through formatted views: the faster way on the devices measured
    storageBuffers, ///< as arrays: where views may not hold enough elements
};

/// Texel buffers are used where a view may hold this many elements (16 million). Vulkan guarantees 65,536 only, which
/// the tables of a cage of some thousand faces exceed; desktop drivers state 2^27 or more, enough for every scene that
/// fits their memory. Devices between the two would fail on large scenes, so they read storage buffers.
constexpr std::uint32_t kEnoughTexelBufferElements = 1u << 24;

/// What callers ask before they choose a way to draw: properties, never #ifdefs.
struct DeviceTraits {
    std::string name, driver, api;
    bool isCpu = false;
    bool hasTessellation = false;
    bool hasWireframe = false; ///< fillModeNonSolid
    float maxAnisotropy = 1;   ///< of samplers; 1 without samplerAnisotropy
    bool hasTransformFeedback = false;
    bool hasLongAtomics = false; ///< 64-bit atomics on buffers: what the compute rasterizer writes with
    /// Compute shaders make samples of pixel-sized triangles faster than the fixed function: on Mesa's CPU driver in a
    /// quarter to a half of the time (`relief bench frame`). On GPUs it is not measured.
    bool rastersFasterInCompute = false;
    /// Diced meshes, of which each vertex is made once in a compute shader, are drawn faster than tessellated faces: on
    /// Mesa's CPU driver a render takes 0.7 of the processor time (octopus, one pixel per segment). On GPUs it is not
    /// measured.
    bool dicesFaster = false;
    bool hasVertexStores = false; ///< vertex stages may write to buffers
    std::uint32_t maxTessellationLevel = 0;
    std::uint32_t maxTexelBufferElements = 0; ///< of one texel buffer view
    std::uint64_t maxStorageBufferRange = 0;  ///< bytes of one storage buffer binding
    TableAccess readsTablesAs = TableAccess::texelBuffers;
    /// Vertex stages may evaluate surfaces. Mesa 22.3's CPU driver reads storage buffers wrong there, within branches
    /// and loops, in the last vertices of a draw that are fewer than its lanes: where it reads tables so, vertices are
    /// made by compute shaders alone.
    bool evaluatesInVertexStages = true;
    /// Invocations that a workgroup should have where there is little work: a CPU driver runs the rest one after
    /// another.
    std::uint32_t smallGroup = 64;
    bool hasSubgroupShuffle = false; ///< in compute shaders
    std::uint32_t maxImageSide = 0;  ///< texels
    std::uint32_t maxDrawIndirectCount = 1;
    std::uint64_t heapBytes = 0; ///< the device-local heap
    /// Tessellated vertices that one draw should not exceed. Mesa's CPU driver resets every vertex id of a draw at each
    /// flush, so its time grows with the square (`relief_bench split` measures it); other devices want one large draw.
    std::uint32_t tessellatedVerticesPerDraw = 0xffffffffu;
    /// Triangles of a finished mesh or of grids that should be drawn at most between two barriers. Mesa's CPU driver
    /// keeps those that it has not rasterized, about 400 bytes each (64 scenes of 36 MiB at most, in lp_scene.h and
    /// lp_setup_context.h of a later Mesa): making vertices is faster than its rasterizer.
    std::uint32_t meshTrianglesInFlight = 0xffffffffu;
    float timestampNanoseconds = 0; ///< per tick; 0 where the queue cannot time
    bool countsPipeline = false;    ///< pipeline statistics
};

/// The traits of all devices, without making one the current one.
std::vector<DeviceTraits> listDevices();

/// A logical device with one queue.
class Device {
public:
    /// Throws Failure::device where there is no Vulkan 1.3 device of that name or the layer asked for is missing.
    explicit Device(const DeviceDesc& desc = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const DeviceTraits& traits() const { return traits_; }
    [[nodiscard]] VkDevice handle() const { return device_; }
    [[nodiscard]] VkPhysicalDevice physical() const { return physical_; }
    [[nodiscard]] VkInstance instance() const { return instance_; }
    [[nodiscard]] VkQueue queue() const { return queue_; }
    [[nodiscard]] std::uint32_t queueFamily() const { return queueFamily_; }
    [[nodiscard]] VkSurfaceKHR surface() const { return surface_; } ///< null without a window
    [[nodiscard]] bool isValidating() const { return isValidating_; }
    /// Warnings and errors of the validation layer so far, one per line; each was printed to stderr as well.
    /// Waits for pipelines in the making, so that none is missing.
    [[nodiscard]] std::vector<std::string> validationMessages() const;

    /// Bytes that buffers and images take now, without the copies of uploads that wait for the next submission.
    [[nodiscard]] std::uint64_t allocatedBytes() const;
    /// The most bytes that buffers and images took at once since startPeak(), those copies included.
    [[nodiscard]] std::uint64_t peakBytes() const;
    void startPeak();
    /// Bytes of the blocks that buffers and images are placed in.
    [[nodiscard]] std::uint64_t reservedBytes() const;

    /// Records commands with `record`, submits them after all pending uploads, and waits until the device is done.
    /// Nothing else waits, but an upload that finds much staging memory in use (submitUploads). A frame of the dice
    /// path waits three times, of the other paths twice: for rates, which the host plans triangles from; for diced
    /// vertices, whose time is taken by the host's clock on CPU devices; and for the picture. Each posed set of points
    /// adds one.
    void submitAndWait(const std::function<void(VkCommandBuffer)>& record);
    /// Submits pending uploads and waits; does nothing where there are none.
    void submitUploads();
    /// Submissions by submitAndWait() and submitUploads() so far; the host waited for each of them. Frames that a
    /// Swapchain shows are not counted.
    [[nodiscard]] std::uint64_t submitCount() const { return submitCount_; }

    /// A name that debuggers and the validation layer show, where the instance has VK_EXT_debug_utils.
    void setName(VkObjectType type, std::uint64_t object, const std::string& name) const;
    [[nodiscard]] bool namesObjects() const { return nameObject_ != nullptr; }

    // What the functions of this module share.
    [[nodiscard]] DeviceMemory& memory() { return *memory_; }
    [[nodiscard]] PendingUploads& uploads() { return *uploads_; }
    [[nodiscard]] PipelineCache& pipelineCache() { return *pipelineCache_; }
    [[nodiscard]] DescriptorPools& descriptorPools() { return *descriptorPools_; }
    [[nodiscard]] BackgroundTasks& backgroundTasks() { return *backgroundTasks_; }

private:
    void makeInstance(bool validate, const DeviceDesc& desc);
    void pickPhysical(const DeviceDesc& desc);
    void makeDevice();
    void makeCommands();
    void destroy();
    class Commands;
    void submit(std::span<const VkCommandBuffer> commands);
    [[nodiscard]] bool presents(VkPhysicalDevice physical, std::uint32_t family) const;
    [[nodiscard]] std::optional<std::uint32_t> findQueueFamily(VkPhysicalDevice physical) const;

    VkInstance instance_ = VK_NULL_HANDLE;
    VkSurfaceKHR surface_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queueFamily_ = 0;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    PFN_vkSetDebugUtilsObjectNameEXT nameObject_ = nullptr;
    DeviceTraits traits_;
    std::unique_ptr<MessageLog> messages_;
    std::unique_ptr<DeviceMemory> memory_;
    std::unique_ptr<PendingUploads> uploads_;
    std::unique_ptr<DescriptorPools> descriptorPools_;
    std::unique_ptr<PipelineCache> pipelineCache_;
    std::unique_ptr<BackgroundTasks> backgroundTasks_;
    std::uint64_t submitCount_ = 0;
    bool isValidating_ = false;
};

} // namespace relief
