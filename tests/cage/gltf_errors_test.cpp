// Every glTF file that is wrong is refused with one line that says where.
#include <cmath>

#include "gltf_files.h"
#include "meshes.h"

namespace relief::test {
namespace {

/// A good file, spoiled.
template <typename Spoil>
void expectGltfRefused(const Spoil& spoil, const std::vector<std::string>& words) {
    GltfFile file = rich();
    spoil(file);
    SCOPED_TRACE(words[0]);
    expectRefusedBytes(file.gltf(), words);
}

/// The accessor that an attribute of the mesh names.
Json& accessorOf(GltfFile& file, const std::string& attribute) {
    return file.json["accessors"][file.attributes()[attribute].get<std::size_t>()];
}

/// Puts other bytes at the front of an attribute's view.
template <typename Value>
void overwrite(GltfFile& file, const Json& accessor, std::size_t index, const Value& value) {
    const Json& view = file.json["bufferViews"][accessor["bufferView"].get<std::size_t>()];
    std::memcpy(&file.bytes[view["byteOffset"].get<std::size_t>() + index * sizeof(Value)], &value, sizeof(Value));
}

TEST(GltfErrors, areNoneForTheFileThatAllOthersVary) {
    const TemporaryFolder folder;
    putFile(folder / "a.gltf", rich().gltf());
    EXPECT_EQ(readCage(folder / "a.gltf").faceCount(), 1u);
}

TEST(GltfErrors, refuseFilesThatAreNotJson) {
    for (const std::string text : {"", " ", "{", "[]", "7", "{}", "{\"asset\": 1}", "solid cube", "\xff\xfe{}", "nul"})
        expectRefusedBytes(text, {});
    expectRefusedBytes("{\"asset\": {\"version\": \"2.0\"},}", {"no valid JSON", "line 1"});
    expectRefusedBytes("{\"asset\": {\"version\": \"1.0\"}}", {"version 1.0"});
    expectRefusedBytes("{\"asset\": {\"version\": \"2.0\"}}", {"no mesh"});
    expectRefusedBytes("{\"asset\": {\"version\": \"2.0\"}, \"extras\": 1e999}", {"no valid JSON"});
    std::string deep = R"({"asset": {"version": "2.0"}, "extras": )";
    deep += std::string(100'000, '[') + std::string(100'000, ']') + "}";
    expectRefusedBytes(deep, {"brackets"});
}

TEST(GltfErrors, refuseMembersOfWrongTypes) {
    expectGltfRefused([](GltfFile& f) { f.json["meshes"] = Json::object(); }, {"meshes must be a list"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][0]["mesh"] = "0"; }, {"nodes/0/mesh must be a whole number"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][0]["mesh"] = -1; }, {"nodes/0/mesh must be a whole number"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][0]["skin"] = 1ull << 32; }, {"nodes/0/skin"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][0]["children"] = {0.5}; }, {"nodes/0/children"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][1]["translation"] = {1, "2", 3}; }, {"nodes/1/translation"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][1]["scale"] = 2; }, {"nodes/1/scale"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["count"] = 2.5; }, {"accessors/0/count"});
    expectGltfRefused([](GltfFile& f) { f.attributes()["POSITION"] = nullptr; }, {"primitives/0/attributes/POSITION"});
    expectGltfRefused([](GltfFile& f) { f.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = "a"; },
                      {"primitives/0/targets/0/POSITION"});
    expectGltfRefused([](GltfFile& f) { f.json["meshes"][0]["primitives"][0]["indices"] = true; },
                      {"primitives/0/indices"});
    expectGltfRefused([](GltfFile& f) { f.json["scenes"][0]["nodes"] = {"a"}; }, {"scenes/0/nodes"});
    expectGltfRefused([](GltfFile& f) { f.json["animations"][0]["channels"][0]["target"] = 3; }, {"animations/0"});
}

