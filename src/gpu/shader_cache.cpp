#include "gpu/shader_cache.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <utility>

#include "base/base.h"

namespace relief {

namespace fs = std::filesystem;

namespace {

/// FNV-1a with two offsets: no defence against forgery, of which a folder of the user's own has no need.
constexpr std::uint64_t kOffsets[2] = {0xcbf29ce484222325u, 0x84222325cbf29ce4u}, kPrime = 0x100000001b3u;

/// What a file begins with; its words follow.
struct Header {
    char magic[8];
    std::uint64_t digest[2];
    std::uint64_t wordCount;
    std::uint64_t checksum[2]; ///< of the words
};
constexpr char kMagic[8] = {'r', 'e', 'l', 'i', 'e', 'f', 's', '1'};
constexpr std::uint64_t kMostBytes = 1u << 26;

Digest checksumOf(std::span<const std::uint32_t> words) {
    Digest digest = makeDigest();
    digest.add({reinterpret_cast<const char*>(words.data()), words.size_bytes()});
    return digest;
}

Header headerOf(const Digest& digest, std::span<const std::uint32_t> words) {
    Header header{.wordCount = words.size()};
    const Digest checksum = checksumOf(words);
    std::memcpy(header.magic, kMagic, sizeof(kMagic));
    std::memcpy(header.digest, digest.halves, sizeof(header.digest));
    std::memcpy(header.checksum, checksum.halves, sizeof(header.checksum));
    return header;
}

std::string pathOf(const Digest& digest) { return cacheFolder() + "/" + digest.name() + ".spv"; }

/// Removes the older half where there are too many. Another process may be doing the same.
void removeOldShaders(const fs::path& folder) {
    std::error_code ignored;
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, ignored))
        if (entry.path().extension() == ".spv") files.emplace_back(entry.last_write_time(ignored), entry.path());
    if (files.size() <= kMostCachedShaders) return;
    std::ranges::sort(files);
    files.resize(files.size() / 2);
    for (const auto& [time, path] : files) fs::remove(path, ignored);
}

} // namespace

Digest makeDigest() { return {kOffsets[0], kOffsets[1]}; }

void Digest::add(std::string_view text) {
    for (std::uint64_t& half : halves) {
        for (const char c : text) half = (half ^ static_cast<unsigned char>(c)) * kPrime;
        half = (half ^ text.size()) * kPrime;
    }
    halves[1] ^= halves[0] >> 32; // else the two would differ by their offsets alone
}

std::string Digest::name() const { return fmt::format("{:016x}{:016x}", halves[0], halves[1]); }

std::optional<std::vector<std::uint32_t>> readCachedShader(const Digest& digest) {
    if (cacheFolder().empty()) return {};
    std::string bytes;
    std::error_code ignored;
    if (!fs::is_regular_file(pathOf(digest), ignored)) return {};
    try {
        bytes = readFile(pathOf(digest), kMostBytes);
    } catch (const Error&) { // it went away, or is not readable
        return {};
    }
    // The file is what would be written of its words, to the byte.
    if (bytes.size() < sizeof(Header) || (bytes.size() - sizeof(Header)) % 4 != 0) return {};
    std::vector<std::uint32_t> words((bytes.size() - sizeof(Header)) / 4);
    std::memcpy(words.data(), bytes.data() + sizeof(Header), words.size() * 4);
    const Header header = headerOf(digest, words);
    if (std::memcmp(&header, bytes.data(), sizeof(Header)) != 0) return {};
    return words;
}

void writeCachedShader(const Digest& digest, std::span<const std::uint32_t> words) {
    const std::string folder = cacheFolder();
    std::error_code error;
    if (folder.empty() || (fs::create_directories(folder, error), error)) return;
    const Header header = headerOf(digest, words);
    std::string bytes(reinterpret_cast<const char*>(&header), sizeof(header));
    bytes.append(reinterpret_cast<const char*>(words.data()), words.size_bytes());
    try {
        writeFile(pathOf(digest), bytes);
        removeOldShaders(folder);
    } catch (const Error&) { // a full disk, a folder of somebody else: then it is compiled again the next time
    }
}

} // namespace relief
