// What the device measures of its own work: times and counts.
#pragma once

#include "gpu/device.h"
#include "gpu/owned.h"

namespace relief {

/// Time stamps in the order in which they were written, `capacity` at most; later ones are ignored.
class Timer {
public:
    Timer(Device& device, std::uint32_t capacity);
    void reset(VkCommandBuffer commands);
    void stamp(VkCommandBuffer commands);
    /// Milliseconds between consecutive stamps, after the commands are done; empty where the device cannot time.
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
