// Internal: what the driver compiled, kept in a file between runs.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <vulkan/vulkan.h>

namespace relief {

/// Whose cache it is: drivers refuse one of another device or version, or should.
struct DriverIdentity {
    std::uint32_t vendor = 0, device = 0, driver = 0, driverVersion = 0;
    std::uint8_t deviceUuid[VK_UUID_SIZE] = {}, driverUuid[VK_UUID_SIZE] = {}, cacheUuid[VK_UUID_SIZE] = {};
};

DriverIdentity identityOf(VkPhysicalDevice physical);

/// The bytes of a file: a header with the identity and a checksum of the data, then the data.
std::string packPipelineCache(const DriverIdentity& identity, std::string_view data);
/// The data of such a file; empty where the file is cut, damaged, or of another device or driver.
std::optional<std::string_view> unpackPipelineCache(const DriverIdentity& identity, std::string_view file);

/// Writes such a file, whole or not at all, and its folder where there is none; does nothing where that fails.
void writePipelineCache(const std::string& path, const DriverIdentity& identity, std::string_view data);

/// The cache that pipelines of one device are made with. It lies in the folder that cacheFolder() names; without one,
/// and where that cannot be read or written, pipelines are compiled each time, without a word.
class PipelineCache {
public:
    PipelineCache(VkDevice device, VkPhysicalDevice physical);
    PipelineCache(const PipelineCache&) = delete;
    PipelineCache& operator=(const PipelineCache&) = delete;
    /// Writes the file, whole or not at all, where pipelines were added.
    ~PipelineCache();

    [[nodiscard]] VkPipelineCache handle() const { return cache_; }
    /// Bytes that the driver was given from the file.
    [[nodiscard]] std::size_t loadedBytes() const { return loadedBytes_; }

private:
    void save() const;

    VkDevice device_;
    DriverIdentity identity_;
    std::string path_; ///< empty: no file
    VkPipelineCache cache_ = VK_NULL_HANDLE;
    std::size_t loadedBytes_ = 0;
    std::size_t firstBytes_ = 0; ///< of the cache before any pipeline was made
};

} // namespace relief
