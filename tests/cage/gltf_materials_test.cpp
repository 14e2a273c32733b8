// Textures of glTF materials: where their pictures lie, how they are used, and what is not read.
#include "gltf_files.h"

namespace relief::test {
namespace {

const std::string kPicture = "\x89PNG\r\n\x1a\n a picture", kOther = "\xff\xd8\xff another";

std::vector<char> lettersOf(const std::string& text) { return {text.begin(), text.end()}; }

struct GltfMaterials : testing::Test {
    TemporaryFolder folder;
    GltfFile file = validFile();
    Warnings warnings;

    /// A material whose textures 0 and 1 are images 0 and 1 of the file.
    void SetUp() override {
        file.json["materials"] = {
            {{"name", "skin"},
             {"normalTexture", {{"index", 0}, {"scale", 0.5}}},
             {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 1}}}, {"baseColorFactor", {0.25, 0.5, 1, 1}}}}}};
        file.json["textures"] = {{{"source", 0}}, {{"source", 1}}};
        file.json["images"] = {{{"bufferView", file.addView(lettersOf(kPicture))}, {"mimeType", "image/png"}},
                               {{"uri", "data:image/jpeg;base64," + base64(kOther)}}};
        file.json["meshes"][0]["primitives"][0]["material"] = 0;
    }
    std::vector<GltfMaterial> read(bool isBinary = false) {
        const std::string path = folder / (isBinary ? "a.glb" : "a.gltf");
        putFile(path, isBinary ? file.glb() : file.gltf());
        return readGltfMaterials(path, warnings.warn());
    }
    /// The material without its normal map, and one warning that holds the words.
    void expectNoNormalMap(const std::vector<std::string>& words) {
        const std::vector<GltfMaterial> materials = read();
        ASSERT_EQ(materials.size(), 1u);
        EXPECT_FALSE(materials[0].normal);
        EXPECT_TRUE(materials[0].baseColor);
        ASSERT_EQ(warnings.lines.size(), 1u);
        for (const std::string& word : words)
            EXPECT_NE(warnings.lines[0].find(word), std::string::npos) << word << " in " << warnings.lines[0];
    }
};

TEST_F(GltfMaterials, haveTexturesInBuffersAndInTheText) {
    for (const bool isBinary : {false, true}) {
        const std::vector<GltfMaterial> materials = read(isBinary);
        ASSERT_EQ(materials.size(), 1u);
        EXPECT_EQ(materials[0].name, "skin");
        EXPECT_EQ(materials[0].baseColorFactor, dvec3(0.25, 0.5, 1));
        ASSERT_TRUE(materials[0].normal && materials[0].baseColor);
        EXPECT_EQ(materials[0].normal->bytes, kPicture);
        EXPECT_EQ(materials[0].normal->scale, 0.5);
        EXPECT_FALSE(materials[0].normal->isClamped);
        EXPECT_TRUE(materials[0].normal->name.ends_with(": images/0")) << materials[0].normal->name;
        EXPECT_EQ(materials[0].baseColor->bytes, kOther);
        EXPECT_EQ(materials[0].baseColor->scale, 1);
    }
    EXPECT_TRUE(warnings.lines.empty()) << warnings.lines.front();
}

TEST_F(GltfMaterials, haveTexturesInFilesBesideIt) {
    std::filesystem::create_directory(folder / "maps");
    putFile(folder / "maps/my normals.png", kPicture);
    file.json["images"][0] = {{"uri", "maps/my%20normals.png"}};
    const std::vector<GltfMaterial> materials = read();
    ASSERT_TRUE(materials.at(0).normal);
    EXPECT_EQ(materials[0].normal->bytes, kPicture);
}

TEST_F(GltfMaterials, areThoseThatAreShown) {
    file.json["materials"].push_back({{"name", "unused"}, {"normalTexture", {{"index", 99}}}});
    file.json["materials"].push_back({{"name", "lines"}});
    file.json["materials"].push_back({{"name", "below"}});
    Json lines = file.primitive({{0, 0, 0}, {1, 0, 0}}, {0, 1});
    lines["mode"] = 1;
    lines["material"] = 2;
    file.json["meshes"][0]["primitives"].push_back(lines);
    const int mesh = file.addMesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2});
    file.json["meshes"][std::size_t(mesh)]["primitives"][0]["material"] = 3;
    const int child = file.addNode({{"mesh", mesh}}, false);
    file.json["nodes"][0]["children"] = {child};
    const std::vector<GltfMaterial> materials = read();
    ASSERT_EQ(materials.size(), 2u);
    EXPECT_EQ(materials[0].name, "skin");
    EXPECT_EQ(materials[1].name, "below");
    EXPECT_TRUE(warnings.lines.empty()) << warnings.lines.front();
}

TEST_F(GltfMaterials, clampWhereTheirSamplerDoesSoOnBothAxes) {
    constexpr int kClamp = 33071, kMirror = 33648, kRepeat = 10497;
    const struct {
        int s, t;
        bool isClamped;
        std::size_t warningCount;
    } cases[] = {{kRepeat, kRepeat, false, 0},
                 {kClamp, kClamp, true, 0},
                 {kClamp, kRepeat, false, 1},
                 {kMirror, kMirror, false, 1}};
    file.json["textures"][0]["sampler"] = 0;
    for (const auto& wraps : cases) {
        warnings.lines.clear();
        file.json["samplers"] = {{{"wrapS", wraps.s}, {"wrapT", wraps.t}}};
        EXPECT_EQ(read().at(0).normal->isClamped, wraps.isClamped) << wraps.s << ' ' << wraps.t;
        EXPECT_EQ(warnings.lines.size(), wraps.warningCount);
    }
}

TEST_F(GltfMaterials, ofOtherCoordinatesAreNotRead) {
    file.json["materials"][0]["normalTexture"]["texCoord"] = 1;
    expectNoNormalMap({"materials/0/normalTexture", "TEXCOORD_1", "drawn without that texture"});
}

TEST_F(GltfMaterials, thatAreTransformedAreNotRead) {
    file.json["materials"][0]["normalTexture"]["extensions"] = {{"KHR_texture_transform", {{"scale", {2, 2}}}}};
    expectNoNormalMap({"materials/0/normalTexture", "KHR_texture_transform"});
}

TEST_F(GltfMaterials, ofOtherKindsOfPicturesAreNotRead) {
    file.json["textures"][0] = {{"extensions", {{"EXT_texture_webp", {{"source", 0}}}}}};
    expectNoNormalMap({"textures/0", "PNG or JPEG"});
}

TEST_F(GltfMaterials, whosePictureIsMissingAreDrawnWithoutIt) {
    file.json["images"][0] = {{"uri", "lost.png"}};
    expectNoNormalMap({"lost.png", "drawn without that texture"});
}

TEST_F(GltfMaterials, thatLeaveTheFolderAreNotRead) {
    file.json["images"][0] = {{"uri", "../lost.png"}};
    expectNoNormalMap({"images/0", "../lost.png", "own folder"});
}

TEST_F(GltfMaterials, thatNameWhatIsNotThereAreNoFault) {
    file.json["textures"][0]["source"] = 7;
    expectNoNormalMap({"textures/0", "image 7"});
}

TEST_F(GltfMaterials, thatAreNoneAreNoFault) {
    for (const char* materials : {R"("none")", R"([7])", R"([{"pbrMetallicRoughness": 7}])"}) {
        file.json["materials"] = Json::parse(materials);
        EXPECT_TRUE(read().empty()) << materials;
    }
    file.json.erase("materials");
    EXPECT_TRUE(read().empty());
}

} // namespace
} // namespace relief::test
