// Internal: compiled shaders in files.
#pragma once

#include "formula/compile.h"

namespace relief {

/// 128 bits of what a shader is made of.
struct Digest {
    std::uint64_t halves[2];

    /// Adds text, and that it ends there.
    void add(std::string_view text);
    [[nodiscard]] std::string name() const; ///< 32 hexadecimal digits
};
/// Of nothing yet.
Digest makeDigest();

/// The words that were kept under a digest; nothing where there are none or their file is not whole.
std::optional<std::vector<std::uint32_t>> readCachedShader(const Digest& digest);
/// Keeps words, whole or not at all. Nothing happens where the folder cannot be written.
void writeCachedShader(const Digest& digest, std::span<const std::uint32_t> words);

} // namespace relief