TEST(GltfErrors, refuseFilesWithoutMembersThatAreNeeded) {
    expectGltfRefused([](GltfFile& f) { f.json.erase("asset"); }, {"no asset"});
    expectGltfRefused([](GltfFile& f) { f.json["meshes"][0].erase("primitives"); }, {"meshes/0: has no primitives"});
    expectGltfRefused([](GltfFile& f) { f.json["meshes"][0]["primitives"][0].erase("attributes"); }, {"no triangles"});
    expectGltfRefused([](GltfFile& f) { f.attributes().erase("POSITION"); }, {"no triangles"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0].erase("type"); }, {"accessors/0 has no type"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0].erase("bufferView"); }, {"POSITION", "no buffer view"});
    expectGltfRefused([](GltfFile& f) { f.json["skins"][0].erase("joints"); }, {"skins/0 has no joints"});
    expectGltfRefused([](GltfFile& f) { f.json["animations"][0]["samplers"][0].erase("input"); },
                      {"samplers/0 has no input"});
    expectGltfRefused([](GltfFile& f) { f.attributes().erase("JOINTS_0"); }, {"only one of JOINTS_0 and WEIGHTS_0"});
    expectGltfRefused([](GltfFile& f) { f.attributes().erase("JOINTS_0"), f.attributes().erase("WEIGHTS_0"); },
                      {"no JOINTS_0", "node 0"});
    expectGltfRefused([](GltfFile& f) { f.json["scenes"][0]["nodes"] = {1}; }, {"no mesh"});
}

TEST(GltfErrors, refuseIndicesThatDoNotExist) {
    expectGltfRefused([](GltfFile& f) { f.attributes()["POSITION"] = 99; }, {"POSITION", "accessor 99", "there are"});
    expectGltfRefused([](GltfFile& f) { f.attributes()["NORMAL"] = 99; }, {"NORMAL", "accessor 99"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["bufferView"] = 99; }, {"POSITION", "buffer view 99"});
    expectGltfRefused([](GltfFile& f) { f.json["bufferViews"][0]["buffer"] = 1; }, {"bufferViews/0", "buffer 1"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][0]["mesh"] = 1; }, {"nodes/0", "mesh 1", "there are 1"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][0]["skin"] = 1; }, {"nodes/0", "skin 1"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][0]["children"] = {2}; }, {"nodes/0", "child 2"});
    expectGltfRefused([](GltfFile& f) { f.json["skins"][0]["joints"] = {2}; }, {"skins/0", "node 2"});
    expectGltfRefused([](GltfFile& f) { f.json["scene"] = 1; }, {"scene 1"});
    expectGltfRefused([](GltfFile& f) { f.json["scenes"][0]["nodes"] = {0, 7}; }, {"scenes/0", "node 7"});
    expectGltfRefused([](GltfFile& f) { f.json["animations"][0]["channels"][0]["sampler"] = 1; },
                      {"animations/0", "sampler 1"});
    expectGltfRefused([](GltfFile& f) { f.json["animations"][0]["channels"][0]["target"]["node"] = 2; }, {"node 2"});
    expectGltfRefused(
        [](GltfFile& f) {
            overwrite(f, accessorOf(f, "JOINTS_0"), 5, std::uint8_t(1)), //
                overwrite(f, accessorOf(f, "WEIGHTS_0"), 5, 1.0f);
        },
        {"vertex 1 names joint 1", "skin 0 has 1"});
    expectGltfRefused([](GltfFile& f) { overwrite(f, f.json["accessors"][1], 2, 3u); },
                      {"indices", "vertex 3", "there are 3"});
}

TEST(GltfErrors, refuseArraysBeyondTheirBytes) {
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["count"] = 4; },
                      {"POSITION", "end at byte 48", "has 36"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["count"] = 2147483647; }, {"POSITION", "2147483647"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["byteOffset"] = 4; }, {"POSITION", "end at byte 40"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["byteOffset"] = 4294967295u; }, {"POSITION"});
    expectGltfRefused([](GltfFile& f) { f.json["bufferViews"][0]["byteStride"] = 16; }, {"POSITION", "end at byte 44"});
    expectGltfRefused([](GltfFile& f) { f.json["bufferViews"][0]["byteStride"] = 8; }, {"12 bytes every 8 bytes"});
    expectGltfRefused([](GltfFile& f) { f.json["bufferViews"][0]["byteLength"] = 4294967295u; },
                      {"buffer view 0 ends"});
    expectGltfRefused([](GltfFile& f) { f.json["bufferViews"][0]["byteOffset"] = 4294967295u; },
                      {"buffer view 0 ends"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["count"] = 0; }, {"POSITION", "no elements"});
}

