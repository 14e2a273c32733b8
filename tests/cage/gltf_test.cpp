// Cages from glTF files.
#include <cmath>

#include "cage/gltf.h"
#include "gltf.h"
#include "meshes.h"

namespace relief::test {
namespace {

const std::vector<vec3> kTriangle = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};

GltfFile triangle(const Json& node = {{"mesh", 0}}) {
    GltfFile file;
    file.addMesh(kTriangle, {0, 1, 2});
    file.addNode(node);
    return file;
}

/// A cube as exporters write it: every side has vertices, a normal and a square of the texture of its own.
GltfFile splitCube() {
    const DenseMesh mesh = denseMesh(cubeOfIslands());
    GltfFile file;
    std::vector<vec3> normals;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const vec3 &a = mesh.positions[mesh.indices[i]], &b = mesh.positions[mesh.indices[i + 1]],
                   &c = mesh.positions[mesh.indices[i + 2]];
        normals.resize(mesh.positions.size());
        for (std::size_t k = 0; k < 3; ++k) normals[mesh.indices[i + k]] = glm::normalize(glm::cross(b - a, c - a));
    }
    file.addMesh(mesh.positions, mesh.indices);
    std::vector<vec2> texCoords = mesh.texCoords;
    for (vec2& st : texCoords) st.y = 1 - st.y;
    const int normal = file.add(normals), texCoord = file.add(texCoords);
    file.attributes()["NORMAL"] = normal;
    file.attributes()["TEXCOORD_0"] = texCoord;
    file.addNode({{"mesh", 0}, {"name", "box"}});
    return file;
}

Cage readBytes(const std::string& bytes, const std::string& name = "a.gltf", const Warn& warn = warnOnStderr) {
    const TemporaryFolder folder;
    putFile(folder / name, bytes);
    return readCage(folder / name, warn);
}

Cage readFileOf(const GltfFile& file, const Warn& warn = warnOnStderr) {
    return readBytes(file.gltf(), "a.gltf", warn);
}

/// Six times the volume that faces enclose, if they look outwards.
double sixVolumes(const Cage& cage) {
    double sum = 0;
    for (std::size_t i = 0; i < cage.corners.size(); i += 3)
        sum += glm::dot(dvec3(cage.positions[cage.corners[i]]), glm::cross(dvec3(cage.positions[cage.corners[i + 1]]),
                                                                           dvec3(cage.positions[cage.corners[i + 2]])));
    return sum;
}

/// In the world.
vec3 positionOf(const Cage& cage, std::size_t vertex) { return cage.coordinates.toWorld(cage.positions[vertex]); }

void expectNear(const vec3& p, const dvec3& expected, double tolerance = 1e-6) {
    EXPECT_LT(glm::length(dvec3(p) - expected), tolerance)
        << fmt::format("({}, {}, {}), ({}, {}, {}) expected", p.x, p.y, p.z, expected.x, expected.y, expected.z);
}

TEST(GltfCage, aCubeSplitAtItsSeamsIsClosed) {
    const Cage cage = readFileOf(splitCube());
    EXPECT_EQ(cage.positions.size(), 8u);
    EXPECT_EQ(cage.faceCount(), 12u);
    EXPECT_TRUE(cage.isAllTriangles());
    const CageSummary summary = summarize(cage);
    EXPECT_EQ(summary.boundaryEdgeCount, 0u);
    EXPECT_EQ(summary.nonManifoldEdgeCount, 0u);
    EXPECT_EQ(summary.edgeCount, 18u);
    EXPECT_EQ(summary.seamEdgeCount, 12u); // not the diagonals
    EXPECT_EQ(cage.texCoords.size(), 24u);
    EXPECT_NEAR(sixVolumes(cage), 6 * 8, 1e-12);
}

TEST(GltfCage, keepsTextureCoordinatesUpAndNormals) {
    const Cage cage = readFileOf(splitCube());
    const DenseMesh mesh = denseMesh(cubeOfIslands());
    ASSERT_EQ(cage.texCorners.size(), mesh.indices.size());
    ASSERT_EQ(cage.normalCorners.size(), mesh.indices.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        EXPECT_EQ(cage.positions[cage.corners[i]], mesh.positions[mesh.indices[i]]);
        EXPECT_LT(glm::length(cage.texCoords[cage.texCorners[i]] - mesh.texCoords[mesh.indices[i]]), 1e-6f);
        const vec3& n = cage.normals[cage.normalCorners[i]];
        EXPECT_EQ(glm::dot(n, cage.positions[cage.corners[i]]), 1); // of a side of the cube from -1 to 1
    }
}

