// glTF 2.0, binary: a header, a chunk of JSON that names the parts of a chunk of bytes. Written without tinygltf, which
// needs all vertices as one byte array and copies that once more before it writes: three times the mesh in memory.
#include <nlohmann/json.hpp>

#include "mesh/write.h"

namespace relief {

namespace {

using OrderedJson = nlohmann::ordered_json; // "asset" comes first, as readers and people expect

// Numbers of the specification: component types and buffer targets are OpenGL's.
constexpr int kFloat = 5126, kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr std::uint64_t kMagic = 0x46546C67, kVersion = 2, kJsonChunk = 0x4E4F534A, kBinChunk = 0x004E4942;

/// Normalises a normal as well as floats can (the validator allows 5e-4); (0,1,0) where it has no direction.
vec3 unitNormal(const vec3& normal) {
    const dvec3 n(normal);
    return glm::dot(n, n) > 0 ? vec3(glm::normalize(n)) : vec3(0, 1, 0);
}

/// The arrays of the chunk of bytes, one after the other. All hold 4-byte values, so all begin at multiples of 4.
struct Arrays {
    OrderedJson views = OrderedJson::array(), accessors = OrderedJson::array();
    std::uint64_t byteCount = 0;

    void add(int target, std::uint64_t bytes, OrderedJson accessor) {
        accessor["bufferView"] = views.size();
        accessors.push_back(std::move(accessor));
        views.push_back({{"buffer", 0}, {"byteOffset", byteCount}, {"byteLength", bytes}, {"target", target}});
        byteCount += bytes;
    }
};

OrderedJson accessorOf(const char* type, int componentType, std::uint64_t count) {
    return {{"type", type}, {"componentType", componentType}, {"count", count}};
}

OrderedJson positionAccessor(const DenseMesh& mesh) {
    const Bounds bounds = computeBounds(mesh.positions);
    OrderedJson accessor = accessorOf("VEC3", kFloat, mesh.positions.size());
    accessor["min"] = {bounds.lower.x, bounds.lower.y, bounds.lower.z};
    accessor["max"] = {bounds.upper.x, bounds.upper.y, bounds.upper.z};
    return accessor;
}

Arrays arraysOf(const DenseMesh& mesh, std::uint64_t triangleCount) {
    const std::uint64_t count = mesh.positions.size();
    Arrays arrays;
    arrays.add(kElementArrayBuffer, 12 * triangleCount, accessorOf("SCALAR", kUnsignedInt, 3 * triangleCount));
    arrays.add(kArrayBuffer, 12 * count, positionAccessor(mesh));
    arrays.add(kArrayBuffer, 12 * count, accessorOf("VEC3", kFloat, count));
    if (!mesh.texCoords.empty()) arrays.add(kArrayBuffer, 8 * count, accessorOf("VEC2", kFloat, count));
    return arrays;
}

/// What does not depend on the mesh. The default material, a perfect metal, is black in viewers that have no
/// surroundings to mirror.
constexpr const char* kScene = R"({
    "asset": {"version": "2.0", "generator": "relief"},
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 1, "NORMAL": 2}, "indices": 0, "material": 0}]}],
    "materials": [{"pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0.5}, "doubleSided": true}]
})";

/// The JSON chunk, filled up with spaces to a multiple of 4.
std::string describe(const DenseMesh& mesh, const Arrays& arrays) {
    OrderedJson gltf = OrderedJson::parse(kScene);
    const Coordinates& c = mesh.coordinates;
    if (c.origin != dvec3(0)) gltf["nodes"][0]["translation"] = {c.origin.x, c.origin.y, c.origin.z};
    if (c.unit != 1) gltf["nodes"][0]["scale"] = {c.unit, c.unit, c.unit};
    if (!mesh.texCoords.empty()) gltf["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = 3;
    gltf["accessors"] = arrays.accessors;
    gltf["bufferViews"] = arrays.views;
    gltf["buffers"][0]["byteLength"] = arrays.byteCount;
    std::string text = gltf.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    return text;
}

/// Everything in front of the arrays. Sizes fit 32 bits, as checkMeshSize has checked.
void putHeaders(MeshFile& file, const std::string& json, const Arrays& arrays) {
    const std::uint64_t length = 12 + 8 + json.size() + 8 + arrays.byteCount;
    for (const std::uint64_t number : {kMagic, kVersion, length}) file.putValue(std::uint32_t(number));
    for (const std::uint64_t number : {std::uint64_t(json.size()), kJsonChunk}) file.putValue(std::uint32_t(number));
    file.put(json);
    for (const std::uint64_t number : {arrays.byteCount, kBinChunk}) file.putValue(std::uint32_t(number));
}

} // namespace

void writeGlb(MeshFile& file, const DenseMesh& mesh, ShowProgress show) {
    const std::size_t vertexCount = mesh.positions.size();
    const Arrays arrays = arraysOf(mesh, soundTriangleCount(mesh, file.path()));
    Progress progress("writing", mesh.indices.size() / 3 + 2 * vertexCount + mesh.texCoords.size(), show);

    putHeaders(file, describe(mesh, arrays), arrays);
    putEach(mesh.indices.size() / 3, progress, [&](std::size_t i) {
        if (isDegenerate(mesh, i)) return;
        for (std::size_t k = 0; k < 3; ++k) file.putValue(mesh.indices[3 * i + k]);
    });
    putEach(vertexCount, progress, [&](std::size_t i) { file.putValue(mesh.positions[i]); });
    putEach(vertexCount, progress, [&](std::size_t i) { file.putValue(unitNormal(mesh.normals[i])); });
    putEach(mesh.texCoords.size(), progress, [&](std::size_t i) { // glTF's t runs down the picture, ours up
        file.putValue(vec2(mesh.texCoords[i].x, 1 - mesh.texCoords[i].y));
    });
}

} // namespace relief
