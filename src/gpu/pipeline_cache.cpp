#include "gpu/pipeline_cache.h"

#include <cstring>
#include <filesystem>
#include <system_error>

#include "base/base.h"

namespace relief {

namespace fs = std::filesystem;

namespace {

constexpr std::uint64_t kMostCacheBytes = 1u << 28;

/// FNV-1a: no defence against forgery, of which a folder of the user's own has no need.
std::uint64_t checksumOf(std::string_view bytes) {
    std::uint64_t sum = 0xcbf29ce484222325u;
    for (const char c : bytes) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
    return sum;
}

/// What a file begins with; all of it is compared.
struct CacheHeader {
    char magic[8];
    std::uint64_t byteCount, checksum; ///< of the data
    DriverIdentity identity;
};
constexpr char kCacheMagic[8] = {'r', 'e', 'l', 'i', 'e', 'f', 'p', '1'};

CacheHeader headerOf(const DriverIdentity& identity, std::string_view data) {
    CacheHeader header{.byteCount = data.size(), .checksum = checksumOf(data), .identity = identity};
    std::memcpy(header.magic, kCacheMagic, sizeof(kCacheMagic));
    return header;
}

/// One file per device and driver.
std::string cachePathOf(const DriverIdentity& identity) {
    const std::string folder = cacheFolder();
    if (folder.empty()) return "";
    const std::string_view bytes(reinterpret_cast<const char*>(&identity), sizeof(identity));
    return fmt::format("{}/pipelines-{:016x}.bin", folder, checksumOf(bytes));
}

std::string readIfThere(const std::string& path) {
    std::error_code ignored;
    if (path.empty() || !fs::is_regular_file(path, ignored)) return "";
    try {
        return readFile(path, kMostCacheBytes);
    } catch (const Error&) { // it went away, or is not readable
        return "";
    }
}

VkPipelineCache makeCache(VkDevice device, std::string_view data) {
    VkPipelineCacheCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_CACHE_CREATE_INFO};
    info.initialDataSize = data.size();
    info.pInitialData = data.data();
    VkPipelineCache cache = VK_NULL_HANDLE;
    return vkCreatePipelineCache(device, &info, nullptr, &cache) == VK_SUCCESS ? cache : VK_NULL_HANDLE;
}

std::size_t sizeOf(VkDevice device, VkPipelineCache cache) {
    std::size_t size = 0;
    return vkGetPipelineCacheData(device, cache, &size, nullptr) == VK_SUCCESS ? size : 0;
}

} // namespace

DriverIdentity identityOf(VkPhysicalDevice physical) {
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    VkPhysicalDeviceIDProperties ids{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES};
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    properties.pNext = &ids;
    ids.pNext = &driver;
    vkGetPhysicalDeviceProperties2(physical, &properties);
    const VkPhysicalDeviceProperties& device = properties.properties;
    DriverIdentity identity{.vendor = device.vendorID,
                            .device = device.deviceID,
                            .driver = std::uint32_t(driver.driverID),
                            .driverVersion = device.driverVersion};
    std::memcpy(identity.deviceUuid, ids.deviceUUID, VK_UUID_SIZE);
    std::memcpy(identity.driverUuid, ids.driverUUID, VK_UUID_SIZE);
    std::memcpy(identity.cacheUuid, device.pipelineCacheUUID, VK_UUID_SIZE);
    return identity;
}

std::string packPipelineCache(const DriverIdentity& identity, std::string_view data) {
    const CacheHeader header = headerOf(identity, data);
    std::string file(reinterpret_cast<const char*>(&header), sizeof(header));
    file += data;
    return file;
}

std::optional<std::string_view> unpackPipelineCache(const DriverIdentity& identity, std::string_view file) {
    if (file.size() < sizeof(CacheHeader)) return {};
    const std::string_view data = file.substr(sizeof(CacheHeader));
    const CacheHeader header = headerOf(identity, data);
    if (std::memcmp(&header, file.data(), sizeof(header)) != 0) return {};
    return data;
}

void writePipelineCache(const std::string& path, const DriverIdentity& identity, std::string_view data) {
    try {
        fs::create_directories(fs::path(path).parent_path());
        writeFile(path, packPipelineCache(identity, data));
    } catch (const std::exception&) { // a full disk, a folder of somebody else: then it is compiled again the next time
    }
}

PipelineCache::PipelineCache(VkDevice device, VkPhysicalDevice physical)
    : device_(device), identity_(identityOf(physical)), path_(cachePathOf(identity_)) {
    if (path_.empty()) return;
    const std::string file = readIfThere(path_);
    const std::string_view data = unpackPipelineCache(identity_, file).value_or(std::string_view());
    cache_ = makeCache(device, data);
    loadedBytes_ = cache_ != VK_NULL_HANDLE ? data.size() : 0;
    if (cache_ != VK_NULL_HANDLE) firstBytes_ = sizeOf(device, cache_);
}

PipelineCache::~PipelineCache() {
    if (cache_ == VK_NULL_HANDLE) return;
    save();
    vkDestroyPipelineCache(device_, cache_, nullptr);
}

void PipelineCache::save() const {
    // A driver that keeps nothing there, such as Mesa's for CPUs, whose own cache has all, always gives as many bytes.
    std::size_t size = sizeOf(device_, cache_);
    if (size <= firstBytes_ || size > kMostCacheBytes) return;
    std::string data(size, '\0');
    if (vkGetPipelineCacheData(device_, cache_, &size, data.data()) != VK_SUCCESS) return;
    data.resize(size);
    writePipelineCache(path_, identity_, data);
}

} // namespace relief
