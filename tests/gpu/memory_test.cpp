// Blocks of device memory, and what is said of them.
#include <algorithm>

#include "gpu/device_memory.h"

#include "fixture.h"

namespace relief::test {
namespace {

class Memory : public OnDeviceWithoutLeaks {};

TEST_F(Memory, manySmallBuffersShareABlock) {
    const std::size_t blocks = device().memory().blockCount();
    std::vector<Buffer> buffers;
    for (int i = 0; i < 100; ++i) buffers.push_back(makeBuffer(device(), {.name = "small", .bytes = 1000}));
    EXPECT_LE(device().memory().blockCount(), blocks + 1);
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        EXPECT_EQ(buffers[i].address % 16, 0u);
        for (std::size_t k = 0; k < i; ++k)
            EXPECT_TRUE(buffers[k].address + 1000 <= buffers[i].address ||
                        buffers[i].address + 1000 <= buffers[k].address)
                << i << ' ' << k;
    }
}

TEST_F(Memory, aTinyBufferReservesLittle) {
    const std::uint64_t before = device().reservedBytes();
    const Buffer buffer = makeBuffer(device(), {.name = "tiny", .bytes = 1});
    EXPECT_EQ(buffer.bytes, 16u);
    EXPECT_LE(device().reservedBytes() - before, DeviceMemory::kSmallestBlock);
}

TEST_F(Memory, blocksGrowWithWhatIsTakenAndAreGivenBack) {
    const std::uint64_t reserved = device().reservedBytes(), blocks = device().memory().blockCount();
    {
        std::vector<Buffer> buffers;
        const std::uint64_t each = 100'000, count = 600; // 57 MiB
        for (std::uint64_t i = 0; i < count; ++i)
            buffers.push_back(makeBuffer(device(), {.name = "part", .bytes = each}));
        EXPECT_LT(device().memory().blockCount() - blocks, 20u);
        EXPECT_LT(device().reservedBytes() - reserved, 2 * each * count);
    }
    EXPECT_LE(device().reservedBytes(), reserved + DeviceMemory::kSmallestBlock * 4) << "at most a small spare remains";
}

TEST_F(Memory, aLargeBufferIsReservedExactly) {
    const std::uint64_t reserved = device().reservedBytes(), taken = device().allocatedBytes();
    const std::uint64_t bytes = 3 * DeviceMemory::kLargestBlock + 4096;
    {
        const Buffer buffer = makeBuffer(device(), {.name = "large", .bytes = bytes});
        EXPECT_EQ(device().reservedBytes() - reserved, device().allocatedBytes() - taken);
        EXPECT_LT(device().allocatedBytes() - taken, bytes + 4096);
    }
    EXPECT_EQ(device().reservedBytes(), reserved);
}

TEST_F(Memory, imagesAndBuffersShareNoBlock) {
    const Buffer buffer = makeBuffer(device(), {.name = "buffer", .bytes = 64});
    const Texture texture = makeTexture(device(), {.name = "texture", .width = 4, .height = 4});
    EXPECT_NE(buffer.memory.range().block, texture.memory.range().block);
    EXPECT_EQ(buffer.memory.range().block->content, BlockContent::buffers);
    EXPECT_EQ(texture.memory.range().block->content, BlockContent::images);
}

TEST_F(Memory, peakIsTheMostSinceItWasStarted) {
    const std::uint64_t before = device().allocatedBytes();
    device().startPeak();
    { const Buffer buffer = makeBuffer(device(), {.name = "passing", .bytes = 1 << 20}); }
    EXPECT_EQ(device().allocatedBytes(), before);
    EXPECT_GE(device().peakBytes(), before + (1 << 20));
    device().startPeak();
    EXPECT_LT(device().peakBytes(), before + (1 << 20));
}

TEST_F(Memory, moreThanTheHeapIsRefusedInOneLine) {
    const std::uint64_t before = device().allocatedBytes(), reserved = device().reservedBytes();
    const std::uint64_t heap = device().traits().heapBytes;
    const std::string message = deviceFailure([&] { makeBuffer(device(), {.name = "too large", .bytes = heap + 1}); });
    EXPECT_EQ(message.find("out of memory: "), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos);
    EXPECT_EQ(device().allocatedBytes(), before);
    EXPECT_EQ(device().reservedBytes(), reserved);
}

TEST_F(Memory, theHeapIsFullBesideWhatIsTaken) {
    const std::uint64_t most = device().traits().heapBytes;
    MemoryRange large;
    VkMemoryRequirements needs{.size = 1 << 20, .alignment = 16, .memoryTypeBits = ~0u};
    large = device().memory().take(needs, 0, BlockContent::buffers);
    needs.size = most - (1 << 19); // alone it would fit
    EXPECT_EQ(deviceFailure([&] { device().memory().take(needs, 0, BlockContent::buffers); }).find("out of memory: "),
              0u);
    device().memory().giveBack(large);
}

TEST_F(Memory, mappedBuffersOfOneBlockKeepTheirOwnBytes) {
    std::vector<Buffer> buffers;
    for (int i = 0; i < 8; ++i)
        buffers.push_back(makeBuffer(device(), {.name = "mapped", .bytes = 100, .memory = MemoryUse::upload}));
    for (unsigned i = 0; i < 8; ++i) std::ranges::copy(pattern(100, i), static_cast<std::byte*>(buffers[i].mapped));
    for (unsigned i = 0; i < 8; ++i)
        EXPECT_TRUE(std::ranges::equal(pattern(100, i), std::span(static_cast<std::byte*>(buffers[i].mapped), 100)));
    EXPECT_EQ(makeBuffer(device(), {.name = "not mapped", .bytes = 100}).mapped, nullptr);
}

TEST_F(Memory, movedBuffersAreGivenBackOnce) {
    const std::uint64_t before = device().allocatedBytes();
    Buffer a = makeBuffer(device(), {.name = "a", .bytes = 5000});
    const std::uint64_t one = device().allocatedBytes() - before;
    Buffer b = std::move(a);
    EXPECT_EQ(device().allocatedBytes() - before, one);
    b = makeBuffer(device(), {.name = "c", .bytes = 5000});
    EXPECT_EQ(device().allocatedBytes() - before, one);
    b = {};
    EXPECT_EQ(device().allocatedBytes(), before);
}

} // namespace
} // namespace relief::test
