// What relief does not read of a glTF file is never a fault; what it cannot draw is said.
#include "gltf_files.h"
#include "meshes.h"

namespace relief::test {
namespace {

Cage readSpoiled(const GltfFile& file, const Warn& warn = warnOnStderr) {
    const TemporaryFolder folder;
    putFile(folder / "a.gltf", file.gltf());
    return readCage(folder / "a.gltf", warn);
}

/// A rich file with this JSON merged into it is read as it is without, and nothing is said.
void expectIgnored(const char* patch) {
    SCOPED_TRACE(patch);
    GltfFile file = rich();
    const Cage before = readSpoiled(file);
    file.json.merge_patch(Json::parse(patch));
    Warnings warnings;
    const Cage after = readSpoiled(file, warnings.warn());
    EXPECT_EQ(after.positions, before.positions);
    EXPECT_EQ(after.corners, before.corners);
    EXPECT_TRUE(warnings.lines.empty());
}

TEST(GltfUnread, partsOfLooksMayHoldAnything) {
    for (const char* materials : {R"([{"name": "skin", "normalTexture": {"index": 0, "scale": 0.6}}])", R"("none")",
                                  R"([7, {"name": 7}])", R"([{"pbrMetallicRoughness": {"scale": "big"}}])"})
        expectIgnored(fmt::format(R"({{"materials": {}}})", materials).c_str());
    expectIgnored(R"({"cameras": 3, "images": [{"uri": 5}], "textures": {"a": 1}, "samplers": [null]})");
    expectIgnored(
        R"({"extras": {"nodes": "none", "count": -1}, "extensions": {"KHR_lights_punctual": {"scale": "x"}}})");
    expectIgnored(R"({"asset": {"generator": 7, "extras": {"version": 1}}})");
}

TEST(GltfUnread, extrasExtensionsAndCamerasOfElementsMayHoldAnything) {
    GltfFile file = rich();
    for (const char* list : {"accessors", "bufferViews", "buffers", "meshes", "nodes", "scenes", "skins"})
        for (Json& element : file.json[list]) {
            element["extras"] = {{"scale", "large"}, {"weights", 7}, {"indices", "none"}, {"nodes", nullptr}};
            element["extensions"] = {{"EXT_of_tomorrow", {{"mesh", -1}, {"bufferView", "x"}}}};
            element["camera"] = "none";
        }
    EXPECT_EQ(readSpoiled(file).faceCount(), 1u);
    for (Json& node : file.json["nodes"]) node["extensions"] = 7, node["name"] = {1, 2};
    EXPECT_EQ(readSpoiled(file).faceCount(), 1u);
}

TEST(GltfUnread, attributesAndArraysThatNobodyAsksForMayHoldAnything) {
    GltfFile file = rich();
    file.attributes()["TANGENT"] = "none";
    file.attributes()["COLOR_0"] = 99;
    file.attributes()["TEXCOORD_1"] = -1;
    file.attributes()["_BATCHID"] = nullptr;
    file.json["meshes"][0]["primitives"][0]["targets"][0]["NORMAL"] = 99;
    file.json["accessors"].push_back({{"type", "VEC9"}, {"count", -1}});
    file.json["accessors"].push_back(7);
    file.json["bufferViews"].push_back({{"buffer", 1}, {"byteLength", 0.5}});
    EXPECT_EQ(readSpoiled(file).faceCount(), 1u);
    // A buffer of pictures that is not there.
    const TemporaryFolder folder;
    Json json = Json::parse(file.gltf());
    json["buffers"].push_back({{"byteLength", 9}, {"uri", "pictures.bin"}});
    putFile(folder / "a.gltf", json.dump());
    EXPECT_EQ(readCage(folder / "a.gltf").faceCount(), 1u);
}

TEST(GltfUnread, meshesSkinsAndNodesThatAreNotShownMayHoldAnything) {
    GltfFile file = rich();
    file.json["meshes"].push_back({{"primitives", {{{"attributes", {{"POSITION", 99}}}}}}});
    file.json["meshes"].push_back("none");
    file.json["skins"].push_back({{"joints", {99}}});
    file.json["nodes"].push_back({{"mesh", 1}, {"scale", "large"}, {"children", {3, 99}}});
    file.json["nodes"].push_back({{"matrix", {1}}, {"rotation", {0, 0, 0, 0}}, {"children", "none"}});
    file.json["scenes"].push_back({{"nodes", "none"}});
    EXPECT_EQ(readSpoiled(file).faceCount(), 1u);
}

TEST(GltfUnread, aBrokenAnimationIsNoFaultOfTheCage) {
    const auto readWith = [](const auto& spoil) {
        GltfFile file = rich();
        spoil(file.json["animations"]);
        EXPECT_EQ(readSpoiled(file).faceCount(), 1u);
    };
    readWith([](Json& all) { all = "none"; });
    readWith([](Json& all) { all[0] = nullptr; });
    readWith([](Json& all) { all[0]["channels"][0]["target"]["node"] = 99; });
    readWith([](Json& all) { all[0]["channels"][0]["sampler"] = 99; });
    readWith([](Json& all) { all[0]["samplers"][0]["input"] = "none"; });
    readWith([](Json& all) { all[0]["samplers"][0]["interpolation"] = "SMOOTH"; });
    // Nor of another animation.
    GltfFile file = rich();
    file.json["animations"].push_back({{"name", "broken"}, {"channels", 7}});
    const TemporaryFolder folder;
    putFile(folder / "a.gltf", file.gltf());
    EXPECT_EQ(readGltf(folder / "a.gltf", "0", warnOnStderr).clip->channels.size(), 1u);
    expectFailure(Failure::input, {"animations/1/channels"},
                  [&] { readGltf(folder / "a.gltf", "broken", warnOnStderr); });
}

TEST(GltfUnread, primitivesWithoutPositionsAreSkippedAndCounted) {
    GltfFile file = rich();
    Json& primitives = file.json["meshes"][0]["primitives"];
    Json empty = primitives[0];
    empty["attributes"].erase("POSITION");
    primitives.push_back(empty);
    primitives.push_back(empty);
    Warnings warnings;
    EXPECT_EQ(readSpoiled(file, warnings.warn()).faceCount(), 1u);
    ASSERT_EQ(warnings.lines.size(), 1u);
    EXPECT_TRUE(warnings.has("primitives without POSITION are skipped: 2 (first: meshes/0/primitives/1)"));
}

TEST(GltfUnread, versionsAndRequiredExtensionsComeBeforeAllElse) {
    const auto expectNamed = [](const char* json, const std::string& name) { expectRefusedBytes(json, {name}); };
    expectNamed(R"({"asset": {"version": "1.1"}, "accessors": {"a": {"bufferView": "v"}}})", "version 1.1");
    expectNamed(R"({"accessors": {"a": {"bufferView": "v"}}, "meshes": {"m": {}}})", "version 1.0");
    expectNamed(R"({"asset": {"version": "2.0"}, "extensionsRequired": ["KHR_meshopt_compression"], "buffers": [7],
        "nodes": 3, "accessors": "none"})",
                "KHR_meshopt_compression");
    std::string glb = rich().glb();
    glb[4] = 1;
    expectRefusedBytes(glb.substr(0, 12), {"version 1;"}, "a.glb");
}

