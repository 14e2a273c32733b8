// Dense meshes in files, read back by hand.
#include <bit>
#include <cstring>
#include <limits>
#include <random>
#include <span>

#include <nlohmann/json.hpp>

#include "meshes.h"
#include "support.h"

namespace relief::test {
namespace {

/// Two triangles of a square, with awkward numbers.
DenseMesh square() {
    DenseMesh mesh;
    mesh.positions = {{0, 0, -0.0f}, {1.1f, 0, 1e-30f}, {1, 1e10f, 0}, {0, 1, 1.0f / 3}};
    mesh.normals = {{0, 0, 1}, {0, 0, 2}, {0, 1, 1}, {0, 0, 0}};
    mesh.texCoords = {{0, 0.25f}, {1, 0}, {1, 1}, {0, 2}};
    mesh.indices = {0, 1, 2, 0, 2, 3};
    return mesh;
}

DenseMesh squareWithoutTexCoords() {
    DenseMesh mesh = square();
    mesh.texCoords.clear();
    return mesh;
}

/// A waved sheet of 2 * side * side triangles.
DenseMesh sheet(std::uint32_t side) {
    DenseMesh mesh;
    for (std::uint32_t j = 0; j <= side; ++j)
        for (std::uint32_t i = 0; i <= side; ++i) {
            const vec2 st(float(i) / float(side), float(j) / float(side));
            mesh.positions.emplace_back(st.x, 0.05f * std::sin(40 * st.x) * std::cos(31 * st.y), st.y);
            mesh.normals.push_back(glm::normalize(vec3(-2 * std::cos(40 * st.x) * std::cos(31 * st.y), 1,
                                                       1.55f * std::sin(40 * st.x) * std::sin(31 * st.y))));
            mesh.texCoords.push_back(st);
        }
    for (std::uint32_t j = 0; j < side; ++j)
        for (std::uint32_t i = 0; i < side; ++i) {
            const std::uint32_t a = j * (side + 1) + i, b = a + 1, c = a + side + 1, d = c + 1;
            mesh.indices.insert(mesh.indices.end(), {a, c, b, b, c, d});
        }
    return mesh;
}

std::string written(const DenseMesh& mesh, const std::string& name) {
    const TemporaryFolder folder;
    writeMesh(folder / name, mesh);
    EXPECT_EQ(folder.fileCount(), 1u);
    return readFile(folder / name);
}

/// Takes values off the front of bytes.
struct Bytes {
    std::string_view rest;

    template <typename Value>
    Value take() {
        Value value{};
        EXPECT_GE(rest.size(), sizeof(Value));
        std::memcpy(&value, rest.data(), std::min(sizeof(Value), rest.size()));
        rest.remove_prefix(std::min(sizeof(Value), rest.size()));
        return value;
    }
};

template <typename Vector>
void expectSameBits(const std::vector<Vector>& a, const std::vector<Vector>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int k = 0; k < Vector::length(); ++k)
            ASSERT_EQ(std::bit_cast<std::uint32_t>(a[i][k]), std::bit_cast<std::uint32_t>(b[i][k]))
                << "value " << k << " of " << i << ": " << a[i][k] << " and " << b[i][k];
}

// --- PLY --------------------------------------------------------------------------------------------------------

void expectPly(const DenseMesh& mesh, const std::string& textureLines) {
    const std::string bytes = written(mesh, "a.ply");
    const std::string header =
        fmt::format("ply\nformat binary_little_endian 1.0\ncomment written by relief\nelement vertex {}\n"
                    "property float x\nproperty float y\nproperty float z\n"
                    "property float nx\nproperty float ny\nproperty float nz\n{}"
                    "element face {}\nproperty list uchar uint vertex_indices\nend_header\n",
                    mesh.positions.size(), textureLines, mesh.indices.size() / 3);
    ASSERT_EQ(bytes.substr(0, header.size()), header);
    Bytes body{std::string_view(bytes).substr(header.size())};
    DenseMesh read;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        read.positions.push_back(body.take<vec3>());
        read.normals.push_back(body.take<vec3>());
        if (!textureLines.empty()) read.texCoords.push_back(body.take<vec2>());
    }
    for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
        if (i % 3 == 0) {
            EXPECT_EQ(body.take<std::uint8_t>(), 3);
        }
        read.indices.push_back(body.take<std::uint32_t>());
    }
    EXPECT_EQ(body.rest, "");
    expectSameBits(read.positions, mesh.positions);
    expectSameBits(read.normals, mesh.normals);
    expectSameBits(read.texCoords, mesh.texCoords);
    EXPECT_EQ(read.indices, mesh.indices);
}

