// A Vulkan 1.3 device without a window: owners made from descriptions, one barrier, one way to run commands.
// Core features only: dynamic rendering, synchronization2, buffer addresses, scalar layout. Knows no geometry.
#pragma once

#include <memory>
#include <span>
#include <utility>

#include <vulkan/vulkan.h>

#include "base/base.h"

namespace relief {

/// Throws Failure::device with the call's name unless `result` is VK_SUCCESS.
void checkVulkan(VkResult result, const char* call);

struct DeviceDesc {
    std::string name;      ///< part of the device's name to prefer; empty: a discrete GPU before others, CPU last
    bool validate = false; ///< Khronos layer with synchronization validation; RELIEF_VALIDATE=1 turns it on as well
};

/// What paths and passes ask before they choose: properties, never #ifdefs.
struct DeviceTraits {
    std::string name, driver, api;
    bool isCpu = false;
    bool hasTessellation = false;
    bool hasWireframe = false; ///< fillModeNonSolid
    bool hasTransformFeedback = false;
    bool hasVertexStores = false; ///< vertex stages may write to buffers
    std::uint32_t maxTessellationLevel = 0;
    std::uint32_t maxTexelBufferElements = 0;
    /// Invocations that a workgroup should have where it works on little: a CPU driver runs the rest one after another.
    std::uint32_t smallGroup = 64;
    std::uint32_t maxImageSide = 0;
    std::uint32_t maxDrawIndirectCount = 1;
    std::uint64_t heapBytes = 0; ///< the device-local heap
    /// Tessellated vertices that one draw should not pass. Mesa's CPU driver resets every vertex id of a draw at each
    /// flush, so its time grows with the square (`relief_bench split` measures it); other devices want one large draw.
    std::uint32_t tessellatedVerticesPerDraw = 0xffffffffu;
    /// Triangles of a finished mesh that should not be passed without a barrier. Mesa's CPU driver keeps those that it
    /// has not rasterized (64 scenes of 36 MiB at most, in lp_scene.h and lp_setup_context.h of a later Mesa), and
    /// fetching vertices outruns its rasterizer; where vertices are computed it keeps up.
    std::uint32_t meshTrianglesInFlight = 0xffffffffu;
    float timestampNanoseconds = 0; ///< 0 where the queue cannot time
    bool countsPipeline = false;    ///< pipeline statistics
};

/// One line a device, without making it the current one.
std::vector<DeviceTraits> listDevices();

class Device {
public:
    explicit Device(const DeviceDesc& desc = {});
    ~Device();
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    [[nodiscard]] const DeviceTraits& traits() const { return traits_; }
    [[nodiscard]] VkDevice handle() const { return device_; }
    [[nodiscard]] bool isValidating() const { return isValidating_; }
    /// Warnings and errors of the validation layer so far, one a line; each was printed to stderr as well.
    [[nodiscard]] const std::vector<std::string>& validationMessages() const { return *messages_; }
    /// Bytes of device memory that are allocated now.
    [[nodiscard]] std::uint64_t allocatedBytes() const { return allocatedBytes_; }
    /// The most that there were at once since startPeak().
    [[nodiscard]] std::uint64_t peakBytes() const { return peakBytes_; }
    void startPeak() { peakBytes_ = allocatedBytes_; }

    /// Records with `record`, submits and waits.
    void run(const std::function<void(VkCommandBuffer)>& record);