TEST(GltfErrors, refuseArraysOfWrongTypes) {
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["type"] = "VEC4"; },
                      {"POSITION", "of VEC4, VEC3 expected"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["type"] = "VEC5"; }, {"VEC5"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["componentType"] = int(kShort); },
                      {"POSITION", "type 5122"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["componentType"] = 5130; }, {"POSITION", "type 5130"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["componentType"] = 5124; }, {"POSITION", "type 5124"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][0]["componentType"] = 3; }, {"POSITION", "type 3"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][1]["componentType"] = int(kFloat); },
                      {"indices", "type 5126"});
    expectGltfRefused([](GltfFile& f) { accessorOf(f, "JOINTS_0")["componentType"] = int(kByte); },
                      {"JOINTS_0", "5120"});
    expectGltfRefused([](GltfFile& f) { accessorOf(f, "WEIGHTS_0")["componentType"] = int(kUnsignedByte); },
                      {"WEIGHTS_0", "plain"}); // bytes, but not normalized
    expectGltfRefused([](GltfFile& f) { f.json["skins"][0]["inverseBindMatrices"] = 0; }, {"skins/0", "MAT4"});
    expectGltfRefused([](GltfFile& f) { f.json["animations"][0]["samplers"][0]["output"] = 0; }, {"output", "VEC4"});
    expectGltfRefused([](GltfFile& f) { f.json["animations"][0]["samplers"][0]["interpolation"] = "SMOOTH"; },
                      {"LINEAR, STEP"});
}

TEST(GltfErrors, refuseCountsThatDiffer) {
    for (const std::string attribute : {"NORMAL", "TEXCOORD_0", "JOINTS_0", "WEIGHTS_0"})
        expectGltfRefused([&](GltfFile& f) { accessorOf(f, attribute)["count"] = 2; },
                          {attribute, "2 elements, 3 expected"});
    expectGltfRefused(
        [](GltfFile& f) {
            f.json["meshes"][0]["primitives"][0]["targets"][0]["POSITION"] = f.add(std::vector<vec3>(2));
        },
        {"targets/0/POSITION", "2 elements, 3 expected"});
    expectGltfRefused([](GltfFile& f) { f.json["meshes"][0]["weights"] = {1, 2}; }, {"2 weights for 1 morph targets"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][0]["weights"] = {1, 2}; }, {"nodes/0", "weights of 2"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][1]["translation"] = {1, 2}; }, {"nodes/1", "translation of 2"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][1]["matrix"] = {1, 2}; }, {"nodes/1", "matrix of 2"});
    expectGltfRefused([](GltfFile& f) { f.json["skins"][0]["joints"] = {1, 1}; }, {"1 matrices for 2 joints"});
    expectGltfRefused([](GltfFile& f) { f.json["accessors"][1]["count"] = 2; }, {"2 corners"});
    expectGltfRefused([](GltfFile& f) { f.json["animations"][0]["samplers"][0]["interpolation"] = "CUBICSPLINE"; },
                      {"output", "2 elements, 6 expected"});
    expectGltfRefused(
        [](GltfFile& f) {
            Json second = f.json["meshes"][0]["primitives"][0];
            second.erase("targets");
            f.json["meshes"][0]["primitives"].push_back(second);
        },
        {"primitives/1: 0 morph targets; the first primitive has 1"});
}

TEST(GltfErrors, refuseNumbersThatAreNotFinite) {
    for (const std::string attribute : {"POSITION", "NORMAL", "TEXCOORD_0", "WEIGHTS_0"})
        for (const float number : {float(NAN), float(INFINITY)})
            expectGltfRefused([&](GltfFile& f) { overwrite(f, accessorOf(f, attribute), 5, number); },
                              {attribute, "not finite"});
    expectGltfRefused([](GltfFile& f) { overwrite(f, accessorOf(f, "WEIGHTS_0"), 5, -1.0f); },
                      {"WEIGHTS_0", "weight -1"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][1]["rotation"] = {0, 0, 0, 0}; }, {"nodes/1", "rotation"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][1]["matrix"] = std::vector<int>(16, 1); },
                      {"nodes/1", "last row"});
    // Finite, but what they make is not.
    expectGltfRefused(
        [](GltfFile& f) {
            f.json["nodes"][1]["scale"] = {1e200, 1e200, 1e200};
        },
        {"vertex", "not finite"});
}

