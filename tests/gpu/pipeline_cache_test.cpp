// The file of compiled pipelines: what is damaged or somebody else's is ignored.
#include "gpu/pipeline_cache.h"

#include <cstdlib>

#include "gpu/fixture.h"
#include "support.h"

namespace relief::test {
namespace {

DriverIdentity someIdentity() {
    DriverIdentity identity{.vendor = 1, .device = 2, .driver = 3, .driverVersion = 4};
    identity.deviceUuid[5] = 6;
    return identity;
}

TEST(PipelineCacheFile, givesBackWhatWasPacked) {
    const std::string file = packPipelineCache(someIdentity(), "compiled");
    EXPECT_EQ(unpackPipelineCache(someIdentity(), file), "compiled");
}

TEST(PipelineCacheFile, isIgnoredWhereAnyByteIsWrongOrMissing) {
    const std::string file = packPipelineCache(someIdentity(), "compiled");
    for (std::size_t i = 0; i < file.size(); ++i) {
        std::string damaged = file;
        damaged[i] = char(damaged[i] ^ 0x10);
        EXPECT_FALSE(unpackPipelineCache(someIdentity(), damaged)) << i;
        EXPECT_FALSE(unpackPipelineCache(someIdentity(), file.substr(0, i))) << i;
    }
    EXPECT_FALSE(unpackPipelineCache(someIdentity(), file + "x"));
    EXPECT_FALSE(unpackPipelineCache(someIdentity(), ""));
}

TEST(PipelineCacheFile, isIgnoredOnOtherDevicesAndDrivers) {
    const std::string file = packPipelineCache(someIdentity(), "compiled");
    const std::function<void(DriverIdentity&)> changes[] = {
        [](DriverIdentity& other) { other.vendor = 9; },        [](DriverIdentity& other) { other.device = 9; },
        [](DriverIdentity& other) { other.driver = 9; },        [](DriverIdentity& other) { other.driverVersion = 9; },
        [](DriverIdentity& other) { other.deviceUuid[0] = 9; }, [](DriverIdentity& other) { other.driverUuid[0] = 9; },
        [](DriverIdentity& other) { other.cacheUuid[15] = 9; }};
    for (const auto& change : changes) {
        DriverIdentity other = someIdentity();
        change(other);
        EXPECT_FALSE(unpackPipelineCache(other, file));
    }
}

/// RELIEF_CACHE is a folder of its own until the end of the scope.
struct CacheFolder {
    CacheFolder() { setenv("RELIEF_CACHE", folder.path.c_str(), 1); }
    ~CacheFolder() { unsetenv("RELIEF_CACHE"); }
    TemporaryFolder folder;
};

/// The file that the device would read.
std::string cacheFile(const Device& device, const TemporaryFolder& folder) {
    const DriverIdentity identity = identityOf(device.physical());
    std::uint64_t name = 0xcbf29ce484222325u;
    for (std::size_t i = 0; i < sizeof(identity); ++i)
        name = (name ^ reinterpret_cast<const unsigned char*>(&identity)[i]) * 0x100000001b3u;
    return folder / fmt::format("pipelines-{:016x}.bin", name);
}

/// What the driver itself calls an empty cache: its header alone.
std::string emptyCache(const Device& device) {
    std::size_t size = 0;
    const PipelineCache cache(device.handle(), device.physical());
    vkGetPipelineCacheData(device.handle(), cache.handle(), &size, nullptr);
    std::string data(size, '\0');
    vkGetPipelineCacheData(device.handle(), cache.handle(), &size, data.data());
    return data;
}

// What a driver that keeps pipelines would be given back: CPU drivers keep none, so that the bytes are an empty
// cache's.
TEST(PipelineCaches, areReadAgainWhereTheyWereWritten) {
    const CacheFolder cache;
    const Device device;
    const std::string folder = cache.folder / "new", data = emptyCache(device);
    setenv("RELIEF_CACHE", folder.c_str(), 1);
    const std::string path = folder + "/" + std::filesystem::path(cacheFile(device, cache.folder)).filename().string();
    writePipelineCache(path, identityOf(device.physical()), data);
    EXPECT_EQ(readFile(path, 1 << 20), packPipelineCache(identityOf(device.physical()), data));
    EXPECT_EQ(PipelineCache(device.handle(), device.physical()).loadedBytes(), data.size());

    // Where it cannot be written nothing happens, and what is there stays.
    putFile(folder + "/file", "mine");
    writePipelineCache(folder + "/file/pipelines.bin", identityOf(device.physical()), data);
    EXPECT_EQ(readFile(folder + "/file", 1 << 20), "mine");
}

TEST(PipelineCaches, areReadFromTheirFileAndOnlyWhereItIsWhole) {
    const CacheFolder cache;
    const Device device;
    const std::string data = emptyCache(device), path = cacheFile(device, cache.folder);
    const std::string file = packPipelineCache(identityOf(device.physical()), data);
    putFile(path, file);
    EXPECT_EQ(PipelineCache(device.handle(), device.physical()).loadedBytes(), data.size());
    for (const std::string& bad : {file.substr(0, file.size() - 1), std::string("garbage"), std::string()}) {
        putFile(path, bad);
        const PipelineCache read(device.handle(), device.physical());
        EXPECT_EQ(read.loadedBytes(), 0u);
        EXPECT_NE(read.handle(), VkPipelineCache(VK_NULL_HANDLE));
    }
    std::filesystem::remove(path);
    std::filesystem::create_directory(path);
    EXPECT_EQ(PipelineCache(device.handle(), device.physical()).loadedBytes(), 0u);
}

TEST(PipelineCaches, areNoneWhereNoFolderIsWanted) {
    setenv("RELIEF_CACHE", "0", 1);
    const Device device;
    EXPECT_EQ(PipelineCache(device.handle(), device.physical()).handle(), VkPipelineCache(VK_NULL_HANDLE));
    unsetenv("RELIEF_CACHE");
}

} // namespace
} // namespace relief::test