TEST(WritePly, holdsTheArraysBitByBit) {
    expectPly(square(), "property float s\nproperty float t\n");
    expectPly(sheet(300), "property float s\nproperty float t\n"); // longer than the buffer
}

TEST(WritePly, omitsTextureCoordinatesThatAreNotThere) { expectPly(squareWithoutTexCoords(), ""); }

// --- OBJ --------------------------------------------------------------------------------------------------------

void expectObjRoundTrip(const DenseMesh& mesh) {
    const Cage cage = parseObj(written(mesh, "a.obj"), "a.obj");
    if (cage.coordinates.isIdentity()) expectSameBits(cage.positions, mesh.positions);
    // In a unit of its own the smallest numbers are fewer.
    ASSERT_EQ(cage.positions.size(), mesh.positions.size());
    const double smallest = cage.coordinates.unit * std::numeric_limits<float>::denorm_min();
    for (std::size_t i = 0; i < cage.positions.size(); ++i)
        for (int k = 0; k < 3; ++k)
            ASSERT_NEAR(cage.coordinates.toWorld(cage.positions[i])[k], mesh.positions[i][k], smallest) << i;
    expectSameBits(cage.normals, mesh.normals);
    expectSameBits(cage.texCoords, mesh.texCoords);
    EXPECT_EQ(cage.faceSizes, Indices(mesh.indices.size() / 3, 3));
    EXPECT_EQ(cage.corners, mesh.indices);
    EXPECT_EQ(cage.normalCorners, mesh.indices);
    EXPECT_EQ(cage.texCorners, mesh.texCoords.empty() ? Indices() : mesh.indices);
}

TEST(WriteDenseObj, isPlainObj) {
    DenseMesh mesh = square();
    mesh.indices = {0, 1, 2};
    EXPECT_EQ(written(mesh, "a.obj"), "v 0 0 -0\nv 1.1 0 1e-30\nv 1 1e+10 0\nv 0 1 0.33333334\n"
                                      "vt 0 0.25\nvt 1 0\nvt 1 1\nvt 0 2\n"
                                      "vn 0 0 1\nvn 0 0 2\nvn 0 1 1\nvn 0 0 0\n"
                                      "f 1/1/1 2/2/2 3/3/3\n");
    mesh.texCoords.clear();
    EXPECT_TRUE(written(mesh, "a.obj").ends_with("vn 0 0 0\nf 1//1 2//2 3//3\n"));
}

TEST(WriteDenseObj, readsBackToTheSameBits) {
    expectObjRoundTrip(square());
    expectObjRoundTrip(squareWithoutTexCoords());
    expectObjRoundTrip(sheet(200));
}

TEST(WriteDenseObj, readsBackToTheSameBitsWhateverTheNumbers) {
    DenseMesh mesh = sheet(100);
    std::mt19937 random(1);
    for (vec3& p : mesh.positions)
        for (int k = 0; k < 3; ++k) do
                p[k] = std::bit_cast<float>(std::uint32_t(random()));
            while (!std::isfinite(p[k]));
    expectObjRoundTrip(mesh);
}

TEST(WriteDenseObj, omitsTrianglesThatNameAVertexTwice) {
    DenseMesh mesh = square();
    mesh.indices = {0, 0, 1, 0, 1, 2, 1, 2, 2, 3, 1, 3, 0, 2, 3};
    EXPECT_EQ(parseObj(written(mesh, "a.obj"), "a.obj").corners, square().indices);
    mesh.indices = {0, 0, 1};
    expectFailure(Failure::input, {"a.obj", "twice"}, [&] { written(mesh, "a.obj"); });
}

// --- glTF -------------------------------------------------------------------------------------------------------

/// A .glb taken apart: what the JSON says and what the bytes hold.
struct Glb {
    nlohmann::json json;
    std::string bytes;

