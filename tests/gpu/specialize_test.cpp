// Shaders with the values of their constants: smaller, and of the same arithmetic.
#include <filesystem>

#include "gpu/shader_cache.h"
#include "gpu/specialize.h"

#include "choices.h"
#include "fixture.h"
#include "support.h"

namespace relief::test {
namespace {

constexpr std::uint32_t kCount = 1000;

std::uint32_t turned(std::uint32_t value) {
    for (std::uint32_t i = 0; i < 5; ++i) value = (value << 7 | value >> 25) ^ (value * 2654435761u + i);
    return value;
}

/// What choices.comp is to write.
std::uint32_t valueOf(std::uint32_t way, std::uint32_t groupSize, std::uint32_t i) {
    if (way == 2) return turned(turned(i) + 1);
    return way == 1 ? 3 * i + groupSize : i;
}

class Specialized : public OnDevice {
protected:
    void SetUp() override {
        OnDevice::SetUp();
        setenv("RELIEF_CACHE", folder_.path.c_str(), 1);
    }
    void TearDown() override {
        unsetenv("RELIEF_CACHE");
        OnDevice::TearDown();
    }

    struct Push {
        VkDeviceAddress target;
        std::uint32_t count = kCount, padding = 0;
    };
    static ComputeDesc describe(std::uint32_t way, std::uint32_t groupSize) {
        return {.name = "choices",
                .stage = {VK_SHADER_STAGE_COMPUTE_BIT, choices},
                .constants = {way, groupSize},
                .layout = {{}, sizeof(Push)}};
    }

    static std::vector<std::uint32_t> run(std::uint32_t way, std::uint32_t groupSize) {
        return run(makeCompute(device(), describe(way, groupSize)), groupSize);
    }
    static std::vector<std::uint32_t> run(const Pipeline& pipeline, std::uint32_t groupSize) {
        Push push;
        const Buffer target =
            makeBuffer(device(), {.name = "chosen",
                                  .bytes = kCount * 4,
                                  .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT});
        push.target = target.address;
        device().submitAndWait([&](VkCommandBuffer commands) {
            vkCmdBindPipeline(commands, pipeline.bindPoint, pipeline.handle.get());
            relief::push(commands, pipeline, std::as_bytes(std::span(&push, 1)));
            vkCmdDispatch(commands, (kCount + groupSize - 1) / groupSize, 1, 1);
        });
        std::vector<std::uint32_t> words(kCount);
        downloadBytes(device(), target, std::as_writable_bytes(std::span(words)));
        return words;
    }
    static std::vector<std::string> cachedFiles() {
        std::vector<std::string> paths;
        for (const auto& entry : std::filesystem::directory_iterator(std::getenv("RELIEF_CACHE")))
            if (entry.path().extension() == ".spv") paths.push_back(entry.path());
        return paths;
    }
    TemporaryFolder folder_;
};

// Several threads specialize, write to the cache and make pipelines while this one uses others.
TEST_F(Specialized, doTheSameByOtherThreads) {
    std::vector<PendingPipeline> pending;
    for (std::uint32_t groupSize = 1; groupSize <= 8; ++groupSize)
        for (std::uint32_t way = 0; way < 3; ++way) pending.push_back(startCompute(device(), describe(way, groupSize)));
    for (std::uint32_t groupSize = 8; groupSize >= 1; --groupSize)
        for (std::uint32_t way = 0; way < 3; ++way) {
            const std::vector<std::uint32_t> words = run(pending[3 * (groupSize - 1) + way].get(), groupSize);
            std::uint32_t others = 0;
            for (std::uint32_t i = 0; i < kCount; ++i) others += words[i] != valueOf(way, groupSize, i);
            EXPECT_EQ(others, 0u) << way << " " << groupSize;
        }
}

TEST_F(Specialized, shadersDoWhatTheirConstantsChoose) {
    for (int time = 0; time < 2; ++time) // compiled, and from the cache
        for (const std::uint32_t way : {0u, 1u, 2u})
            for (const std::uint32_t groupSize : {16u, 64u}) {
                const std::vector<std::uint32_t> words = run(way, groupSize);
                for (std::uint32_t i = 0; i < kCount; ++i)
                    ASSERT_EQ(words[i], valueOf(way, groupSize, i)) << way << ' ' << groupSize << ' ' << i;
            }
    EXPECT_EQ(cachedFiles().size(), 6u);
}

TEST_F(Specialized, shadersHoldNothingThatIsNotChosen) {
    const std::size_t plain = specialize(choices, std::vector<std::uint32_t>{0, 64}).size();
    const std::size_t turning = specialize(choices, std::vector<std::uint32_t>{2, 64}).size();
    EXPECT_LT(plain * 4, turning * 3);
    EXPECT_LT(turning, std::size(choices));
}

TEST_F(Specialized, shadersAreMadeAgainWhereTheirFileIsDamagedOrThereIsNoCache) {
    const std::vector<std::uint32_t> constants{2, 64};
    const std::vector<std::uint32_t> made = specialize(choices, constants);
    ASSERT_EQ(cachedFiles().size(), 1u);
    std::string bytes = readFile(cachedFiles()[0]);
    bytes[bytes.size() / 2] = char(~bytes[bytes.size() / 2]);
    putFile(cachedFiles()[0], bytes);
    EXPECT_EQ(specialize(choices, constants), made);
    setenv("RELIEF_CACHE", "0", 1);
    EXPECT_EQ(specialize(choices, constants), made);
}

TEST_F(Specialized, shadersOfLongAgoAreRemoved) {
    for (std::uint32_t i = 0; i <= kMostCachedShaders; ++i) putFile(folder_ / fmt::format("{:032x}.spv", i), "");
    putFile(folder_ / "of-somebody-else.txt", "");
    specialize(choices, std::vector<std::uint32_t>{1, 64});
    EXPECT_LE(cachedFiles().size(), kMostCachedShaders / 2 + 2);
    EXPECT_TRUE(std::filesystem::exists(folder_ / "of-somebody-else.txt"));
}

} // namespace
} // namespace relief::test
