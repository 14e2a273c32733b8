// Buffer views that meshoptimizer has compressed, made with its own encoders.
#include <random>

#include <meshoptimizer.h>

#include "gltf_files.h"
#include "meshes.h"

namespace relief::test {
namespace {

using Encoded = std::vector<unsigned char>;

template <typename Value>
Encoded encodedAttributes(const std::vector<Value>& values) {
    Encoded bytes(meshopt_encodeVertexBufferBound(values.size(), sizeof(Value)));
    bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), values.data(), values.size(), sizeof(Value)));
    return bytes;
}

Encoded encodedTriangles(const std::vector<std::uint32_t>& indices, std::size_t vertexCount) {
    Encoded bytes(meshopt_encodeIndexBufferBound(indices.size(), vertexCount));
    bytes.resize(meshopt_encodeIndexBuffer(bytes.data(), bytes.size(), indices.data(), indices.size()));
    return bytes;
}

/// A view of a buffer that is not there, whose bytes the extension has.
int addCompressed(GltfFile& file, const Encoded& bytes, Json extension) {
    const int view = file.addView(bytes);
    Json& json = file.json["bufferViews"][std::size_t(view)];
    extension.update({{"buffer", 0}, {"byteOffset", json["byteOffset"]}, {"byteLength", bytes.size()}});
    const std::size_t length = extension["count"].get<std::size_t>() * extension["byteStride"].get<std::size_t>();
    json = {{"buffer", 1}, {"byteLength", length}, {"extensions", {{"EXT_meshopt_compression", extension}}}};
    return view;
}

/// A torus of which positions, texture coordinates and triangles are compressed, and normals filtered as well.
GltfFile compressedTorus(const DenseMesh& mesh) {
    GltfFile file;
    file.json["extensionsUsed"] =
        file.json["extensionsRequired"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
    file.json["buffers"].push_back({{"byteLength", 1 << 20}});
    const std::size_t count = mesh.positions.size();
    std::vector<std::uint32_t> octahedral(count);
    std::vector<vec4> normals;
    for (const vec3& n : mesh.normals) normals.emplace_back(n, 0.0f);
    meshopt_encodeFilterOct(octahedral.data(), count, 4, 8, &normals[0].x);
    const auto addAccessor = [&](int view, std::size_t elements, const char* type, Component component) {
        file.json["accessors"].push_back(
            {{"bufferView", view}, {"count", elements}, {"type", type}, {"componentType", int(component)}});
        return file.json["accessors"].size() - 1;
    };
    const auto attributes = [&](const Encoded& bytes, int stride, const char* filter) {
        return addCompressed(file, bytes,
                             {{"mode", "ATTRIBUTES"}, {"count", count}, {"byteStride", stride}, {"filter", filter}});
    };
    const int positions = attributes(encodedAttributes(mesh.positions), 12, "NONE");
    const int texCoords = attributes(encodedAttributes(mesh.texCoords), 8, "NONE");
    const int normalView = attributes(encodedAttributes(octahedral), 4, "OCTAHEDRAL");
    const int triangles = addCompressed(file, encodedTriangles(mesh.indices, count),
                                        {{"mode", "TRIANGLES"}, {"count", mesh.indices.size()}, {"byteStride", 4}});
    Json primitive;
    primitive["attributes"]["POSITION"] = addAccessor(positions, count, "VEC3", kFloat);
    primitive["attributes"]["TEXCOORD_0"] = addAccessor(texCoords, count, "VEC2", kFloat);
    primitive["attributes"]["NORMAL"] = addAccessor(normalView, count, "VEC3", kByte);
    file.json["accessors"].back()["normalized"] = true;
    file.json["bufferViews"][std::size_t(normalView)]["byteStride"] = 4;
    primitive["indices"] = addAccessor(triangles, mesh.indices.size(), "SCALAR", kUnsignedInt);
    file.json["meshes"] = {{{"primitives", {primitive}}}};
    file.addNode({{"mesh", 0}});
    return file;
}

DenseMesh torusMesh() { return denseMesh(withIslands(triangleTorus())); }

TEST(GltfMeshopt, readsWhatItHasCompressed) {
    const DenseMesh mesh = torusMesh();
    const TemporaryFolder folder;
    putFile(folder / "a.glb", compressedTorus(mesh).glb());
    const Cage cage = readCage(folder / "a.glb");
    ASSERT_EQ(cage.corners.size(), mesh.indices.size());
    dvec3 sum(0), expected(0); // the codec may turn triangles and reorder nothing else
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        sum += dvec3(cage.positions[cage.corners[i]]), expected += dvec3(mesh.positions[mesh.indices[i]]);
        bool isThere = false;
        for (std::size_t k = i / 3 * 3; k < i / 3 * 3 + 3; ++k)
            isThere |= cage.positions[cage.corners[i]] == mesh.positions[mesh.indices[k]] &&
                       glm::dot(cage.normals[cage.normalCorners[i]], mesh.normals[mesh.indices[k]]) > 0.999f;
        EXPECT_TRUE(isThere) << i;
    }
    EXPECT_EQ(summarize(cage).boundaryEdgeCount, 0u);
}

TEST(GltfMeshopt, refusesWhatTheDecodersCannotDo) {
    const auto refuse = [](const char* place, const Json& value, const std::vector<std::string>& words) {
        GltfFile file = compressedTorus(torusMesh());
        file.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][Json::json_pointer(place)] = value;
        expectRefusedBytes(file.glb(), words, "a.glb");
    };
    const std::string place = "bufferViews/0/extensions/EXT_meshopt_compression";
    refuse("/mode", "LETTERS", {place, "LETTERS", "not known"});
    refuse("/filter", "OCTAHEDRAL", {place, "OCTAHEDRAL", "not known"});
    refuse("/byteStride", 6, {place, "6 bytes", "not known"});
    refuse("/count", 7, {place, "7 elements of 12 bytes"});
    refuse("/byteLength", 40, {place, "decompressed"});
    refuse("/byteLength", 1 << 30, {"buffer view 0 ends"});
    refuse("/buffer", 1, {"buffers/1 has no uri"});
    // Gigabytes for some bytes.
    GltfFile file = compressedTorus(torusMesh());
    Json& view = file.json["bufferViews"][0];
    view["byteLength"] = 12ull * 300'000'000;
    view["extensions"]["EXT_meshopt_compression"]["count"] = 300'000'000;
    expectRefusedBytes(file.glb(), {place, "3.6 GB cannot be in"}, "a.glb");
}

TEST(GltfMeshopt, neverCrashesOnBrokenBytes) {
    const TemporaryFolder folder;
    const GltfFile file = compressedTorus(torusMesh());
    std::mt19937 random(5);
    std::size_t refused = 0;
    for (std::size_t i = 0; i < 300; ++i) {
        GltfFile spoiled = file;
        for (std::size_t flips = 0; flips <= i % 4; ++flips)
            spoiled.bytes[random() % spoiled.bytes.size()] = char(random());
        putFile(folder / "a.glb", spoiled.glb());
        refused += isRead(folder / "a.glb") ? 0 : 1;
    }
    EXPECT_GT(refused, 20u);
}

} // namespace
} // namespace relief::test
