// glTF files with one of everything, and what becomes of them when they are spoiled.
#pragma once

#include "cage/gltf.h"
#include "gltf.h"

namespace relief::test {

inline GltfFile validFile() {
    GltfFile file;
    file.addMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
    file.addNode({{"mesh", 0}});
    return file;
}

/// A triangle with one of everything that a cage is made of.
inline GltfFile rich() {
    GltfFile file = validFile();
    const int normals = file.add(std::vector<vec3>(3, vec3(0, 0, 1)));
    const int texCoords = file.add(std::vector<vec2>{{0, 0}, {1, 0}, {0, 1}});
    const int joints = file.add(std::vector<std::uint8_t>(12, 0), "VEC4", kUnsignedByte);
    const int weights = file.add(std::vector<vec4>(3, vec4(1, 0, 0, 0)));
    const int offsets = file.add(std::vector<vec3>(3, vec3(0, 0, 1)));
    Json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["attributes"].update(
        {{"NORMAL", normals}, {"TEXCOORD_0", texCoords}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
    primitive["targets"] = {{{"POSITION", offsets}}};
    file.json["nodes"][0]["skin"] = 0;
    file.addNode({{"name", "bone"}, {"translation", {0, 0, 1}}});
    file.json["skins"] = {{{"joints", {1}}, {"inverseBindMatrices", file.add(std::vector<mat4>{mat4(1)})}}};
    file.addChannel(1, "rotation", file.add(std::vector<float>{0, 1}),
                    file.add(std::vector<vec4>{{0, 0, 0, 1}, {0, 0, 1, 0}}));
    return file;
}

/// All that is ever read of a file: its first animation, and its cage.
inline void readAll(const std::string& path) {
    const Warn ignore = [](const std::string&) {};
    readGltf(path, "", ignore);
    readCage(path, ignore);
}

inline void expectRefusedBytes(const std::string& bytes, std::vector<std::string> words,
                               const std::string& name = "a.gltf") {
    const TemporaryFolder folder;
    putFile(folder / name, bytes);
    words.push_back(folder / name);
    expectFailure(Failure::input, words, [&] { readAll(folder / name); });
}

/// Reads, or fails with one line: what it is worth to know is that nothing else happens.
inline bool isRead(const std::string& path) {
    try {
        readAll(path);
        return true;
    } catch (const Error& error) {
        EXPECT_TRUE(error.failure == Failure::input || error.failure == Failure::file) << error.what();
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
        return false;
    }
}

} // namespace relief::test
