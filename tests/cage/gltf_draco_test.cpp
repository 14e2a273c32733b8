// Primitives that Draco has compressed, made with its own encoder.
#include <random>

#include <draco/compression/encode.h>
#include <draco/core/varint_encoding.h>

#include "gltf_files.h"
#include "meshes.h"

namespace relief::test {
namespace {

/// A mesh for Draco's encoder, and the primitive of glTF that says what is in it.
class Compressor {
public:
    explicit Compressor(std::size_t vertexCount, const std::vector<std::uint32_t>& triangles)
        : vertexCount_(vertexCount) {
        mesh_.set_num_points(std::uint32_t(vertexCount));
        mesh_.SetNumFaces(triangles.size() / 3);
        for (std::uint32_t t = 0; t < triangles.size() / 3; ++t) {
            draco::Mesh::Face face;
            for (std::size_t k = 0; k < 3; ++k) face[k] = draco::PointIndex(triangles[3 * t + k]);
            mesh_.SetFace(draco::FaceIndex(t), face);
        }
    }

    template <typename Value>
    void add(const std::string& name, draco::GeometryAttribute::Type type, const std::vector<Value>& values,
             draco::DataType number, int width) {
        draco::GeometryAttribute attribute;
        attribute.Init(type, nullptr, std::int8_t(width), number, false, sizeof(Value), 0);
        const int id = mesh_.AddAttribute(attribute, true, std::uint32_t(values.size()));
        for (std::uint32_t i = 0; i < values.size(); ++i)
            mesh_.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[i]);
        extension_["attributes"][name] = mesh_.attribute(id)->unique_id();
    }

    std::string encode(int method) {
        draco::Encoder encoder;
        encoder.SetEncodingMethod(method);
        draco::EncoderBuffer buffer;
        EXPECT_TRUE(encoder.EncodeMeshToBuffer(mesh_, &buffer).ok());
        return {buffer.data(), buffer.size()};
    }

    /// Adds it to the file as the primitive of a mesh: accessors without views, which the extension fills.
    Json primitive(GltfFile& file, int method, const std::vector<std::pair<std::string, Json>>& attributes) {
        const std::string bytes = encode(method);
        extension_["bufferView"] = file.addView(std::vector<char>(bytes.begin(), bytes.end()));
        Json primitive{{"extensions", {{"KHR_draco_mesh_compression", extension_}}}};
        const auto add = [&](Json accessor, std::size_t count) {
            accessor["count"] = count;
            file.json["accessors"].push_back(accessor);
            return file.json["accessors"].size() - 1;
        };
        for (const auto& [name, accessor] : attributes) primitive["attributes"][name] = add(accessor, vertexCount_);
        primitive["indices"] = add({{"type", "SCALAR"}, {"componentType", int(kUnsignedShort)}}, 3 * mesh_.num_faces());
        return primitive;
    }

private:
    std::size_t vertexCount_;
    draco::Mesh mesh_;
    Json extension_;
};

const Json kFloats3{{"type", "VEC3"}, {"componentType", int(kFloat)}},
    kFloats2{{"type", "VEC2"}, {"componentType", int(kFloat)}};

/// A cube with a square of the texture for each side.
GltfFile compressedCube(int method = draco::MESH_EDGEBREAKER_ENCODING) {
    const DenseMesh cube = denseMesh(cubeOfIslands());
    Compressor compressor(cube.positions.size(), cube.indices);
    compressor.add("POSITION", draco::GeometryAttribute::POSITION, cube.positions, draco::DT_FLOAT32, 3);
    compressor.add("TEXCOORD_0", draco::GeometryAttribute::TEX_COORD, cube.texCoords, draco::DT_FLOAT32, 2);
    GltfFile file;
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    const Json primitive = compressor.primitive(file, method, {{"POSITION", kFloats3}, {"TEXCOORD_0", kFloats2}});
    file.json["meshes"] = {{{"primitives", {primitive}}}};
    file.addNode({{"mesh", 0}});
    return file;
}

Json& extensionOf(GltfFile& file) {
    return file.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
}

Cage readCompressed(const GltfFile& file) {
    const TemporaryFolder folder;
    putFile(folder / "a.glb", file.glb());
    return readCage(folder / "a.glb");
}

TEST(GltfDraco, readsWhatEitherMethodHasCompressed) {
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const Cage cage = readCompressed(compressedCube(method));
        const CageSummary summary = summarize(cage);
        EXPECT_EQ(cage.positions.size(), 8u);
        EXPECT_EQ(cage.faceCount(), 12u);
        EXPECT_EQ(summary.boundaryEdgeCount, 0u);
        EXPECT_EQ(summary.seamEdgeCount, 12u);
        EXPECT_EQ(summary.bounds.lower, dvec3(-1));
        EXPECT_EQ(summary.bounds.upper, dvec3(1));
        for (const vec2& st : cage.texCoords) EXPECT_TRUE(st.x >= 0 && st.x <= 1 && st.y >= 0 && st.y <= 1);
    }
}