    /// Memory for an object; refuses what the heap cannot hold before asking the driver (some over-commit).
    VkDeviceMemory allocate(const VkMemoryRequirements& needs, VkMemoryPropertyFlags flags, bool hasAddress);
    void release(VkDeviceMemory memory, std::uint64_t bytes);
    void setName(VkObjectType type, std::uint64_t object, const std::string& name) const;

private:
    void makeInstance(bool validate);
    void pickPhysical(const std::string& wanted);
    void makeDevice();
    void makeCommands();
    void destroy();

    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    VkPhysicalDevice physical_ = VK_NULL_HANDLE;
    VkDevice device_ = VK_NULL_HANDLE;
    VkQueue queue_ = VK_NULL_HANDLE;
    std::uint32_t queueFamily_ = 0;
    VkCommandPool pool_ = VK_NULL_HANDLE;
    VkFence fence_ = VK_NULL_HANDLE;
    PFN_vkSetDebugUtilsObjectNameEXT nameObject_ = nullptr;
    VkPhysicalDeviceMemoryProperties memory_{};
    DeviceTraits traits_;
    std::unique_ptr<std::vector<std::string>> messages_ = std::make_unique<std::vector<std::string>>();
    std::uint64_t allocatedBytes_ = 0, peakBytes_ = 0;
    bool isValidating_ = false;
};

/// A handle with the function that ends it: movable, never copied.
template <typename Handle>
class Owned {
public:
    Owned() = default;
    Owned(Handle handle, std::function<void(Handle)> destroy) : handle_(handle), destroy_(std::move(destroy)) {}
    ~Owned() { reset(); }
    Owned(Owned&& other) noexcept
        : handle_(std::exchange(other.handle_, Handle{})), destroy_(std::move(other.destroy_)) {}
    Owned& operator=(Owned&& other) noexcept {
        if (this != &other) {
            reset();
            handle_ = std::exchange(other.handle_, Handle{});
            destroy_ = std::move(other.destroy_);
        }
        return *this;
    }
    [[nodiscard]] Handle get() const { return handle_; }

private:
    void reset() {
        if (handle_ != Handle{}) destroy_(std::exchange(handle_, Handle{}));
    }
    Handle handle_{};
    std::function<void(Handle)> destroy_;
};

enum class MemoryUse { device, upload, readback }; ///< upload and readback are mapped

struct BufferDesc {
    std::string name;
    std::uint64_t bytes = 0;
    VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    MemoryUse memory = MemoryUse::device;
};

struct Buffer {
    Owned<VkDeviceMemory> memory;
    Owned<VkBuffer> handle;
    VkDeviceAddress address = 0;
    void* mapped = nullptr; ///< upload and readback buffers
    std::uint64_t bytes = 0;
};

/// A buffer of at least 16 bytes (empty arrays are bound as well), with an address.
Buffer makeBuffer(Device& device, const BufferDesc& desc);

/// A device buffer holding `data`, copied through a staging buffer.
Buffer uploadBytes(Device& device, const BufferDesc& desc, std::span<const std::byte> data);

template <typename T>
Buffer uploadArray(Device& device, const std::string& name, std::span<const T> data,
                   VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
    return uploadBytes(device, {.name = name, .bytes = data.size_bytes(), .usage = usage}, std::as_bytes(data));
}

/// A buffer seen as texels of a format, with the view that shaders fetch from.
struct TexelBuffer {
    Buffer buffer;
    Owned<VkBufferView> view;
};
TexelBuffer makeTexels(Device& device, const BufferDesc& desc, VkFormat format);
TexelBuffer uploadTexels(Device& device, const BufferDesc& desc, VkFormat format, std::span<const std::byte> data);

/// Copies a device buffer made with VK_BUFFER_USAGE_TRANSFER_SRC_BIT back.
void downloadBytes(Device& device, const Buffer& buffer, std::span<std::byte> data);

struct TextureDesc {
    std::string name;
    std::uint32_t width = 1, height = 1, mipCount = 1;
    VkFormat format = VK_FORMAT_R8G8B8A8_UNORM;
    VkImageUsageFlags usage = VK_IMAGE_USAGE_SAMPLED_BIT;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
};

/// An image that stays in the GENERAL layout for all its life.
struct Texture {
    Owned<VkDeviceMemory> memory;
    Owned<VkImage> handle;
    Owned<VkImageView> view;
    TextureDesc desc;
};
Texture makeTexture(Device& device, const TextureDesc& desc);

/// The same filled with tightly packed mips, largest first, `texelBytes` a texel.
Texture uploadTexture(Device& device, TextureDesc desc, std::span<const std::byte> mips, std::uint32_t texelBytes);

struct SamplerDesc {
    VkFilter filter = VK_FILTER_LINEAR;
    VkSamplerAddressMode wrapU = VK_SAMPLER_ADDRESS_MODE_REPEAT;
    VkSamplerAddressMode wrapV = VK_SAMPLER_ADDRESS_MODE_REPEAT;
};
Owned<VkSampler> makeSampler(Device& device, const SamplerDesc& desc);

struct Stage {
    VkShaderStageFlagBits stage;
    std::span<const std::uint32_t> code; ///< SPIR-V words
};

/// What every pipeline is given: the kinds of set 0's bindings 0, 1, 2, ... and a block of push constants.
struct PipelineLayoutDesc {
    std::vector<VkDescriptorType> bindings;
    std::uint32_t pushBytes = 0;
};

struct GraphicsDesc {
    std::string name;
    std::vector<Stage> stages;
    std::vector<std::uint32_t> constants; ///< specialization constants 0, 1, 2, ... of every stage
    PipelineLayoutDesc layout;
    VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    VkPolygonMode polygonMode = VK_POLYGON_MODE_FILL;
    bool rasterizerDiscard = false;          ///< vertices alone: no rasterization
    bool additiveBlend = false;                ///< colors are added, without depth
    bool depthBias = false;     ///< depth bias, for a wireframe over its own surface
    std::vector<VkFormat> colorFormats; ///< none: depth alone
    VkFormat depthFormat = VK_FORMAT_D32_SFLOAT;
    VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
};

struct ComputeDesc {
    std::string name;
    Stage stage;
    std::vector<std::uint32_t> constants;
    PipelineLayoutDesc layout;
};

struct Pipeline {
    Owned<VkDescriptorSetLayout> setLayout;
    Owned<VkPipelineLayout> layout;
    Owned<VkPipeline> handle;
    VkPipelineBindPoint bindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
};
/// Depth is reversed (1 near, 0 far) and compared greater-or-equal; viewport and scissor are dynamic.
Pipeline makeGraphics(Device& device, const GraphicsDesc& desc);
Pipeline makeCompute(Device& device, const ComputeDesc& desc);

/// One thing bound: an image with its sampler, a view of texels in a buffer, or a uniform buffer.
struct Binding {
    VkImageView view = VK_NULL_HANDLE;
    VkSampler sampler = VK_NULL_HANDLE;
    VkBufferView texels = VK_NULL_HANDLE;
    VkBuffer uniform = VK_NULL_HANDLE;

