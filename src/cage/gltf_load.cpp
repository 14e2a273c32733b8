#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>
#include <fstream> // tinygltf forgets it
#include <limits>

#define TINYGLTF_IMPLEMENTATION
#include "cage/gltf_json.h"
#include "cage/gltf_model.h"

namespace relief {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr std::uint64_t kLongestFile = std::numeric_limits<std::uint32_t>::max(); // what a .glb can say of itself
constexpr std::uint32_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

// --- binary files (section 4.4) ----------------------------------------------------------------------------------

struct Parts {
    std::string_view json, bytes;
    bool isBinary = false;
};

std::uint32_t numberAt(std::string_view file, std::size_t offset) {
    static_assert(std::endian::native == std::endian::little);
    std::uint32_t number = 0;
    std::memcpy(&number, file.data() + offset, sizeof(number));
    return number;
}

/// The chunk at `offset`, or nothing where the file ends or another kind of chunk follows.
std::optional<std::string_view> chunkAt(std::string_view file, std::size_t offset, std::uint32_t kind,
                                        const std::string& path) {
    if (offset + 8 > file.size() || numberAt(file, offset + 4) != kind) return std::nullopt;
    const std::uint64_t length = numberAt(file, offset), left = file.size() - offset - 8;
    if (length > left)
        fail(Failure::input, "{}: the chunk at byte {} has {} bytes, {} follow; is the file whole?", path, offset,
             length, left);
    return file.substr(offset + 8, length);
}

Parts takeApart(std::string_view file, const std::string& path) {
    if (file.size() < 4 || numberAt(file, 0) != kMagic) return {.json = file, .bytes = {}, .isBinary = false};
    if (file.size() < 20) fail(Failure::input, "{}: {} bytes; a .glb has 20 or more", path, file.size());
    if (numberAt(file, 4) != kVersion)
        fail(Failure::input, "{}: glTF of version {}; {} is needed", path, numberAt(file, 4), kVersion);
    const std::uint32_t length = numberAt(file, 8);
    if (length < 20 || length > file.size())
        fail(Failure::input, "{}: says that it has {} bytes, there are {}; is it whole?", path, length, file.size());
    file = file.substr(0, length);
    const std::optional<std::string_view> json = chunkAt(file, 12, kJsonChunk, path);
    if (!json) fail(Failure::input, "{}: does not begin with a chunk of JSON", path);
    const std::size_t next = 20 + (json->size() + 3) / 4 * 4;
    return {.json = *json, .bytes = chunkAt(file, next, kBinChunk, path).value_or(""), .isBinary = true};
}

void append(std::string& file, std::uint32_t number) {
    file.append(reinterpret_cast<const char*>(&number), sizeof(number));
}

/// A binary file of both.
std::string puTogether(std::string json, std::string_view bytes, const std::string& path) {
    json.resize((json.size() + 3) / 4 * 4, ' ');
    const std::uint64_t byteCount = (bytes.size() + 3) / 4 * 4;
    const std::uint64_t length = 20 + json.size() + (bytes.empty() ? 0 : 8 + byteCount);
    if (length > kLongestFile) fail(Failure::input, "{}: {} are too many for a .glb", path, humanBytes(length));
    std::string file;
    file.reserve(length);
    for (const std::uint64_t number : {std::uint64_t(kMagic), std::uint64_t(kVersion), length}) append(file, number);
    append(file, std::uint32_t(json.size())), append(file, kJsonChunk);
    file += json;
    if (bytes.empty()) return file;
    append(file, std::uint32_t(byteCount)), append(file, kBinChunk);
    file += bytes;
    file.resize(length, '\0');
    return file;
}

// --- buffers in other files --------------------------------------------------------------------------------------

/// Where buffers may lie, and how long the longest is.
struct Folder {
    std::string path; ///< the scene's, for messages
    fs::path folder;
    std::uint64_t longest = 0;
};

/// The buffer's place below the folder. tinygltf asks for "FOLDER/NAME", then for "./NAME", which no absolute folder
/// holds.
fs::path placeInside(const std::string& name, const Folder& scene) {
    const fs::path folder = scene.folder.lexically_normal();
    fs::path place = fs::path(name).lexically_normal().lexically_relative(folder);
    if (place.empty() || *place.begin() == ".." || place == ".")
        fail(Failure::input, "{}: buffer {} does not lie in the file's own folder", scene.path,
             printable(place.string()));
    return place;
}

bool isBuffer(const std::string& name, void* data) {
    const Folder& scene = *static_cast<const Folder*>(data);
    const fs::path place = placeInside(name, scene);
    std::error_code error;
    if (!fs::is_regular_file(scene.folder / place, error))
        fail(Failure::file, "{}: buffer {} is not there; it belongs beside the file", scene.path,
             printable(place.string()));
    return true;
}

bool readBuffer(std::vector<unsigned char>* out, std::string*, const std::string& name, void* data) {
    const Folder& scene = *static_cast<const Folder*>(data);
    const std::string bytes = readFile((scene.folder / placeInside(name, scene)).string(), scene.longest);
    out->assign(bytes.begin(), bytes.end());
    return true;
}

std::string unchanged(const std::string& name, void*) { return name; }

/// The longest buffer. What tinygltf would misread: names without bytes, and several buffers in one chunk.
std::uint64_t longestBuffer(const Json& json, bool isBinary, const std::string& path) {
    std::uint64_t longest = 0;
    if (!json.contains("buffers")) return longest;
    for (const auto& [index, buffer] : json["buffers"].items()) {
        const auto length = buffer["byteLength"].get<std::uint64_t>();
        if (length == 0) fail(Failure::input, "{}: buffers/{} has no bytes", path, index);
        if (!buffer.contains("uri") && !(isBinary && index == "0"))
            fail(Failure::input, "{}: buffers/{} has no uri", path, index);
        longest = std::max(longest, length);
    }
    return longest;
}

// --- what is needed ----------------------------------------------------------------------------------------------

/// Extensions that change nothing about shape.
bool isOfLooks(std::string_view extension) {
    constexpr std::string_view kBeginnings[] = {"KHR_materials_", "KHR_texture_", "KHR_lights_",
                                                "EXT_texture_",   "EXT_lights_",  "MSFT_texture_"};
    return std::any_of(std::begin(kBeginnings), std::end(kBeginnings),
                       [&](std::string_view beginning) { return extension.starts_with(beginning); });
}

void checkNeeds(const tinygltf::Model& model, const std::string& path) {
    if (!model.asset.version.starts_with("2."))
        fail(Failure::input, "{}: glTF of version {}; 2.0 is needed", path, printable(model.asset.version));
    for (const std::string& extension : model.extensionsRequired)
        if (extension != "KHR_mesh_quantization" && !isOfLooks(extension))
            fail(Failure::input, "{}: needs the extension {}, which relief does not know; export it without", path,
                 printable(extension));
}

/// tinygltf would read whole materials.
std::vector<std::string> takeMaterialNames(Json& json) {
    std::vector<std::string> names;
    if (!json.contains("materials")) return names;
    for (const Json& material : json["materials"]) names.push_back(material.value("name", ""));
    json.erase("materials");
    return names;
}

} // namespace

