#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream> // for the source of tinygltf
#include <limits>

#define TINYGLTF_IMPLEMENTATION
#include "cage/gltf_reader.h"

namespace relief {
namespace {

namespace fs = std::filesystem;

/// The largest length that the header of a .glb can state.
constexpr std::uint64_t kLongestFile = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t kGlbMagic = 0x46546C67, kGlbVersion = 2, kGlbJson = 0x4E4F534A, kGlbBytes = 0x004E4942;

// --- binary files (section 4.4) ----------------------------------------------------------------------------------

std::uint32_t wordAt(std::string_view file, std::size_t offset) {
    static_assert(std::endian::native == std::endian::little);
    std::uint32_t number = 0;
    std::memcpy(&number, file.data() + offset, sizeof(number));
    return number;
}

/// The chunk at `offset`, or nothing where the file ends or another kind of chunk follows.
std::optional<std::string_view> chunkAt(std::string_view file, std::size_t offset, std::uint32_t kind,
                                        const std::string& path) {
    if (offset + 8 > file.size() || wordAt(file, offset + 4) != kind) return std::nullopt;
    const std::uint64_t length = wordAt(file, offset), left = file.size() - offset - 8;
    if (length > left)
        fail(Failure::input, "{}: the chunk at byte {} has {} bytes, {} follow; is the file whole?", path, offset,
             length, left);
    return file.substr(offset + 8, length);
}

/// The text of a .glb; its bytes are noted in the document.
std::string_view takeGlbApart(GltfDocument& document) {
    std::string_view file = document.file;
    const std::string& path = document.path;
    if (file.size() >= 8 && wordAt(file, 4) != kGlbVersion)
        fail(Failure::input, "{}: glTF of version {}; relief reads 2.0, so export it again as glTF 2.0", path,
             wordAt(file, 4));
    if (file.size() < 20) fail(Failure::input, "{}: {} bytes; a .glb has 20 or more", path, file.size());
    const std::uint32_t length = wordAt(file, 8);
    if (length < 20 || length > file.size())
        fail(Failure::input, "{}: says that it has {} bytes, there are {}; is it whole?", path, length, file.size());
    file = file.substr(0, length);
    const std::optional<std::string_view> json = chunkAt(file, 12, kGlbJson, path);
    if (!json) fail(Failure::input, "{}: does not begin with a chunk of JSON", path);
    const std::size_t next = 20 + (json->size() + 3) / 4 * 4;
    if (const std::optional<std::string_view> bytes = chunkAt(file, next, kGlbBytes, path)) {
        document.firstByte = next + 8;
        document.byteCount = bytes->size();
    }
    return *json;
}

// --- buffers in other files, or in the text ------------------------------------------------------------------------

bool isDataUri(const std::string& uri) { return uri.starts_with("data:"); }

std::string bytesOfDataUri(const std::string& uri, const GltfElement& from) {
    constexpr std::string_view kBase64 = ";base64,";
    const std::size_t end = uri.find(kBase64);
    if (end == std::string::npos || end > uri.find(','))
        from.fail("its data: URI is no base64; write data:application/octet-stream;base64,...");
    return tinygltf::base64_decode(uri.substr(end + kBase64.size()));
}

/// Decodes %20 and the like (RFC 3986).
std::string withoutPercents(const std::string& uri) {
    const auto digit = [](char c) {
        constexpr std::string_view kDigits = "0123456789abcdef";
        return kDigits.find(char(c >= 'A' && c <= 'F' ? c - 'A' + 'a' : c));
    };
    std::string text;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        const bool isCode = uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) != std::string_view::npos &&
                            digit(uri[i + 2]) != std::string_view::npos;
        text += isCode ? char(16 * digit(uri[i + 1]) + digit(uri[i + 2])) : uri[i];
        if (isCode) i += 2;
    }
    return text;
}

/// The path of a buffer's or a picture's file, which has to be below the folder of the glTF file.
std::string filePath(const std::string& uri, const GltfElement& from) {
    const fs::path folder = fs::path(from.path()).parent_path();
    const fs::path relative = fs::path(withoutPercents(uri)).lexically_normal();
    if (relative.empty() || relative.is_absolute() || *relative.begin() == ".." || relative == "." ||
        !relative.has_filename())
        from.fail("{} does not lie in the file's own folder", printable(uri));
    return (folder / relative).string();
}

