// Internal: where the bytes of a picture lie, and what PNG and JPEG files say that their readers ignore.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "base/files.h"

namespace relief {

/// The bytes of an encoded picture: a file, or an array that outlives this.
class PictureBytes {
public:
    /// Throws as InputFile does.
    explicit PictureBytes(const std::string& path) : file_(std::make_shared<InputFile>(path)), size_(file_->size()) {}
    explicit PictureBytes(std::span<const unsigned char> bytes) : bytes_(bytes), size_(bytes.size()) {}

    [[nodiscard]] bool isFile() const { return file_ != nullptr; }
    [[nodiscard]] std::span<const unsigned char> inMemory() const { return bytes_; } ///< empty for a file
    [[nodiscard]] std::uint64_t size() const { return size_; }
    /// Copies up to `count` bytes from `offset` on and returns how many; fewer only where they end.
    std::size_t read(std::uint64_t offset, void* target, std::size_t count) const;
    /// Copies all.
    [[nodiscard]] std::string readAll() const;

private:
    std::shared_ptr<const InputFile> file_; ///< shared: copies read the same file
    std::span<const unsigned char> bytes_;
    std::uint64_t size_ = 0;
};

struct PngFacts {
    bool isWhole = false; ///< its chunks run to the end chunk
    std::string colorTag; ///< what says that its numbers are colors: "sRGB", "gamma 2.2", "ICC profile NAME"; else ""
    std::optional<double> noData; ///< the grey that its tRNS chunk makes transparent, as its reader stores greys
};

/// Reads the heads of the chunks of a PNG (Portable Network Graphics, third edition, section 5.3).
PngFacts readPngFacts(const PictureBytes& picture);

/// True when the end marker of a JPEG's own picture is there.
bool jpegHasEnd(const PictureBytes& picture);

} // namespace relief