TEST(GltfErrors, refuseKeysThatDoNotRise) {
    expectGltfRefused(
        [](GltfFile& f) {
            f.json["animations"][0]["samplers"][0]["input"] = f.add(std::vector<float>{1, 1});
        },
        {"key 1 is at 1 s", "must rise"});
    expectGltfRefused(
        [](GltfFile& f) {
            f.json["animations"][0]["samplers"][0]["input"] = f.add(std::vector<float>{1, NAN});
        },
        {"input", "not finite"});
    expectGltfRefused(
        [](GltfFile& f) { f.json["animations"][0]["samplers"][0]["output"] = f.add(std::vector<vec4>(2)); },
        {"rotation of key 0"});
    expectGltfRefused(
        [](GltfFile& f) {
            Json& channels = f.json["animations"][0]["channels"];
            channels.push_back(Json(channels[0]));
        },
        {"rotation of node 1 twice"});
    expectGltfRefused(
        [](GltfFile& f) {
            f.json["nodes"][1] = {{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}}};
        },
        {"node 1", "has a matrix"});
}

TEST(GltfErrors, refuseNodesThatAreNotATree) {
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][0]["children"] = {0}; }, {"nodes/0: is below itself"});
    expectGltfRefused([](GltfFile& f) { f.json["nodes"][0]["children"] = {1}, f.json["nodes"][1]["children"] = {0}; },
                      {"nodes/0: is below itself"});
    expectGltfRefused(
        [](GltfFile& f) {
            f.json["nodes"][0]["children"] = {1, 1};
        },
        {"nodes/1: is a child of nodes 0 and 0"});
}

TEST(GltfErrors, refuseSparseArraysThatDoNotFit) {
    const auto spoil = [](const char* what, const Json& value) {
        return [=](GltfFile& f) {
            Json& sparse = f.json["accessors"][0]["sparse"];
            sparse = {
                {"count", 1},
                {"indices",
                 {{"bufferView", f.addView(std::vector<std::uint16_t>{1, 3})}, {"componentType", int(kUnsignedShort)}}},
                {"values", {{"bufferView", f.addView(std::vector<vec3>{{7, 8, 9}})}}}};
            sparse[Json::json_pointer(what)] = value;
        };
    };
    expectGltfRefused(spoil("/count", 0), {"POSITION", "0 sparse elements"});
    expectGltfRefused(spoil("/count", 4), {"POSITION", "4 sparse elements of 3"});
    expectGltfRefused(spoil("/count", 2), {"POSITION", "2 elements end at byte 24"});
    expectGltfRefused(spoil("/indices/byteOffset", 2), {"POSITION", "sparse element 3"});
    expectGltfRefused(spoil("/indices/byteOffset", 4294967295u), {"POSITION"});
    expectGltfRefused(spoil("/values/byteOffset", 4), {"POSITION", "end at byte 16"});
    expectGltfRefused(spoil("/indices/componentType", int(kShort)), {"POSITION", "5122"});
    expectGltfRefused(spoil("/indices/bufferView", 99), {"POSITION", "buffer view 99"});
    expectGltfRefused(spoil("/values", Json::object()), {"bufferView"});
}

TEST(GltfErrors, refuseExtensionsThatAreRequiredAndUnknown) {
    for (const std::string name : {"KHR_meshopt_compression", "KHR_animation_pointer", "EXT_of_tomorrow"})
        expectGltfRefused(
            [&](GltfFile& f) {
                f.json["extensionsRequired"] = {"KHR_materials_unlit", name};
            },
            {name, "export it without"});
}

/// Few bytes whose accessors describe hundreds of gigabytes.
TEST(GltfErrors, refuseFilesThatHoldMoreNumbersThanBytes) {
    GltfFile file;
    std::vector<std::uint32_t> all(9'999);
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = std::uint32_t(i);
    file.addMesh(std::vector<vec3>(10'000, vec3(1)), all);
    file.addNode({{"mesh", 0}});
    file.json["accessors"].push_back({{"componentType", int(kFloat)}, {"count", 10'000}, {"type", "VEC3"}});
    Json targets = Json::array();
    for (int i = 0; i < 20'000; ++i) targets.push_back({{"POSITION", 2}});
    file.json["meshes"][0]["primitives"][0]["targets"] = targets;
    expectRefusedBytes(file.gltf(), {"targets", "more than 536870912 numbers"});
    file.json["meshes"][0]["primitives"][0].erase("targets");
    for (int i = 0; i < 20'000; ++i) file.addNode({{"mesh", 0}});
    expectRefusedBytes(file.gltf(), {"vertices and corners"});
}

} // namespace
} // namespace relief::test