    explicit Glb(const std::string& file) {
        Bytes rest{file};
        EXPECT_EQ(rest.take<std::uint32_t>(), 0x46546C67u); // "glTF"
        EXPECT_EQ(rest.take<std::uint32_t>(), 2u);
        EXPECT_EQ(rest.take<std::uint32_t>(), file.size());
        json = nlohmann::json::parse(chunk(rest, "JSON"));
        bytes = chunk(rest, std::string("BIN\0", 4));
        EXPECT_EQ(rest.rest, "");
        EXPECT_EQ(json.at("buffers"), nlohmann::json::parse(fmt::format(R"([{{"byteLength":{}}}])", bytes.size())));
    }

    static std::string chunk(Bytes& rest, const std::string& kind) {
        const auto size = rest.take<std::uint32_t>();
        EXPECT_EQ(size % 4, 0u);
        EXPECT_EQ(rest.rest.substr(0, 4), kind);
        std::string content(rest.rest.substr(4, size));
        rest.rest.remove_prefix(4 + size);
        return content;
    }

    [[nodiscard]] const nlohmann::json& primitive() const { return json.at("meshes").at(0).at("primitives").at(0); }

    template <typename Value>
    std::vector<Value> read(const nlohmann::json& index, const std::string& type, int componentType) const {
        const nlohmann::json& accessor = json.at("accessors").at(index.get<std::size_t>());
        const nlohmann::json& view = json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
        EXPECT_EQ(accessor.at("type"), type);
        EXPECT_EQ(accessor.at("componentType"), componentType);
        const auto count = accessor.at("count").get<std::size_t>(), offset = view.at("byteOffset").get<std::size_t>();
        EXPECT_EQ(view.at("byteLength"), count * sizeof(Value));
        EXPECT_EQ(view.at("target"), type == "SCALAR" ? 34963 : 34962);
        EXPECT_EQ(offset % 4, 0u);
        std::vector<Value> values(count);
        if (offset + count * sizeof(Value) > bytes.size())
            ADD_FAILURE() << "the view ends outside the bytes";
        else
            std::memcpy(values.data(), bytes.data() + offset, count * sizeof(Value));
        return values;
    }
};

TEST(WriteGlb, holdsTheMeshAsGltfRequires) {
    const DenseMesh mesh = square();
    const Glb glb(written(mesh, "a.glb"));
    const nlohmann::json& attributes = glb.primitive().at("attributes");
    EXPECT_EQ(glb.read<std::uint32_t>(glb.primitive().at("indices"), "SCALAR", 5125), mesh.indices);
    expectSameBits(glb.read<vec3>(attributes.at("POSITION"), "VEC3", 5126), mesh.positions);

    const auto normals = glb.read<vec3>(attributes.at("NORMAL"), "VEC3", 5126);
    ASSERT_EQ(normals.size(), 4u);
    EXPECT_EQ(normals[1], vec3(0, 0, 1)); // was of length 2
    EXPECT_NEAR(glm::length(normals[2]), 1, 1e-7);
    EXPECT_EQ(normals[3], vec3(0, 1, 0)); // had no direction

    const auto texCoords = glb.read<vec2>(attributes.at("TEXCOORD_0"), "VEC2", 5126);
    expectSameBits(texCoords, {{0, 0.75f}, {1, 1}, {1, 0}, {0, -1}}); // t runs down
}

TEST(WriteGlb, givesTheBoundsOfThePositionsExactly) {
    for (const DenseMesh& mesh : {square(), sheet(20)}) {
        vec3 lower = mesh.positions[0], upper = lower;
        for (const vec3& p : mesh.positions) lower = glm::min(lower, p), upper = glm::max(upper, p);
        const Glb glb(written(mesh, "a.glb"));
        const auto index = glb.primitive().at("attributes").at("POSITION").get<std::size_t>();
        const nlohmann::json& accessor = glb.json.at("accessors").at(index);
        for (int k = 0; k < 3; ++k) {
            EXPECT_EQ(accessor.at("min").at(k).get<float>(), lower[k]);
            EXPECT_EQ(accessor.at("max").at(k).get<float>(), upper[k]);
        }
    }
}

TEST(WriteGlb, isOneNodeWithOneDoubleSidedMesh) {
    const nlohmann::json json = Glb(written(square(), "a.glb")).json;
    EXPECT_EQ(json.at("asset"), nlohmann::json::parse(R"({"version": "2.0", "generator": "relief"})"));
    EXPECT_EQ(json.at("scene"), 0);
    EXPECT_EQ(json.at("scenes"), nlohmann::json::parse(R"([{"nodes": [0]}])"));
    EXPECT_EQ(json.at("nodes"), nlohmann::json::parse(R"([{"mesh": 0}])"));
    EXPECT_EQ(json.at("meshes").size(), 1u);
    EXPECT_EQ(json.at("materials").at(0).at("doubleSided"), true);
}