    [[nodiscard]] bool isEmpty() const {
        return view == VK_NULL_HANDLE && texels == VK_NULL_HANDLE && uniform == VK_NULL_HANDLE;
    }
};

/// Set 0 of pipelines with that layout.
struct BindingSet {
    Owned<VkDescriptorPool> pool;
    VkDescriptorSet handle = VK_NULL_HANDLE;
};
BindingSet makeBindingSet(Device& device, const Pipeline& pipeline, const PipelineLayoutDesc& layout,
                          std::span<const Binding> bindings);

void bind(VkCommandBuffer commands, const Pipeline& pipeline, const BindingSet& bindings);
void push(VkCommandBuffer commands, const Pipeline& pipeline, std::span<const std::byte> bytes);

/// Everything before is done and visible to everything after. Frames here are a few passes; one barrier serves them
/// all.
void barrier(VkCommandBuffer commands);

/// Time stamps by name, in the order they were written.
class Timer {
public:
    Timer(Device& device, std::uint32_t capacity);
    void reset(VkCommandBuffer commands);
    void stamp(VkCommandBuffer commands);
    /// Milliseconds between consecutive stamps; empty where the device cannot time.
    [[nodiscard]] std::vector<double> intervals() const;

private:
    Device* device_;
    Owned<VkQueryPool> pool_;
    std::uint32_t count_ = 0, capacity_;
};

/// What the stages of draws were called for.
struct PipelineCounts {
    std::uint64_t vertices = 0, primitives = 0; ///< that draws named
    std::uint64_t vertexCalls = 0, tessellationPatches = 0, tessellationCalls = 0;
    std::uint64_t drawnPrimitives = 0; ///< after clipping
    std::uint64_t fragmentCalls = 0;
};

/// Counts draws between begin and end, both outside of vkCmdBeginRendering. Does nothing where the device cannot.
class PipelineCounter {
public:
    explicit PipelineCounter(Device& device);
    void begin(VkCommandBuffer commands) const;
    void end(VkCommandBuffer commands) const;
    /// After the commands are done; zeros where the device cannot count.
    [[nodiscard]] PipelineCounts counts() const;

private:
    Device* device_;
    Owned<VkQueryPool> pool_;
};

} // namespace relief
