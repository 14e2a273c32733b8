// Bytes to the device and back, and how often the host waits for them.
#include <algorithm>

#include "gpu/device_memory.h"
#include "gpu/uploads.h"

#include "fixture.h"

namespace relief::test {
namespace {

class Uploads : public OnDeviceWithoutLeaks {};

constexpr VkBufferUsageFlags kReadable = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

Buffer uploaded(std::span<const std::byte> data) {
    return uploadBytes(device(), {.name = "uploaded", .bytes = data.size(), .usage = kReadable}, data);
}

TEST_F(Uploads, comeBackAsTheyWere) {
    for (const std::size_t size :
         {std::size_t(0), std::size_t(1), std::size_t(3), std::size_t(16), std::size_t(1001),
          std::size_t(PendingUploads::kMostStagedBytes) + 5, std::size_t(DeviceMemory::kLargestBlock) + 77}) {
        const std::vector<std::byte> data = pattern(size, unsigned(size));
        const Buffer buffer = uploaded(data);
        std::vector<std::byte> back(size);
        downloadBytes(device(), buffer, back);
        EXPECT_TRUE(back == data) << size;
    }
}

TEST_F(Uploads, waitForTheNextSubmission) {
    device().submitUploads();
    const std::uint64_t before = device().submitCount(), bytes = device().allocatedBytes();
    std::vector<Buffer> buffers;
    for (unsigned i = 0; i < 20; ++i) buffers.push_back(uploaded(pattern(100 + i, i)));
    const Texture texture = makeTexture(device(), {.name = "target", .width = 8, .height = 8});
    EXPECT_EQ(device().submitCount(), before);
    EXPECT_FALSE(device().uploads().isEmpty());
    std::vector<std::byte> back(119);
    downloadBytes(device(), buffers[19], back);
    EXPECT_TRUE(back == pattern(119, 19));
    EXPECT_EQ(device().submitCount(), before + 1) << "uploads and download are one submission";
    EXPECT_TRUE(device().uploads().isEmpty());
    back.resize(100);
    downloadBytes(device(), buffers[0], back);
    EXPECT_TRUE(back == pattern(100, 0));
    buffers.clear();
    EXPECT_GT(device().allocatedBytes(), bytes); // the texture
}

TEST_F(Uploads, areNotCountedAsAllocatedWhileTheyWait) {
    device().submitUploads();
    const std::uint64_t before = device().allocatedBytes();
    const Buffer buffer = uploaded(pattern(10000));
    const std::uint64_t waiting = device().allocatedBytes() - before;
    EXPECT_GE(waiting, 10000u);
    EXPECT_LT(waiting, 12000u) << "the staging copy is no part of it";
    device().submitUploads();
    EXPECT_EQ(device().allocatedBytes() - before, waiting);
}

TEST_F(Uploads, ofWhatEndsBeforeAreForgotten) {
    device().submitUploads();
    const std::uint64_t before = device().submitCount();
    {
        const Buffer gone = uploaded(pattern(1000));
        const Texture alsoGone = uploadTexture(device(), {.name = "gone", .width = 4, .height = 4}, pattern(64), 4);
    }
    EXPECT_TRUE(device().uploads().isEmpty());
    EXPECT_EQ(device().uploads().stagedBytes(), 0u);
    device().submitUploads();
    EXPECT_EQ(device().submitCount(), before);
}

TEST_F(Uploads, followTheirBufferWhereItIsMoved) {
    Buffer buffer = uploaded(pattern(500, 3));
    std::vector<Buffer> kept;
    kept.push_back(std::move(buffer));
    buffer = uploaded(pattern(500, 4));
    std::vector<std::byte> back(500);
    downloadBytes(device(), kept[0], back);
    EXPECT_TRUE(back == pattern(500, 3));
}

TEST_F(Uploads, manyKeepLittleStagingMemory) {
    const std::uint64_t before = device().allocatedBytes();
    device().startPeak();
    std::vector<Buffer> buffers;
    for (unsigned i = 0; i < 40; ++i) buffers.push_back(uploaded(pattern(1 << 20, i)));
    EXPECT_LE(device().peakBytes() - before, (40ull << 20) + PendingUploads::kMostStagedBytes + (2 << 20));
    std::vector<std::byte> back(1 << 20);
    for (const unsigned i : {0u, 17u, 39u}) {
        downloadBytes(device(), buffers[i], back);
        EXPECT_TRUE(back == pattern(1 << 20, i)) << i;
    }
}

TEST_F(Uploads, madeWhileCommandsAreRecordedComeBeforeThem) {
    const std::vector<std::byte> data = pattern(333, 9);
    Buffer made;
    const Download download(device(), data.size());
    device().submitAndWait([&](VkCommandBuffer commands) {
        made = uploaded(data);
        download.record(commands, made);
    });
    EXPECT_TRUE(std::ranges::equal(download.bytes(), data));
}

TEST_F(Uploads, surviveCommandsThatFailToBeRecorded) {
    const std::vector<std::byte> data = pattern(64, 2);
    const Buffer buffer = uploaded(data);
    EXPECT_ANY_THROW(device().submitAndWait([](VkCommandBuffer) { fail(Failure::usage, "not recorded"); }));
    std::vector<std::byte> back(64);
    downloadBytes(device(), buffer, back);
    EXPECT_TRUE(back == data);
}

TEST_F(Uploads, downloadsReadWhatTheCommandsBeforeThemWrote) {
    const Buffer buffer =
        makeBuffer(device(), {.name = "filled", .bytes = 256, .usage = kReadable | VK_BUFFER_USAGE_TRANSFER_DST_BIT});
    const Download download(device(), 256);
    device().submitAndWait([&](VkCommandBuffer commands) {
        vkCmdFillBuffer(commands, buffer.handle.get(), 0, VK_WHOLE_SIZE, 0xa5a5a5a5u);
        download.record(commands, buffer);
    });
    for (const std::byte each : download.bytes()) ASSERT_EQ(each, std::byte(0xa5));
}

/// The texels of one mip, copied back.
std::vector<std::byte> readMip(const Texture& texture, std::uint32_t level, std::size_t bytes) {
    const std::uint32_t width = std::max(1u, texture.desc.width >> level);
    const std::uint32_t height = std::max(1u, texture.desc.height >> level);
    const Buffer read = makeBuffer(
        device(),
        {.name = "read", .bytes = bytes, .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT, .memory = MemoryUse::readback});
    device().submitAndWait([&](VkCommandBuffer commands) {
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, level, 0, 1};
        region.imageExtent = {width, height, 1};
        vkCmdCopyImageToBuffer(commands, texture.handle.get(), VK_IMAGE_LAYOUT_GENERAL, read.handle.get(), 1, &region);
        barrier(commands);
    });
    const auto* first = static_cast<const std::byte*>(read.mapped);
    return {first, first + bytes};
}

TEST_F(Uploads, texturesHoldAllTheirMips) {
    const std::vector<std::byte> mips = pattern(4 * (13 * 6 + 6 * 3 + 3 * 1 + 1), 5);
    const Texture texture = uploadTexture(device(),
                                          {.name = "mips",
                                           .width = 13,
                                           .height = 6,
                                           .mipCount = 4,
                                           .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
                                          mips, 4);
    std::size_t offset = 0;
    for (std::uint32_t level = 0; level < 4; ++level) {
        const std::size_t bytes = 4ull * std::max(1u, 13u >> level) * std::max(1u, 6u >> level);
        const auto first = mips.begin() + std::ptrdiff_t(offset);
        EXPECT_TRUE(readMip(texture, level, bytes) == std::vector(first, first + std::ptrdiff_t(bytes))) << level;
        offset += bytes;
    }
    EXPECT_EQ(offset, mips.size());
}

TEST_F(Uploads, texturesThatAreTooLargeAreRefused) {
    const std::uint32_t side = device().traits().maxImageSide + 1;
    const std::string message =
        deviceFailure([&] { makeTexture(device(), {.name = "wide", .width = side, .height = 1}); });
    EXPECT_NE(message.find(std::to_string(side)), std::string::npos) << message;
}

} // namespace
} // namespace relief::test