TEST(WriteGlb, omitsTextureCoordinatesThatAreNotThere) {
    const Glb glb(written(squareWithoutTexCoords(), "a.glb"));
    EXPECT_EQ(glb.primitive().at("attributes").size(), 2u);
    EXPECT_EQ(glb.json.at("accessors").size(), 3u);
    EXPECT_EQ(glb.bytes.size(), 4 * (12u + 12u) + 2 * 12u);
}

TEST(WriteGlb, omitsTrianglesThatNameAVertexTwice) {
    DenseMesh mesh = square();
    mesh.indices = {0, 0, 1, 0, 1, 2, 1, 2, 2, 3, 1, 3, 0, 2, 3};
    const Glb glb(written(mesh, "a.glb"));
    EXPECT_EQ(glb.read<std::uint32_t>(glb.primitive().at("indices"), "SCALAR", 5125), square().indices);
    expectPly(mesh, "property float s\nproperty float t\n");
    mesh.indices = {0, 0, 1};
    expectFailure(Failure::input, {"a.glb", "twice"}, [&] { written(mesh, "a.glb"); });
}

/// What Khronos' validator says of the mesh; empty where there is no validator.
std::string validated(const DenseMesh& mesh) {
    const char* source = std::getenv("RELIEF_SOURCE");
    const std::string project = source ? source : ".", modules = project + "/build/npm/node_modules";
    if (!std::filesystem::exists(modules + "/gltf-validator")) return "";
    const TemporaryFolder folder;
    writeMesh(folder / "a.glb", mesh);
    const std::string command = fmt::format("NODE_PATH='{}' node '{}/tests/cage/validate_glb.cjs' '{}' >'{}' 2>&1",
                                            modules, project, folder / "a.glb", folder / "said");
    EXPECT_EQ(std::system(command.c_str()), 0);
    return readFile(folder / "said");
}

TEST(WriteGlb, pleasesTheKhronosValidator) {
    const std::string cubeSays = validated(denseMesh(withIslands(cube())));
    if (cubeSays.empty()) GTEST_SKIP() << "no build/npm/node_modules/gltf-validator: ./run test installs it";
    EXPECT_EQ(cubeSays, "24 vertices, 12 triangles, 0 errors, 0 warnings\n");
    EXPECT_EQ(validated(sheet(224)), "50625 vertices, 100352 triangles, 0 errors, 0 warnings\n");
    EXPECT_EQ(validated(square()), "4 vertices, 2 triangles, 0 errors, 0 warnings\n");
    EXPECT_EQ(validated(squareWithoutTexCoords()), "4 vertices, 2 triangles, 0 errors, 0 warnings\n");
}

// --- what is refused --------------------------------------------------------------------------------------------

const std::vector<std::string> kNames = {"a.ply", "a.obj", "a.glb"};