TEST(GltfUnread, extensionsThatChangeShapeOrMotionAreNamed) {
    for (const std::string name : {"EXT_mesh_gpu_instancing", "KHR_animation_pointer"}) {
        GltfFile file = rich();
        file.json["extensionsUsed"] = {"KHR_materials_unlit", name};
        Warnings warnings;
        EXPECT_EQ(readSpoiled(file, warnings.warn()).faceCount(), 1u);
        ASSERT_EQ(warnings.lines.size(), 1u);
        EXPECT_TRUE(warnings.has("the extension " + name + " is ignored: "));
    }
}

TEST(GltfUnread, channelsWithoutANodeAreSkippedAndCounted) {
    GltfFile file = rich();
    Json& channels = file.json["animations"][0]["channels"];
    channels.push_back({{"sampler", 0}, {"target", {{"path", "pointer"}}}});
    const TemporaryFolder folder;
    putFile(folder / "a.gltf", file.gltf());
    Warnings warnings;
    EXPECT_EQ(readGltf(folder / "a.gltf", "", warnings.warn()).clip->channels.size(), 1u);
    EXPECT_TRUE(warnings.has("are ignored: 1 (first: animations/0/channels/1/target)"));
}

/// 400 primitives of 20,000 vertices that each uses three of: their arrays are no longer than that.
TEST(GltfUnread, verticesThatAPrimitiveDoesNotUseAreNotItsOwn) {
    GltfFile file;
    std::vector<vec3> positions;
    for (int i = 0; i < 20'000; ++i) positions.emplace_back(i, i % 7, i % 11);
    const int shared = file.add(positions);
    Json primitives = Json::array();
    for (std::uint32_t i = 0; i < 400; ++i)
        primitives.push_back({{"attributes", {{"POSITION", shared}}},
                              {"indices", file.add(std::vector<std::uint32_t>{3 * i + 5, 3 * i + 2, 19'999})}});
    file.json["meshes"] = {{{"primitives", primitives}}};
    file.addNode({{"mesh", 0}});
    const TemporaryFolder folder;
    putFile(folder / "a.glb", file.glb());
    const GltfScene scene = readGltf(folder / "a.glb", {}, warnOnStderr);
    for (const GltfPrimitive& primitive : scene.meshes[0].primitives) EXPECT_EQ(primitive.positions.size(), 3u);
    EXPECT_EQ(scene.meshes[0].primitives[1].positions[0], vec3(5, 5, 5)); // the file's order
    EXPECT_EQ(scene.meshes[0].primitives[1].triangles, (std::vector<std::uint32_t>{1, 0, 2}));
    EXPECT_EQ(readCage(folder / "a.glb").positions.size(), 402u);
}

/// A mesh without normals is flat (section 3.7.2.1), also where another one has some.
TEST(GltfUnread, trianglesWithoutNormalsAreFlat) {
    GltfFile file;
    file.addMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 1, 2, 0, 3, 1});
    file.addNode({{"mesh", 0}});
    file.addMesh({{5, 0, 0}, {6, 0, 0}, {5, 1, 0}}, {0, 1, 2});
    file.attributes(1)["NORMAL"] = file.add(std::vector<vec3>(3, vec3(1, 0, 0)));
    file.addNode({{"mesh", 1}});
    const DenseMesh mesh = denseMesh(readSpoiled(file));
    ASSERT_EQ(mesh.indices.size(), 9u);
    const vec3 expected[] = {{0, 0, 1}, {0, 1, 0}, {1, 0, 0}};
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(mesh.normals[mesh.indices[i]], expected[i / 3]) << i;
}

} // namespace
} // namespace relief::test