GltfModel loadGltfModel(const std::string& path) {
    std::string file = readFile(path, kLongestFile);
    const Parts parts = takeApart(file, path);
    Json json = parseGltfJson(parts.json, path);
    GltfModel result{.path = path, .model = {}, .materials = takeMaterialNames(json)};

    Folder folder{
        .path = path, .folder = fs::absolute(path).parent_path(), .longest = longestBuffer(json, parts.isBinary, path)};
    tinygltf::TinyGLTF reader;
    reader.SetFsCallbacks({&isBuffer, &unchanged, &readBuffer, nullptr, &folder});
    const std::string text = parts.isBinary ? puTogether(json.dump(), parts.bytes, path) : json.dump();
    json = nullptr;
    file.clear(), file.shrink_to_fit();

    std::string error, warning;
    const auto length = static_cast<unsigned int>(text.size());
    const std::string base = folder.folder.string();
    const bool isRead =
        parts.isBinary ? reader.LoadBinaryFromMemory(&result.model, &error, &warning,
                                                     reinterpret_cast<const unsigned char*>(text.data()), length, base)
                       : reader.LoadASCIIFromString(&result.model, &error, &warning, text.data(), length, base);
    if (!isRead) fail(Failure::input, "{}: no valid glTF: {}", path, printable(error));
    checkNeeds(result.model, path);
    return result;
}

} // namespace relief