void expectRefused(const std::function<void(DenseMesh&)>& spoil, const std::vector<std::string>& words) {
    const TemporaryFolder folder;
    DenseMesh mesh = square();
    spoil(mesh);
    for (const std::string& name : kNames) {
        std::vector<std::string> all = words;
        all.push_back(folder / name);
        expectFailure(Failure::input, all, [&] { writeMesh(folder / name, mesh); });
    }
    EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(WriteMesh, choosesByExtensionInAnyCase) {
    EXPECT_TRUE(written(square(), "A.PLY").starts_with("ply\n"));
    EXPECT_TRUE(written(square(), "a.b.Obj").starts_with("v "));
    EXPECT_TRUE(written(square(), "A.GLB").starts_with("glTF"));
}

TEST(WriteMesh, refusesUnknownExtensions) {
    for (const std::string name : {"a.stl", "a", "a.gltf", ".ply", "a.ply.gz", ""}) {
        expectFailure(Failure::usage, {name, ".ply, .obj or .glb"}, [&] { checkMeshPath(name); });
        expectFailure(Failure::usage, {name}, [&] { writeMesh(name, square()); });
    }
    for (const std::string& name : kNames) EXPECT_NO_THROW(checkMeshPath(name));
}

TEST(WriteMesh, refusesMeshesWithoutTriangles) {
    expectRefused([](DenseMesh& mesh) { mesh.indices.clear(); }, {"no triangles"});
    expectRefused([](DenseMesh& mesh) { mesh = {}; }, {"no triangles"});
}

TEST(WriteMesh, refusesNumbersThatAreNotFinite) {
    expectRefused([](DenseMesh& mesh) { mesh.positions[2].y = NAN; }, {"position of vertex 2", "nan"});
    expectRefused([](DenseMesh& mesh) { mesh.normals[3].z = -INFINITY; }, {"normal of vertex 3", "-inf"});
    expectRefused([](DenseMesh& mesh) { mesh.texCoords[0].x = NAN; }, {"texture coordinate of vertex 0"});
}

TEST(WriteMesh, refusesArraysThatDisagree) {
    expectRefused([](DenseMesh& mesh) { mesh.normals.pop_back(); }, {"4 positions, 3 normals"});
    expectRefused([](DenseMesh& mesh) { mesh.texCoords.pop_back(); }, {"3 texture coordinates"});
    expectRefused([](DenseMesh& mesh) { mesh.indices.pop_back(); }, {"5 indices"});
    expectRefused([](DenseMesh& mesh) { mesh.indices[4] = 4; }, {"triangle 1", "vertex 4", "there are 4"});
}

TEST(WriteMesh, refusesSizesThatTheFormatCannotHold) {
    constexpr std::uint64_t k32 = 1ull << 32, k31 = 1ull << 31;
    EXPECT_NO_THROW(checkMeshSize("a.ply", k32 - 1, 1ull << 40, true));
    expectFailure(Failure::input, {"a.ply", "4294967295"}, [&] { checkMeshSize("a.ply", k32, 1, true); });
    EXPECT_NO_THROW(checkMeshSize("a.obj", k31 - 1, 1ull << 40, true));
    expectFailure(Failure::input, {"a.obj", "2147483647"}, [&] { checkMeshSize("a.obj", k31, 1, true); });

    EXPECT_NO_THROW(checkMeshSize("a.glb", 0, (k32 - 5000) / 12, true));
    EXPECT_NO_THROW(checkMeshSize("a.glb", (k32 - 5000) / 32, 0, true));
    EXPECT_NO_THROW(checkMeshSize("a.glb", (k32 - 5000) / 24, 0, false));
    const std::vector<std::string> words = {"a.glb", "4.3 GB", ".ply"};
    expectFailure(Failure::input, words, [&] { checkMeshSize("a.glb", k32 / 32, 0, true); });
    expectFailure(Failure::input, words, [&] { checkMeshSize("a.glb", 0, k32 / 12, false); });
    expectFailure(Failure::usage, {"a.stl"}, [] { checkMeshSize("a.stl", 1, 1, true); });
}

TEST(WriteMesh, refusesFoldersThatCannotBeWritten) {
    const TemporaryFolder folder;
    for (const std::string& name : kNames)
        expectFailure(Failure::file, {folder / "none/" + name}, [&] { writeMesh(folder / "none/" + name, square()); });
    EXPECT_EQ(folder.fileCount(), 0u);
}

TEST(WriteMesh, aFullDiskIsAnErrorAndLeavesTheOldMesh) {
    const TemporaryFolder folder;
    const DenseMesh mesh = sheet(200); // more than the buffer holds
    for (const std::string& name : kNames) {
        writeMesh(folder / name, square());
        const std::string old = readFile(folder / name);
        for (const rlim_t bytes : {0, 1000, 1'500'000}) {
            const FullDisk disk(bytes);
            expectFailure(Failure::file, {folder / name}, [&] { writeMesh(folder / name, mesh); });
            if (bytes > 0) continue; // so few bytes that the error shows when the file is closed
            expectFailure(Failure::file, {folder / name}, [&] { writeMesh(folder / name, square()); });
        }
        EXPECT_EQ(readFile(folder / name), old);
    }
    EXPECT_EQ(folder.fileCount(), 3u);
}

TEST(WriteMesh, showsProgressToTheEnd) {
    const TemporaryFolder folder;
    for (const std::string& name : kNames)
        for (const DenseMesh& mesh : {square(), squareWithoutTexCoords()}) {
            testing::internal::CaptureStderr();
            writeMesh(folder / name, mesh, ShowProgress::always);
            EXPECT_NE(testing::internal::GetCapturedStderr().find("100 %"), std::string::npos) << name;
        }
}

} // namespace
} // namespace relief::test
