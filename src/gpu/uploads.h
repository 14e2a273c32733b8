// Internal: uploads that wait for the next submission.
#pragma once

#include "gpu/memory.h"

namespace relief {

/// Bytes for buffers and textures, kept in staging buffers, and textures whose layout is to be changed. Both are
/// recorded ahead of the next commands that are submitted, so that an upload costs no wait of its own; what ends before
/// that is forgotten.
class PendingUploads {
public:
    /// So much staging memory is kept at most: an upload that makes it more is submitted at once.
    static constexpr std::uint64_t kMostStagedBytes = 4 << 20;

    explicit PendingUploads(Device& device) : device_(device) {}

    /// Changes the layout of `range`, all of a new texture, to GENERAL.
    void toGeneral(const Texture& texture, const VkImageSubresourceRange& range);
    void fill(const Buffer& target, std::span<const std::byte> data);
    /// `regions` say where in `data` the texels of each mip are.
    void fill(const Texture& target, std::vector<VkBufferImageCopy> regions, std::span<const std::byte> data);
    /// Drops what is pending for a buffer or texture in this memory.
    void forget(const MemoryRange& target);

    [[nodiscard]] bool isEmpty() const { return images_.empty() && copies_.empty(); }
    [[nodiscard]] std::uint64_t stagedBytes() const { return stagedBytes_; }
    void record(VkCommandBuffer commands) const;
    /// After what was recorded is done.
    void clear();

private:
    struct Image {
        MemoryRange target;
        VkImageMemoryBarrier2 change;
    };
    struct Copy {
        MemoryRange target;
        VkBuffer buffer; ///< or an image
        VkImage image;
        std::vector<VkBufferImageCopy> regions;
        Buffer staging;
        std::uint64_t bytes;
    };
    void add(Copy copy, std::span<const std::byte> data);

    Device& device_;
    std::vector<Image> images_;
    std::vector<Copy> copies_;
    std::uint64_t stagedBytes_ = 0;
};

} // namespace relief
