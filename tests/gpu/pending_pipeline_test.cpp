// Pipelines that other threads make: once each, whoever comes first.
#include <atomic>
#include <chrono>
#include <thread>

#include "gpu/fixture.h"

namespace relief::test {
namespace {

class PendingPipelines : public OnDevice {};

TEST_F(PendingPipelines, areMadeOnceWhoeverComesFirst) {
    constexpr int kCount = 200;
    std::vector<std::atomic<int>> made(kCount);
    std::vector<PendingPipeline> pending;
    for (int i = 0; i < kCount; ++i)
        pending.emplace_back(device(), [&made, i] {
            std::this_thread::sleep_for(std::chrono::microseconds(i % 3 * 100));
            ++made[std::size_t(i)];
            Pipeline pipeline;
            pipeline.bindPoint = i % 2 == 0 ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS;
            return pipeline;
        });
    // The last first: what no thread has begun is made here, and what one has begun is waited for.
    for (int i = kCount - 1; i >= 0; --i) {
        const PendingPipeline copy = pending[std::size_t(i)];
        EXPECT_EQ(copy.get().bindPoint, i % 2 == 0 ? VK_PIPELINE_BIND_POINT_COMPUTE : VK_PIPELINE_BIND_POINT_GRAPHICS);
        EXPECT_EQ(&copy.get(), &pending[std::size_t(i)].get());
    }
    for (const std::atomic<int>& count : made) EXPECT_EQ(count, 1);
}

TEST_F(PendingPipelines, throwToThoseThatAskForThem) {
    std::vector<PendingPipeline> pending;
    for (int i = 0; i < 50; ++i)
        pending.emplace_back(device(), []() -> Pipeline { fail(Failure::device, "it cannot be made"); });
    for (const PendingPipeline& one : pending) {
        EXPECT_EQ(deviceFailure([&] { one.get(); }), "it cannot be made");
        EXPECT_EQ(deviceFailure([&] { one.get(); }), "it cannot be made");
    }
}

TEST_F(PendingPipelines, thatNobodyAsksForEndWithTheDevice) {
    std::atomic<int> made = 0;
    {
        Device another;
        for (int i = 0; i < 1000; ++i)
            const PendingPipeline unused(another, [&made] {
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
                ++made;
                return Pipeline{};
            });
    }
    EXPECT_LT(made, 1000);
}

} // namespace
} // namespace relief::test