TEST(GltfDraco, readsWhatStandsBesideTheCompressedData) {
    // Morph targets are never compressed, and an attribute need not be.
    GltfFile file = compressedCube(draco::MESH_SEQUENTIAL_ENCODING);
    Json& primitive = file.json["meshes"][0]["primitives"][0];
    primitive["targets"] = {{{"POSITION", file.add(std::vector<vec3>(24, vec3(0, 0, 5)))}}};
    primitive["attributes"]["NORMAL"] = file.add(std::vector<vec3>(24, vec3(0, 0, 1)));
    file.json["meshes"][0]["weights"] = {1};
    const Cage cage = readCompressed(file);
    EXPECT_EQ(summarize(cage).bounds.upper.z, 6);
    EXPECT_EQ(cage.normalCorners.size(), 36u);
}

TEST(GltfDraco, readsJointsAndWeights) {
    const std::vector<vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    Compressor compressor(3, {0, 1, 2});
    compressor.add("POSITION", draco::GeometryAttribute::POSITION, positions, draco::DT_FLOAT32, 3);
    compressor.add("JOINTS_0", draco::GeometryAttribute::GENERIC, std::vector<std::uint32_t>(3, 0x00000100),
                   draco::DT_UINT8, 4);
    compressor.add("WEIGHTS_0", draco::GeometryAttribute::GENERIC, std::vector<vec4>(3, vec4(0.25f, 0.75f, 0, 0)),
                   draco::DT_FLOAT32, 4);
    GltfFile file;
    const Json joints{{"type", "VEC4"}, {"componentType", int(kUnsignedByte)}},
        weights{{"type", "VEC4"}, {"componentType", int(kFloat)}};
    const Json primitive = compressor.primitive(file, draco::MESH_SEQUENTIAL_ENCODING,
                                                {{"POSITION", kFloats3}, {"JOINTS_0", joints}, {"WEIGHTS_0", weights}});
    file.json["meshes"] = {{{"primitives", {primitive}}}};
    file.addNode({{"mesh", 0}, {"skin", 0}});
    file.addNode({{"translation", {0, 0, 4}}});
    file.json["skins"] = {{{"joints", {0, 1}}}};
    const Cage cage = readCompressed(file);
    for (const vec3& p : cage.positions) EXPECT_NEAR(cage.coordinates.toWorld(p).z, 3, 1e-6);
}

