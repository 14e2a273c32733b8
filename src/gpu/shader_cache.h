// Compiled shaders in files, by what they are made of.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

constexpr std::size_t kMostCachedShaders = 1000; ///< about 50 MB

/// The words that were kept under a digest; nothing where there are none or their file is not whole.
std::optional<std::vector<std::uint32_t>> readCachedShader(const Digest& digest);
/// Keeps words, whole or not at all, and the newest kMostCachedShaders of all that were kept. Nothing happens where the
/// folder cannot be written.
void writeCachedShader(const Digest& digest, std::span<const std::uint32_t> words);

} // namespace relief