/// Hard edges split vertices without a seam of the texture.
TEST(GltfCage, hardEdgesAreNoSeams) {
    GltfFile file = splitCube();
    const int texCoords = file.add(std::vector<vec2>(24, vec2(0.25f, 0.5f)));
    file.attributes()["TEXCOORD_0"] = texCoords;
    EXPECT_EQ(summarize(readFileOf(file)).seamEdgeCount, 0u);
}

TEST(GltfCage, hasTheTexCoordsThatAreAskedFor) {
    GltfFile file = splitCube();
    const int first = file.add(std::vector<vec2>(24, vec2(0.25f, 0.5f)));
    const int second = file.add(std::vector<vec2>(24, vec2(0.75f, 0.125f)));
    file.attributes()["TEXCOORD_0"] = first, file.attributes()["TEXCOORD_1"] = second;
    const TemporaryFolder folder;
    putFile(folder / "a.gltf", file.gltf());
    EXPECT_EQ(readGltfCage(folder / "a.gltf", warnOnStderr).texCoords.front(), vec2(0.25f, 0.5f));
    EXPECT_EQ(readGltfCage(folder / "a.gltf", warnOnStderr, 1).texCoords.front(), vec2(0.75f, 0.875f));
    expectFailure(Failure::input, {"a.gltf", "TEXCOORD_2"},
                  [&] { (void)readGltfCage(folder / "a.gltf", warnOnStderr, 2); });
}

TEST(GltfCage, isTheSameFromTextFromBytesAndFromTwoFiles) {
    const GltfFile file = splitCube();
    const Cage fromText = readFileOf(file);
    const Cage fromBytes = readBytes(file.glb(), "a.GLB");
    const TemporaryFolder folder;
    Json json = file.json;
    json["buffers"][0] = {{"byteLength", file.bytes.size()}, {"uri", "sub%20folder/./its%20bytes.bin"}};
    std::filesystem::create_directory(folder.path / "sub folder");
    putFile(folder / "sub folder/its bytes.bin", file.bytes);
    putFile(folder / "a.gltf", json.dump(1));
    const Cage fromTwo = readCage(folder / "a.gltf");
    for (const Cage* cage : {&fromBytes, &fromTwo}) {
        EXPECT_EQ(cage->positions, fromText.positions);
        EXPECT_EQ(cage->corners, fromText.corners);
        EXPECT_EQ(cage->texCoords, fromText.texCoords);
        EXPECT_EQ(cage->normalCorners, fromText.normalCorners);
    }
}

TEST(GltfCage, whatReliefWritesReadsBackToTheSameBits) {
    const TemporaryFolder folder;
    const DenseMesh mesh = denseMesh(withIslands(triangleTorus()));
    writeMesh(folder / "a.glb", mesh);
    const Cage cage = readCage(folder / "a.glb");
    ASSERT_EQ(cage.corners.size(), mesh.indices.size());
    for (std::size_t i = 0; i < mesh.indices.size(); ++i)
        EXPECT_EQ(cage.positions[cage.corners[i]], mesh.positions[mesh.indices[i]]);
    EXPECT_EQ(summarize(cage).boundaryEdgeCount, 0u);
}

TEST(GltfCage, standsWhereItsNodesStand) {
    GltfFile file = triangle({{"mesh", 0}, {"translation", {1, 2, 3}}, {"scale", {1, 2, 4}}});
    file.json["nodes"].push_back({{"children", {0}},
                                  {"rotation", {0, 0, std::sqrt(0.5), std::sqrt(0.5)}}, // a quarter round z
                                  {"translation", {10, 0, 0}}});
    // Columns: halves x, moves by (0, 100, 0).
    file.json["nodes"].push_back({{"children", {1}}, {"matrix", {0.5, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 100, 0, 1}}});
    file.json["scenes"][0]["nodes"] = {2};
    const Cage cage = readFileOf(file);
    ASSERT_EQ(cage.positions.size(), 3u);
    // (x, y, z) -> (x + 1, 2 y + 2, 4 z + 3) -> (10 - y, x, z) -> (x / 2, y + 100, z)
    expectNear(positionOf(cage, 0), {4, 101, 3});
    expectNear(positionOf(cage, 1), {4, 102, 3});
    expectNear(positionOf(cage, 2), {3, 101, 3});
}

