#include "gpu/queries.h"

namespace relief {
namespace {

Owned<VkQueryPool> makeQueries(Device& device, const VkQueryPoolCreateInfo& info) {
    VkQueryPool pool = VK_NULL_HANDLE;
    checkVulkan(vkCreateQueryPool(device.handle(), &info, nullptr, &pool), "vkCreateQueryPool");
    return {device.handle(), pool, vkDestroyQueryPool};
}

} // namespace

Timer::Timer(Device& device, std::uint32_t capacity) : device_(&device), capacity_(capacity) {
    if (device.traits().timestampNanoseconds == 0) return;
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_TIMESTAMP;
    info.queryCount = capacity;
    pool_ = makeQueries(device, info);
}

void Timer::reset(VkCommandBuffer commands) {
    count_ = 0;
    if (pool_.get() != VK_NULL_HANDLE) vkCmdResetQueryPool(commands, pool_.get(), 0, capacity_);
}

void Timer::stamp(VkCommandBuffer commands) {
    if (pool_.get() == VK_NULL_HANDLE || count_ == capacity_) return;
    vkCmdWriteTimestamp2(commands, VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT, pool_.get(), count_++);
}

std::vector<double> Timer::intervals() const {
    std::vector<double> intervals;
    if (pool_.get() == VK_NULL_HANDLE || count_ < 2) return intervals;
    std::vector<std::uint64_t> ticks(count_);
    checkVulkan(vkGetQueryPoolResults(device_->handle(), pool_.get(), 0, count_, count_ * sizeof(std::uint64_t),
                                      ticks.data(), sizeof(std::uint64_t),
                                      VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                "vkGetQueryPoolResults");
    for (std::uint32_t i = 1; i < count_; ++i)
        intervals.push_back(double(ticks[i] - ticks[i - 1]) * device_->traits().timestampNanoseconds * 1e-6);
    return intervals;
}

PipelineCounter::PipelineCounter(Device& device) : device_(&device) {
    if (!device.traits().countsPipeline) return;
    VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
    info.queryType = VK_QUERY_TYPE_PIPELINE_STATISTICS;
    info.queryCount = 1;
    info.pipelineStatistics = VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_VERTICES_BIT |
                              VK_QUERY_PIPELINE_STATISTIC_INPUT_ASSEMBLY_PRIMITIVES_BIT |
                              VK_QUERY_PIPELINE_STATISTIC_VERTEX_SHADER_INVOCATIONS_BIT |
                              VK_QUERY_PIPELINE_STATISTIC_CLIPPING_PRIMITIVES_BIT |
                              VK_QUERY_PIPELINE_STATISTIC_FRAGMENT_SHADER_INVOCATIONS_BIT;
    if (device.traits().hasTessellation)
        info.pipelineStatistics |= VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_CONTROL_SHADER_PATCHES_BIT |
                                   VK_QUERY_PIPELINE_STATISTIC_TESSELLATION_EVALUATION_SHADER_INVOCATIONS_BIT;
    pool_ = makeQueries(device, info);
}

void PipelineCounter::begin(VkCommandBuffer commands) const {
    if (pool_.get() == VK_NULL_HANDLE) return;
    vkCmdResetQueryPool(commands, pool_.get(), 0, 1);
    vkCmdBeginQuery(commands, pool_.get(), 0, 0);
}

void PipelineCounter::end(VkCommandBuffer commands) const {
    if (pool_.get() != VK_NULL_HANDLE) vkCmdEndQuery(commands, pool_.get(), 0);
}

PipelineCounts PipelineCounter::counts() const {
    if (pool_.get() == VK_NULL_HANDLE) return {};
    std::uint64_t values[7] = {}; // in the order of the bits
    checkVulkan(vkGetQueryPoolResults(device_->handle(), pool_.get(), 0, 1, sizeof values, values, sizeof values,
                                      VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
                "vkGetQueryPoolResults");
    return {.vertices = values[0],
            .primitives = values[1],
            .vertexCalls = values[2],
            .tessellationPatches = values[5],
            .tessellationCalls = values[6],
            .drawnPrimitives = values[3],
            .fragmentCalls = values[4]};
}

} // namespace relief