TEST(GltfDraco, refusesCountsThatDiffer) {
    const auto refuse = [](const auto& spoil, const std::vector<std::string>& words) {
        GltfFile file = compressedCube();
        spoil(file);
        expectRefusedBytes(file.glb(), words, "a.glb");
    };
    const std::string place = "meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    refuse([](GltfFile& f) { f.json["accessors"][2]["count"] = 33; }, {place, "12 triangles", "11 expected"});
    refuse([](GltfFile& f) { f.json["accessors"][0]["count"] = f.json["accessors"][1]["count"] = 23; },
           {place, "24 vertices", "23 and 12"});
    refuse([](GltfFile& f) { f.json["accessors"][1]["count"] = 23; }, {"TEXCOORD_0", "23 elements, 24 expected"});
    refuse([](GltfFile& f) { f.json["accessors"][0]["componentType"] = int(kUnsignedShort); }, {"POSITION", "5126"});
    refuse([](GltfFile& f) { f.json["accessors"][1]["type"] = "VEC3"; }, {"TEXCOORD_0", "VEC3"});
    refuse([](GltfFile& f) { extensionOf(f)["attributes"]["POSITION"] = 9; }, {place, "POSITION is attribute 9"});
    refuse([](GltfFile& f) { extensionOf(f)["attributes"]["TEXCOORD_0"] = 0; }, {"TEXCOORD_0", "3 of type"});
    refuse([](GltfFile& f) { extensionOf(f)["bufferView"] = 9; }, {place, "buffer view 9"});
    refuse([](GltfFile& f) { extensionOf(f).erase("bufferView"); }, {place + " has no bufferView"});
    refuse([](GltfFile& f) { extensionOf(f).erase("attributes"); }, {place + " has no attributes"});
    refuse([](GltfFile& f) { f.json["bufferViews"][0]["byteLength"] = 9; }, {place, "no mesh of Draco 2.2"});
    refuse([](GltfFile& f) { f.bytes[0] = 'X'; }, {place, "no mesh of Draco 2.2"});
    refuse([](GltfFile& f) { f.bytes[5] = 1; }, {place, "no mesh of Draco 2.2"});
    refuse([](GltfFile& f) { f.json["meshes"][0]["primitives"][0].erase("indices"); }, {"has no indices"});
}

/// Hundreds of megabytes for a few bytes are refused before they are taken.
TEST(GltfDraco, refusesCountsThatNoBytesCanHold) {
    const auto refuse = [](std::uint32_t faces, const std::string& word) {
        draco::EncoderBuffer counts;
        draco::EncodeVarint(faces, &counts);
        draco::EncodeVarint(3u, &counts); // points
        std::string header =
            std::string("DRACO\x02\x02\x01\x00\x00\x00", 11) + std::string(counts.data(), counts.size());
        header.resize(100, '\0');
        GltfFile file = compressedCube();
        file.json["accessors"][2]["count"] = 3 * faces;
        file.json["accessors"][0]["count"] = file.json["accessors"][1]["count"] = 3;
        extensionOf(file)["bufferView"] = file.addView(std::vector<char>(header.begin(), header.end()));
        expectRefusedBytes(file.glb(), {word}, "a.glb");
    };
    refuse(200'000'000, "200000000 triangles cannot be in 100 bytes");
    refuse(100'000, "Draco cannot decode it");
}

TEST(GltfDraco, neverCrashesOnBrokenBytes) {
    const TemporaryFolder folder;
    std::size_t refused = 0;
    for (const int method : {draco::MESH_SEQUENTIAL_ENCODING, draco::MESH_EDGEBREAKER_ENCODING}) {
        const GltfFile file = compressedCube(method);
        std::mt19937 random(11);
        for (std::size_t i = 0; i < 400; ++i) {
            GltfFile spoiled = file;
            for (std::size_t flips = 0; flips <= i % 4; ++flips)
                spoiled.bytes[random() % spoiled.bytes.size()] = char(random());
            if (i % 5 == 0) spoiled.json["bufferViews"][0]["byteLength"] = random() % spoiled.bytes.size();
            putFile(folder / "a.glb", spoiled.glb());
            refused += isRead(folder / "a.glb") ? 0 : 1;
        }
    }
    EXPECT_GT(refused, 100u);
    EXPECT_LT(refused, 800u);
}

} // namespace
} // namespace relief::test
