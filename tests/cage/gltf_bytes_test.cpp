// Buffers beside glTF files, and files with broken bytes.
#include <random>

#include "gltf_files.h"

namespace relief::test {
namespace {

// --- buffers -----------------------------------------------------------------------------------------------------

void expectUriRefused(Failure failure, const Json& uri, const std::vector<std::string>& words) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder.path / "scene");
    const GltfFile file = validFile();
    putFile(folder / "secret.bin", file.bytes);
    Json json = file.json;
    json["buffers"][0] = {{"byteLength", file.bytes.size()}};
    if (!uri.is_null()) json["buffers"][0]["uri"] = uri;
    putFile(folder / "scene/a.gltf", json.dump());
    std::vector<std::string> all = words;
    all.push_back(folder / "scene/a.gltf");
    expectFailure(failure, all, [&] { readCage(folder / "scene/a.gltf"); });
}

TEST(GltfBytes, refuseBuffersOutsideTheFolder) {
    for (const std::string uri : {"../secret.bin", "%2e%2e/secret.bin", "a/../../secret.bin", "./.././secret.bin", "..",
                                  ".", "", "/etc/hostname"})
        expectUriRefused(Failure::input, uri, {"own folder"});
    for (const std::string uri : {"http://127.0.0.1/a.bin", "none.bin", "file:///etc/hostname"})
        expectUriRefused(Failure::file, uri, {"no such file", "buffers/0"});
    expectUriRefused(Failure::input, nullptr, {"buffers/0 has no uri"});
}

TEST(GltfBytes, refuseBuffersThatAreTooShort) {
    const std::string header = "data:application/octet-stream;base64,", bytes = validFile().bytes;
    expectUriRefused(Failure::input, header + base64(bytes.substr(4)), {"buffers/0", "44 bytes of 48"});
    expectUriRefused(Failure::input, header + "////%%%%", {"buffers/0", "3 bytes of 48"});
    expectUriRefused(Failure::input, "data:,", {"buffers/0", "base64"});
    const TemporaryFolder folder;
    Json json = validFile().json;
    json["buffers"][0] = {{"byteLength", bytes.size()}, {"uri", "a.bin"}};
    putFile(folder / "a.gltf", json.dump());
    putFile(folder / "a.bin", bytes.substr(1));
    expectFailure(Failure::input, {folder / "a.bin: 47 bytes", "buffers/0 of " + (folder / "a.gltf"), "48"},
                  [&] { readCage(folder / "a.gltf"); });
    putFile(folder / "a.bin", bytes + "x"); // a buffer may be the first part of a file
    EXPECT_EQ(readCage(folder / "a.gltf").faceCount(), 1u);
    expectFailure(Failure::file, {folder / "b.gltf"}, [&] { readCage(folder / "b.gltf"); });
}

// --- broken bytes ------------------------------------------------------------------------------------------------

TEST(GltfBytes, refuseBinaryFilesThatAreCutOff) {
    const TemporaryFolder folder;
    const std::string file = rich().glb();
    for (std::size_t length = 0; length < file.size(); length += 16) {
        putFile(folder / "a.glb", file.substr(0, length));
        EXPECT_FALSE(isRead(folder / "a.glb")) << length;
    }
    putFile(folder / "a.glb", file + "more");
    EXPECT_TRUE(isRead(folder / "a.glb"));
}

TEST(GltfBytes, refuseBinaryFilesWithWrongHeaders) {
    const TemporaryFolder folder;
    const std::string file = rich().glb();
    const std::uint32_t jsonLength = *reinterpret_cast<const std::uint32_t*>(&file[12]);
    for (const std::size_t offset : {std::size_t(0), std::size_t(4), std::size_t(8), std::size_t(12), std::size_t(16),
                                     20 + std::size_t(jsonLength), 24 + std::size_t(jsonLength)})
        for (const std::uint32_t number : {0u, 1u, 19u, 20u, 0x7fffffffu, 0x80000000u, 0xfffffffcu, 0xffffffffu}) {
            std::string spoiled = file;
            std::memcpy(&spoiled[offset], &number, 4);
            putFile(folder / "a.glb", spoiled);
            EXPECT_FALSE(isRead(folder / "a.glb")) << offset << " " << number;
        }
}

TEST(GltfBytes, neverCrashOnFlippedBytes) {
    const TemporaryFolder folder;
    const std::string file = rich().glb();
    std::mt19937 random(7);
    std::size_t refused = 0;
    for (std::size_t i = 0; i < 300; ++i) {
        std::string spoiled = file;
        constexpr std::string_view kLetters = "0123456789-.eE\"{}[]:,\\ntfu\x01\xff ";
        for (std::size_t flips = 0; flips <= i % 3; ++flips)
            spoiled[20 + random() % (file.size() - 20)] = kLetters[random() % kLetters.size()];
        putFile(folder / "a.glb", spoiled);
        refused += isRead(folder / "a.glb") ? 0 : 1;
    }
    EXPECT_GT(refused, 100u);
}

} // namespace
} // namespace relief::test