TEST(GltfCage, looksOutwardsThroughAMirror) {
    GltfFile file = splitCube();
    file.json["nodes"][0]["scale"] = {-2, 1, 1};
    const Cage cage = readFileOf(file);
    EXPECT_NEAR(sixVolumes(cage), 6 * 16, 1e-12);
    for (std::size_t i = 0; i < cage.corners.size(); ++i) {
        const vec3& p = cage.positions[cage.corners[i]];
        EXPECT_GT(glm::dot(cage.normals[cage.normalCorners[i]], p), 0.99f);
    }
}

TEST(GltfCage, makesTrianglesOfStripsAndFans) {
    const std::vector<vec3> square = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {0, 2, 0}};
    GltfFile file;
    file.addMesh(square, {0, 1, 2, 3, 4});
    file.addNode({{"mesh", 0}});
    file.json["meshes"][0]["primitives"][0]["mode"] = 5;
    EXPECT_EQ(readFileOf(file).corners, (Indices{0, 1, 2, 1, 3, 2, 2, 3, 4}));
    file.json["meshes"][0]["primitives"][0]["mode"] = 6;
    EXPECT_EQ(readFileOf(file).corners, (Indices{1, 2, 0, 2, 3, 0, 3, 4, 0}));
    file.json["meshes"][0]["primitives"][0].erase("indices");
    EXPECT_EQ(readFileOf(file).corners, (Indices{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST(GltfCage, primitivesOfOneMeshGrowTogetherAndNodesDoNot) {
    GltfFile file;
    const Json left = file.primitive({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
    Json right = file.primitive({{1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2});
    right["material"] = 1;
    file.json["materials"] = {{{"name", "stone"}},
                              {{"name", "wood"}, {"pbrMetallicRoughness", {{"baseColorFactor", 7}}}}};
    file.json["meshes"] = {{{"name", "mesh"}, {"primitives", {left, right}}}};
    file.addNode({{"mesh", 0}});
    EXPECT_EQ(readFileOf(file).positions.size(), 4u);
    file.addNode({{"mesh", 0}, {"name", "node"}});
    const Cage cage = readFileOf(file);
    EXPECT_EQ(cage.positions.size(), 8u);
    ASSERT_EQ(cage.parts.size(), 4u);
    EXPECT_EQ(cage.parts[0].name, "mesh");
    EXPECT_EQ(cage.parts[3].name, "node");
    EXPECT_EQ(cage.parts[0].material, "");
    EXPECT_EQ(cage.parts[3].material, "wood");
    EXPECT_EQ(cage.parts[3].firstFace, 3u);
}

TEST(GltfCage, bothZerosAreOnePosition) {
    GltfFile file;
    file.addMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0f, 1, -0.0f}, {1, -0.0f, 0}, {1, 1, 0}}, {0, 1, 2, 3, 4, 5});
    file.addNode({{"mesh", 0}});
    EXPECT_EQ(readFileOf(file).positions.size(), 4u);
}

TEST(GltfCage, skipsDegenerateTrianglesWithAWarning) {
    GltfFile file = triangle();
    file.addMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {0, 1, 2, 0, 1, 3, 2, 2, 1});
    file.json["nodes"][0]["mesh"] = 1;
    Warnings warnings;
    EXPECT_EQ(readFileOf(file, warnings.warn()).faceCount(), 1u);
    EXPECT_EQ(warnings.lines.size(), 1u);
    EXPECT_TRUE(warnings.has("2 triangles with two corners that coincide are skipped"));
}

TEST(GltfCage, takesOnlyTheSceneThatIsShown) {
    GltfFile file = triangle();
    file.addNode({{"mesh", 0}, {"translation", {5, 0, 0}}}, false);
    file.json["scenes"].push_back({{"nodes", {1}}});
    EXPECT_EQ(readFileOf(file).positions[0], vec3(0, 0, 0));
    file.json["scene"] = 1;
    EXPECT_EQ(positionOf(readFileOf(file), 0), vec3(5, 0, 0));
    file.json.erase("scene"), file.json.erase("scenes");
    EXPECT_EQ(readFileOf(file).faceCount(), 2u);
}

TEST(GltfCage, readsSmallIntegers) {
    GltfFile file = triangle();
    file.json["extensionsUsed"] = file.json["extensionsRequired"] = {"KHR_mesh_quantization"};
    const int positions =
        file.add(std::vector<std::int16_t>{-32768, 0, 0, 0, 0, 32767, 0, 0, 0, 0, 16384, 0}, "VEC4", kShort, true);
    Json& accessor = file.json["accessors"][std::size_t(positions)]; // four numbers apart, three of them used
    accessor["type"] = "VEC3";
    file.json["bufferViews"].back()["byteStride"] = 8;
    const int texCoords = file.add(std::vector<std::uint16_t>{0, 65535, 65535, 0, 0, 0}, "VEC2", kUnsignedShort, true);
    file.attributes() = {{"POSITION", positions}, {"TEXCOORD_0", texCoords}};
    const int corners = file.add(std::vector<std::uint8_t>{2, 0, 1}, "SCALAR", kUnsignedByte);
    file.json["meshes"][0]["primitives"][0]["indices"] = corners;
    const Cage cage = readFileOf(file);
    EXPECT_EQ(cage.corners, (Indices{2, 0, 1}));
    expectNear(cage.positions[0], {-1, 0, 0}); // -32768 is -1 too
    expectNear(cage.positions[1], {0, 1, 0});
    expectNear(cage.positions[2], {0, 0, 16384.0 / 32767});
    EXPECT_EQ(cage.texCoords, (std::vector<vec2>{{0, 0}, {1, 1}, {0, 1}}));
}

TEST(GltfCage, readsSparsePositions) {
    GltfFile file = triangle();
    Json& accessor = file.json["accessors"][0];
    accessor["sparse"]["count"] = 1;
    accessor["sparse"]["indices"] = {{"bufferView", file.addView(std::vector<std::uint16_t>{1})},
                                     {"componentType", int(kUnsignedShort)}};
    accessor["sparse"]["values"] = {{"bufferView", file.addView(std::vector<vec3>{{7, 8, 9}})}};
    const Cage cage = readFileOf(file);
    EXPECT_EQ(cage.positions[0], vec3(0, 0, 0));
    EXPECT_EQ(cage.positions[1], vec3(7, 8, 9));
}

TEST(GltfCage, textureCoordinatesOfSomeMeshesOnlyAreIgnored) {
    GltfFile file = splitCube();
    file.addMesh(kTriangle, {0, 1, 2});
    file.addNode({{"mesh", 1}});
    Warnings warnings;
    EXPECT_FALSE(readFileOf(file, warnings.warn()).hasTexCoords());
    EXPECT_TRUE(warnings.has("only some of its meshes have texture coordinates"));
}

TEST(GltfCage, pointsAndLinesAreNoSurface) {
    GltfFile file = triangle();
    file.addMesh(kTriangle, {0, 1});
    file.json["meshes"][1]["primitives"][0]["mode"] = 1;
    file.addNode({{"mesh", 1}});
    Warnings warnings;
    EXPECT_EQ(readFileOf(file, warnings.warn()).faceCount(), 1u);
    EXPECT_TRUE(
        warnings.has("points or lines are ignored, only triangles make a surface: 1 (first: meshes/1/primitives/0"));
    file.json["scenes"][0]["nodes"] = {1};
    expectFailure(Failure::input, {"no triangles"}, [&] { readFileOf(file, warnings.warn()); });
}

TEST(GltfCage, neverReadsPicturesAndUnknownMembers) {
    GltfFile file = triangle();
    file.json["images"] = {{{"uri", "../not-there.png"}}, {{"bufferView", 999}, {"mimeType", "image/png"}}, 7};
    file.json["textures"] = "nonsense";
    file.json["cameras"] = {{{"type", "none"}}};
    file.json["extensions"] = {{"KHR_lights_punctual", {{"lights", {1}}}}};
    file.json["nodes"][0]["extras"] = {{"mesh", "no index"}, {"name", 3}};
    file.json["extensionsRequired"] = {"KHR_materials_unlit", "KHR_texture_transform"};
    EXPECT_EQ(readFileOf(file).faceCount(), 1u);
}

} // namespace
} // namespace relief::test
