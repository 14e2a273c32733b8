// Tables that a shader reads, the sets that bind them, and what is measured of it.
#include <algorithm>
#include <cstdlib>

#include "gpu/descriptor_pools.h"

#include "copy_table_storage.h"
#include "copy_table_texels.h"
#include "fixture.h"

namespace relief::test {
namespace {

struct Push {
    VkDeviceAddress target;
    std::uint32_t count;
    std::uint32_t padding = 0;
};

PipelineLayoutDesc layoutFor(TableAccess access) {
    return {{access == TableAccess::texelBuffers ? VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER
                                                 : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
            sizeof(Push)};
}

/// Copies tables to a buffer of the given device.
struct Copier {
    Device& on;
    TableAccess access;
    PipelineLayoutDesc layout = layoutFor(access);
    Pipeline pipeline =
        makeCompute(on, {.name = "copy",
                         .stage = {VK_SHADER_STAGE_COMPUTE_BIT, access == TableAccess::texelBuffers
                                                                    ? std::span<const std::uint32_t>(copyTableTexels)
                                                                    : std::span<const std::uint32_t>(copyTableStorage)},
                         .layout = layout});

    void record(VkCommandBuffer commands, const BindingSet& set, const Buffer& target, std::size_t count) const {
        const Push push{target.address, std::uint32_t(count)};
        bind(commands, pipeline, set);
        relief::push(commands, pipeline, std::as_bytes(std::span(&push, 1)));
        vkCmdDispatch(commands, std::uint32_t((count + 63) / 64), 1, 1);
    }
    Buffer makeTarget(std::size_t count) const {
        return makeBuffer(on, {.name = "copied",
                               .bytes = count * 4,
                               .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT});
    }
    std::vector<std::uint32_t> copy(const TexelBuffer& table, std::size_t count) const {
        const Buffer target = makeTarget(count);
        const Binding bindings[] = {table.binding()};
        const BindingSet set = makeBindingSet(on, pipeline, layout, bindings);
        on.submitAndWait([&](VkCommandBuffer commands) { record(commands, set, target, count); });
        std::vector<std::uint32_t> words(count);
        downloadBytes(on, target, std::as_writable_bytes(std::span(words)));
        return words;
    }
};

std::vector<std::uint32_t> numbers(std::size_t count) {
    std::vector<std::uint32_t> words(count);
    for (std::size_t i = 0; i < count; ++i) words[i] = std::uint32_t(i * 2654435761u);
    return words;
}

TexelBuffer uploadNumbers(Device& on, const std::vector<std::uint32_t>& words) {
    return uploadTexels(on, {.name = "numbers"}, VK_FORMAT_R32_UINT, std::as_bytes(std::span(words)));
}

class Tables : public OnDeviceWithoutLeaks {};

TEST_F(Tables, areReadAsTexelsAndAsStorageBuffers) {
    for (const TableAccess access : {TableAccess::texelBuffers, TableAccess::storageBuffers})
        for (const std::size_t count : {1, 5, 64, 1000, 50'000}) {
            const Copier copier{device(), access};
            const std::vector<std::uint32_t> words = numbers(count);
            EXPECT_EQ(copier.copy(uploadNumbers(device(), words), count), words) << count;
        }
}

TEST_F(Tables, emptyOnesAreBoundAsWell) {
    const TexelBuffer table = uploadNumbers(device(), {});
    EXPECT_NE(table.view.get(), VkBufferView{});
    EXPECT_EQ(table.buffer.bytes, 16u);
}

TEST_F(Tables, theWayToReadFollowsFromTheLimit) {
    const DeviceTraits& traits = device().traits();
    EXPECT_GE(traits.maxTexelBufferElements, 65536u);
    EXPECT_GE(traits.maxStorageBufferRange, std::uint64_t(1) << 27); // which Vulkan guarantees
    EXPECT_EQ(traits.readsTablesAs, traits.maxTexelBufferElements < kEnoughTexelBufferElements
                                        ? TableAccess::storageBuffers
                                        : TableAccess::texelBuffers);
}

TEST(LoweredLimits, oneDeviceCanBeTestedAsAnother) {
    Device lowered({.validate = true, .maxTexelBufferElements = 100});
    EXPECT_EQ(lowered.traits().maxTexelBufferElements, 100u);
    EXPECT_EQ(lowered.traits().readsTablesAs, TableAccess::storageBuffers);
    const std::vector<std::uint32_t> words = numbers(101);
    const TexelBuffer large = uploadNumbers(lowered, words);
    EXPECT_EQ(large.view.get(), VkBufferView{}) << "a view of so many elements is not valid";
    EXPECT_EQ((Copier{lowered, TableAccess::storageBuffers}.copy(large, 101)), words);
    const std::string message = deviceFailure([&] { Copier{lowered, TableAccess::texelBuffers}.copy(large, 101); });
    EXPECT_NE(message.find("(100)"), std::string::npos) << message;
    const TexelBuffer small = uploadNumbers(lowered, numbers(100));
    EXPECT_EQ((Copier{lowered, TableAccess::texelBuffers}.copy(small, 100)), numbers(100));
    EXPECT_TRUE(lowered.validationMessages().empty());
}

TEST(LoweredLimits, neverRaiseWhatTheDeviceStates) {
    Device asked({.maxTexelBufferElements = 0xffffffffu});
    EXPECT_EQ(asked.traits().maxTexelBufferElements, device().traits().maxTexelBufferElements);
}

TEST(LoweredLimits, comeFromTheEnvironmentToo) {
    setenv("RELIEF_MAX_TEXEL_BUFFER_ELEMENTS", "65536", 1);
    EXPECT_EQ(Device(DeviceDesc{}).traits().maxTexelBufferElements, 65536u);
    EXPECT_EQ(Device({.maxTexelBufferElements = 7}).traits().maxTexelBufferElements, 7u);
    for (const char* bad : {"", "0", "many", "12x", "99999999999"}) {
        setenv("RELIEF_MAX_TEXEL_BUFFER_ELEMENTS", bad, 1);
        try {
            const Device device;
            ADD_FAILURE() << bad;
        } catch (const Error& error) {
            EXPECT_EQ(error.failure, Failure::usage) << bad;
        }
    }
    unsetenv("RELIEF_MAX_TEXEL_BUFFER_ELEMENTS");
}

TEST_F(Tables, thatAreTooLargeAreRefusedInOneLine) {
    const DeviceTraits& traits = device().traits();
    const bool readsTexels = traits.readsTablesAs == TableAccess::texelBuffers;
    const std::uint64_t most = readsTexels ? 4ull * traits.maxTexelBufferElements : traits.maxStorageBufferRange;
    const std::string message = deviceFailure(
        [&] { makeTexels(device(), {.name = "too long", .bytes = (most / 4 + 1) * 4}, VK_FORMAT_R32_UINT); });
    EXPECT_EQ(message.find("too long: "), 0u) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
}

TEST_F(Tables, setsOfOneFrameShareAPoolThatTheNextUsesAgain) {
    const Copier copier{device(), TableAccess::storageBuffers};
    const TexelBuffer table = uploadNumbers(device(), numbers(10));
    const Binding bindings[] = {table.binding()};
    const auto makeFrame = [&](std::size_t count) {
        std::vector<BindingSet> sets;
        for (std::size_t i = 0; i < count; ++i)
            sets.push_back(makeBindingSet(device(), copier.pipeline, copier.layout, bindings));
        return sets;
    };
    makeFrame(5);
    const std::size_t pools = device().descriptorPools().poolCount();
    for (int frame = 0; frame < 100; ++frame) makeFrame(5);
    EXPECT_EQ(device().descriptorPools().poolCount(), pools);
    for (int frame = 0; frame < 3; ++frame) makeFrame(3 * DescriptorPool::kSets);
    EXPECT_LE(device().descriptorPools().poolCount(), pools + 3) << "pools that were filled are used again";
}

TEST_F(Tables, aSetKeepsItsBindingsWhileOthersComeAndGo) {
    const Copier copier{device(), TableAccess::texelBuffers};
    const TexelBuffer kept = uploadNumbers(device(), numbers(10)), other = uploadNumbers(device(), {1, 2, 3, 4});
    const Binding keptBindings[] = {kept.binding()}, otherBindings[] = {other.binding()};
    const BindingSet set = makeBindingSet(device(), copier.pipeline, copier.layout, keptBindings);
    for (std::uint32_t i = 0; i < 4 * DescriptorPool::kSets; ++i)
        makeBindingSet(device(), copier.pipeline, copier.layout, otherBindings);
    const Buffer target = copier.makeTarget(10);
    device().submitAndWait([&](VkCommandBuffer commands) { copier.record(commands, set, target, 10); });
    std::vector<std::uint32_t> words(10);
    downloadBytes(device(), target, std::as_writable_bytes(std::span(words)));
    EXPECT_EQ(words, numbers(10));
}

TEST_F(Tables, timersMeasureBetweenTheirStamps) {
    Timer timer(device(), 3);
    const Copier copier{device(), TableAccess::storageBuffers};
    const TexelBuffer table = uploadNumbers(device(), numbers(1000));
    const Binding bindings[] = {table.binding()};
    const BindingSet set = makeBindingSet(device(), copier.pipeline, copier.layout, bindings);
    const Buffer target = copier.makeTarget(1000);
    for (int round = 0; round < 2; ++round) {
        device().submitAndWait([&](VkCommandBuffer commands) {
            timer.reset(commands);
            EXPECT_TRUE(timer.intervals().empty());
            timer.stamp(commands);
            copier.record(commands, set, target, 1000);
            for (int i = 0; i < 3; ++i) timer.stamp(commands); // one more than there is room for
        });
        if (device().traits().timestampNanoseconds == 0) continue;
        ASSERT_EQ(timer.intervals().size(), 2u);
        for (const double each : timer.intervals()) EXPECT_TRUE(each >= 0 && each < 10'000) << each;
    }
}

TEST_F(Tables, objectsHaveNamesWhereTheLoaderKnowsThem) {
    std::uint32_t count = 0;
    vkEnumerateInstanceExtensionProperties(nullptr, &count, nullptr);
    std::vector<VkExtensionProperties> extensions(count);
    vkEnumerateInstanceExtensionProperties(nullptr, &count, extensions.data());
    const bool isKnown = std::ranges::any_of(extensions, [](const VkExtensionProperties& e) {
        return std::string_view(e.extensionName) == VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    });
    EXPECT_EQ(device().namesObjects(), isKnown);
    EXPECT_EQ(Device({.validate = false}).namesObjects(), isKnown) << "without validation too";
}

TEST(ValidationNames, appearInItsMessages) {
    Device own({.validate = true});
    {
        const Buffer unreadable = makeBuffer(own, {.name = "a buffer to name", .bytes = 64});
        std::vector<std::byte> back(64);
        ::testing::internal::CaptureStderr();
        downloadBytes(own, unreadable, back); // it was not made with TRANSFER_SRC
        ::testing::internal::GetCapturedStderr();
    }
    ASSERT_FALSE(own.validationMessages().empty());
    EXPECT_NE(own.validationMessages()[0].find("a buffer to name"), std::string::npos) << own.validationMessages()[0];
}

} // namespace
} // namespace relief::test
