// glTF files made in code: arrays become buffer views and accessors, the rest is JSON that a test may spoil.
#pragma once

#include <cstring>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "support.h"

namespace relief::test {

using Json = nlohmann::json;

enum Component { kByte = 5120, kUnsignedByte, kShort, kUnsignedShort, kUnsignedInt = 5125, kFloat };

inline std::string base64(const std::string& bytes) {
    constexpr const char* kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kLetters[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

struct GltfFile {
    Json json = Json::parse(R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": [],
        "meshes": [], "accessors": [], "bufferViews": [], "buffers": [{}]})");
    std::string bytes;

    template <typename Value>
    int addView(const std::vector<Value>& values) {
        bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
        json["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(Value)}});
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value));
        return int(json["bufferViews"].size()) - 1;
    }

    /// An accessor of all values.
    template <typename Value>
    int add(const std::vector<Value>& values, const std::string& type, Component component, bool isNormalized = false) {
        const std::size_t width = type == "SCALAR" ? 1 : type == "MAT4" ? 16 : std::size_t(type[3] - '0');
        const std::size_t numbers = values.size() * sizeof(Value) / sizeOf(component);
        json["accessors"].push_back({{"bufferView", addView(values)},
                                     {"componentType", int(component)},
                                     {"count", numbers / width},
                                     {"type", type}});
        if (isNormalized) json["accessors"].back()["normalized"] = true;
        return int(json["accessors"].size()) - 1;
    }
    int add(const std::vector<vec3>& values) { return add(values, "VEC3", kFloat); }
    int add(const std::vector<vec2>& values) { return add(values, "VEC2", kFloat); }
    int add(const std::vector<vec4>& values) { return add(values, "VEC4", kFloat); }
    int add(const std::vector<mat4>& values) { return add(values, "MAT4", kFloat); }
    int add(const std::vector<float>& values) { return add(values, "SCALAR", kFloat); }
    int add(const std::vector<std::uint32_t>& values) { return add(values, "SCALAR", kUnsignedInt); }

    /// A mesh of one primitive with these positions and triangles; more is added to its JSON.
    int addMesh(const std::vector<vec3>& positions, const std::vector<std::uint32_t>& triangles) {
        json["meshes"].push_back({{"primitives", {primitive(positions, triangles)}}});
        return int(json["meshes"].size()) - 1;
    }
    Json primitive(const std::vector<vec3>& positions, const std::vector<std::uint32_t>& triangles) {
        return {{"attributes", {{"POSITION", add(positions)}}}, {"indices", add(triangles)}};
    }
    Json& attributes(int mesh = 0) { return json["meshes"][std::size_t(mesh)]["primitives"][0]["attributes"]; }

    int addNode(const Json& node, bool isRoot = true) {
        json["nodes"].push_back(node);
        const int index = int(json["nodes"].size()) - 1;
        if (isRoot) json["scenes"][0]["nodes"].push_back(index);
        return index;
    }

    /// Keys of one property of a node, in the animation of that number.
    void addChannel(int node, const std::string& path, int input, int output,
                    const std::string& interpolation = "LINEAR", std::size_t clip = 0) {
        Json& animation = json["animations"][clip];
        const std::size_t sampler = animation["samplers"].size();
        animation["samplers"].push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
        animation["channels"].push_back({{"sampler", sampler}, {"target", {{"node", node}, {"path", path}}}});
    }

    [[nodiscard]] std::string gltf() const {
        Json all = json;
        all["buffers"][0]["byteLength"] = bytes.size();
        all["buffers"][0]["uri"] = "data:application/octet-stream;base64," + base64(bytes);
        return all.dump();
    }
    [[nodiscard]] std::string glb() const {
        Json all = json;
        all["buffers"][0]["byteLength"] = bytes.size();
        std::string text = all.dump(), data = bytes;
        text.resize((text.size() + 3) / 4 * 4, ' ');
        data.resize((data.size() + 3) / 4 * 4, '\0');
        std::string file = "glTF";
        for (const std::size_t number : {std::size_t(2), 28 + text.size() + data.size(), text.size()})
            append(file, number);
        file += "JSON" + text;
        append(file, data.size());
        return file + std::string("BIN\0", 4) + data;
    }

    static void append(std::string& file, std::size_t number) {
        const auto bits = std::uint32_t(number);
        file.append(reinterpret_cast<const char*>(&bits), sizeof(bits));
    }
    static std::size_t sizeOf(Component component) {
        return component <= kUnsignedByte ? 1 : component <= kUnsignedShort ? 2 : 4;
    }
};

} // namespace relief::test