/// The first `length` bytes; a file may have more (section 3.6.1.1).
std::string firstBytes(const std::string& path, std::uint64_t length, const GltfElement& buffer) {
    std::error_code error;
    if (!fs::exists(path, error))
        fail(Failure::file, "{}: there is no such file; {} of {} is to be in it", path, buffer.place(), buffer.path());
    const InputFile file(path);
    std::string bytes(std::min(length, file.size()), '\0');
    const std::size_t count = file.read(0, bytes.data(), bytes.size());
    if (count < length)
        fail(Failure::input, "{}: {} bytes, {} of {} has {}; is it whole?", path, count, buffer.place(), buffer.path(),
             length);
    return bytes;
}

std::string readBuffer(const GltfElement& buffer, std::uint64_t length) {
    const std::string uri = buffer.need("uri").text("uri");
    if (!isDataUri(uri)) return firstBytes(filePath(uri, buffer), length, buffer);
    std::string bytes = bytesOfDataUri(uri, buffer);
    if (bytes.size() < length)
        buffer.fail("its data: URI holds {} bytes of {}; is the file whole?", bytes.size(), length);
    return bytes;
}

} // namespace

std::string readGltfPicture(const GltfElement& image) {
    const std::string uri = image.need("uri").text("uri");
    if (isDataUri(uri)) return bytesOfDataUri(uri, image);
    const std::string path = filePath(uri, image);
    return firstBytes(path, InputFile(path).size(), image);
}

GltfElement GltfDocument::entry(const char* list, const char* what, std::uint32_t index,
                                const std::string& place) const {
    const GltfElement all = root();
    const std::size_t count = all.count(list);
    if (index >= count) failAtElement(path, place, "{} {} does not exist; there are {} (from 0)", what, index, count);
    return all.at(list, index);
}

GltfDocument loadGltfDocument(const std::string& path, const Warn& warn) {
    GltfDocument document{.path = path, .json = {}, .file = readFile(path, kLongestFile)};
    document.isBinary = document.file.size() >= 4 && wordAt(document.file, 0) == kGlbMagic;
    const std::string_view text = document.isBinary ? takeGlbApart(document) : std::string_view(document.file);
    document.json = parseGltfJson(text, path, warn);
    if (!document.isBinary) document.file = {};
    return document;
}

GltfBuffers::GltfBuffers(const GltfDocument& document) : document_(document) {}

std::span<const unsigned char> GltfBuffers::buffer(std::uint32_t index, const std::string& place) {
    const GltfElement from = document_.entry("buffers", "buffer", index, place);
    const std::uint64_t length = from.need("byteLength").size("byteLength");
    if (length == 0) fail(Failure::input, "{}: {} has no bytes", document_.path, from.place());
    std::string_view bytes;
    if (document_.isBinary && index == 0 && !from.has("uri")) {
        bytes = std::string_view(document_.file).substr(document_.firstByte, document_.byteCount);
        if (bytes.size() < length)
            from.fail("{} bytes, the binary chunk has {}; is the file whole?", length, bytes.size());
    } else {
        auto found = read_.find(index);
        if (found == read_.end()) found = read_.emplace(index, readBuffer(from, length)).first;
        bytes = found->second;
    }
    return {reinterpret_cast<const unsigned char*>(bytes.data()), length};
}

std::span<const unsigned char> GltfBuffers::part(const GltfElement& from, const std::string& what,
                                                 const std::string& place) {
    const std::uint64_t offset = from.size("byteOffset"), length = from.need("byteLength").size("byteLength");
    const std::uint32_t number = *from.need("buffer").integer("buffer");
    const std::span<const unsigned char> bytes = buffer(number, from.place());
    if (offset + length > bytes.size()) // both of 32 bits
        failAtElement(document_.path, place, "{} ends at byte {} of buffer {}, which has {}", what, offset + length,
                      number, bytes.size());
    return bytes.subspan(offset, length);
}

std::span<const unsigned char> GltfBuffers::view(std::uint32_t index, const std::string& place) {
    const GltfElement from = document_.entry("bufferViews", "buffer view", index, place);
    const std::string what = fmt::format("buffer view {}", index);
    const std::optional<GltfElement> extension = from.extension("EXT_meshopt_compression");
    if (!extension) return part(from, what, place);
    auto found = decompressed_.find(index);
    if (found == decompressed_.end()) {
        const std::uint64_t length = from.need("byteLength").size("byteLength");
        found = decompressed_.emplace(index, decodeMeshopt(*extension, length, part(*extension, what, place))).first;
    }
    return {reinterpret_cast<const unsigned char*>(found->second.data()), found->second.size()};
}

} // namespace relief
