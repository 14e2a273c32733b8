// Textures of a glTF file's own material on the object that is drawn.
#include "scene/scene.h"
#include "textured.h"

namespace relief::test {
namespace {

const vec3 kTilted(0.5f, 0.25f, 0.8f);

class GltfTextures : public ::testing::Test {
protected:
    LoadedObject loadFile(const GltfFile& file) {
        putFile(scene_.object.cage, file.glb());
        return std::move(load(scene_, CageState::posed, warnings_.warn()).object);
    }
    static GltfFile plane() { return mirroredPlane(colored({1, 0.5f, 0}), tiltedBelow(kTilted)); }

    TemporaryFolder folder_;
    Warnings warnings_;
    SceneDesc scene_{.object = {.cage = folder_ / "a.glb"}};
};

TEST_F(GltfTextures, areTaken) {
    GltfFile file = plane();
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.25, 1, 1};
    const LoadedObject object = loadFile(file);
    ASSERT_TRUE(object.albedo && object.normalMap && object.textureColor);
    EXPECT_NEAR(object.albedo->texels[1], 0.5, 0.01);
    EXPECT_EQ(*object.textureColor, vec3(0.5f, 0.25f, 1));
    EXPECT_EQ(makeMaterial(scene_.object.material, object.textureColor).albedo, vec3(0.5f, 0.25f, 1));
    EXPECT_EQ(object.normalMap->wrap, Wrap::repeat);
    EXPECT_LT(glm::length(object.normalMap->normals[60] - glm::normalize(kTilted)), 0.01f);
    EXPECT_TRUE(warnings_.lines.empty()) << warnings_.lines.front();
}

TEST_F(GltfTextures, splitMirroredHalves) {
    const LoadedObject object = loadFile(plane());
    EXPECT_TRUE(object.needsTangents);
    EXPECT_EQ(object.dense.value().positions.size(), 8u);
    GltfFile flat = plane();
    flat.json["materials"][0].erase("normalTexture");
    const LoadedObject withoutNormals = loadFile(flat);
    EXPECT_FALSE(withoutNormals.needsTangents);
    EXPECT_EQ(withoutNormals.dense.value().positions.size(), 6u);
}

TEST_F(GltfTextures, haveTheScaleAndWrapOfTheFile) {
    GltfFile file = plane();
    file.json["materials"][0]["normalTexture"]["scale"] = 2;
    file.json["textures"][1]["sampler"] = 0;
    file.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33071}}};
    const LoadedObject object = loadFile(file);
    const vec3 scaled = glm::normalize(kTilted * vec3(2, 2, 1));
    EXPECT_LT(glm::length(object.normalMap.value().normals[60] - scaled), 0.01f);
    EXPECT_EQ(object.normalMap->wrap, Wrap::clamp);
    scene_.object.height.wrap = Wrap::repeat;
    EXPECT_EQ(loadFile(file).normalMap.value().wrap, Wrap::repeat) << "--wrap";
}

TEST_F(GltfTextures, giveWayToThoseOfTheCommandLine) {
    writeImage(folder_ / "blue.png", colored({0, 0, 1}), SampleType::uint8);
    scene_.object.material.albedo = folder_ / "blue.png";
    const LoadedObject object = loadFile(plane());
    EXPECT_NEAR(object.albedo.value().texels[2], 1, 0.01);
    EXPECT_FALSE(object.textureColor);
    EXPECT_TRUE(object.normalMap);
    scene_.object.material.normalMap.path = folder_ / "blue.png"; // (0, 0, 1): a code of (-1, -1, 1)
    EXPECT_LT(loadFile(plane()).normalMap.value().normals[0].x, -0.5f);
}

TEST_F(GltfTextures, ofGrayAreColors) {
    const Image gray{.width = 2, .height = 1, .channels = 1, .texels = {0.2f, 0.8f}};
    const LoadedObject object = loadFile(mirroredPlane(gray, tiltedBelow(kTilted)));
    ASSERT_EQ(object.albedo.value().channels, 3);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(object.albedo->texels[std::size_t(3 + k)], 0.8, 0.01);
}

TEST_F(GltfTextures, thatMaterialsDoNotShareAreIgnored) {
    GltfFile file = plane();
    Json second = file.json["meshes"][0]["primitives"][0];
    second["material"] = 1;
    file.json["meshes"][0]["primitives"].push_back(second);
    Json other = file.json["materials"][0];
    other["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 1;
    file.json["materials"].push_back(other);
    const LoadedObject object = loadFile(file);
    EXPECT_FALSE(object.albedo);
    EXPECT_TRUE(object.normalMap) << "they share it";
    ASSERT_EQ(warnings_.lines.size(), 1u);
    EXPECT_TRUE(warnings_.has("a.glb: images/0: its 2 materials do not share it"));
    EXPECT_TRUE(warnings_.has("--albedo"));
}

// Two halves of a plane, each with a material, a color and a normal map of its own; the second multiplies its color.
TEST_F(GltfTextures, ofSeveralMaterialsAreTheirOwn) {
    GltfFile file = plane();
    Json& primitives = file.json["meshes"][0]["primitives"];
    primitives[0]["indices"] = file.add(std::vector<std::uint32_t>{0, 1, 4, 0, 4, 3});
    Json second = primitives[0];
    second["indices"] = file.add(std::vector<std::uint32_t>{1, 2, 5, 1, 5, 4});
    second["material"] = 1;
    primitives.push_back(second);
    const std::string green = pngOf(colored({0, 1, 0.5f}));
    file.json["images"].push_back(
        {{"bufferView", file.addView(std::vector<char>(green.begin(), green.end()))}, {"mimeType", "image/png"}});
    file.json["textures"].push_back({{"source", 2}});
    file.json["materials"].push_back(
        {{"name", "other"},
         {"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 2}}}, {"baseColorFactor", {1, 0.5, 1, 1}}}}});
    const LoadedObject object = loadFile(file);
    EXPECT_TRUE(warnings_.lines.empty()) << warnings_.lines.front();
    ASSERT_TRUE(object.albedo && object.normalMap);
    EXPECT_EQ(object.albedoTiles.count, ivec2(2, 1));
    const int middle = object.albedo->height / 2, width = object.albedo->width;
    EXPECT_NEAR(object.albedo->at(1, middle)[1], 0.5, 0.01) << "the first material";
    EXPECT_NEAR(object.albedo->at(width - 2, middle)[1], 0.735, 0.01) << "half of the light of a code of 1";
    EXPECT_NEAR(object.albedo->at(width - 2, middle)[2], 0.5, 0.01);
    EXPECT_EQ(object.normalMap->tiles.count, ivec2(2, 1));
    const auto normalAt = [&](int x) {
        const int row = object.normalMap->height - 2;
        return object.normalMap->normals[std::size_t(row) * std::size_t(object.normalMap->width) + std::size_t(x)];
    };
    EXPECT_LT(glm::length(normalAt(1) - glm::normalize(kTilted)), 0.01f);
    EXPECT_LT(glm::length(normalAt(object.normalMap->width - 2) - vec3(0, 0, 1)), 0.01f) << "it has no normal map";
    // Faces of the second material lie in the second unit square; edges that both meet at are split.
    for (std::size_t corner = 0; corner < 12; ++corner) {
        const vec2 st = object.cage.texCoords[object.cage.texCorners[corner]];
        EXPECT_TRUE(corner < 6 ? st.x <= 1 : st.x >= 1) << corner;
    }
}

TEST_F(GltfTextures, thatCannotBeDecodedAreWarnedOf) {
    GltfFile file = plane();
    file.json["images"][0] = {{"uri", "data:image/png;base64," + base64("no picture")}};
    file.json["images"][1] = {{"uri", "data:image/png;base64," + base64("\x89PNG\r\n\x1a\n")}};
    const LoadedObject object = loadFile(file);
    EXPECT_FALSE(object.albedo || object.normalMap || object.textureColor);
    ASSERT_EQ(warnings_.lines.size(), 2u);
    EXPECT_TRUE(warnings_.has("a.glb: images/0: not a picture"));
    EXPECT_TRUE(warnings_.has("a.glb: images/1: damaged png"));
    EXPECT_TRUE(warnings_.has("drawn without that texture"));
}

// What a second material does otherwise with the same textures is said: there is one of each per object.
TEST_F(GltfTextures, thatMaterialsUseInOtherWaysAreThoseOfTheFirst) {
    GltfFile file = plane();
    Json second = file.json["meshes"][0]["primitives"][0];
    second["material"] = 1;
    file.json["meshes"][0]["primitives"].push_back(second);
    file.json["materials"].push_back(file.json["materials"][0]);
    loadFile(file);
    EXPECT_TRUE(warnings_.lines.empty()) << warnings_.lines.front();
    file.json["materials"][0]["name"] = "skin";
    file.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.25, 1, 1};
    file.json["materials"][1]["name"] = "skin"; // names do not tell them apart
    file.json["materials"][1]["normalTexture"]["scale"] = 2;
    const LoadedObject object = loadFile(file);
    EXPECT_EQ(object.textureColor.value(), vec3(0.5f, 0.25f, 1));
    EXPECT_LT(glm::length(object.normalMap.value().normals[60] - glm::normalize(kTilted)), 0.01f);
    ASSERT_EQ(warnings_.lines.size(), 2u);
    EXPECT_TRUE(warnings_.has("a.glb: images/0: its 2 materials differ in baseColorFactor"));
    EXPECT_TRUE(warnings_.has("a.glb: images/1: its 2 materials differ in the scale of their normals"));
    EXPECT_TRUE(warnings_.has("that of the first one, skin, is taken"));
}

TEST_F(GltfTextures, needTextureCoordinates) {
    GltfFile file = plane();
    file.attributes().erase("TEXCOORD_0");
    const LoadedObject object = loadFile(file);
    EXPECT_FALSE(object.albedo || object.normalMap);
    ASSERT_EQ(warnings_.lines.size(), 1u);
    EXPECT_TRUE(warnings_.has("no texture coordinates (TEXCOORD_0)"));
}

TEST_F(GltfTextures, onFacesWithoutAreaInTheTextureAreWarnedOf) {
    GltfFile file = plane();
    file.attributes()["TEXCOORD_0"] =
        file.add(std::vector<vec2>{{0, 1}, {1, 1}, {0.5f, 0.5f}, {0, 0}, {1, 0}, {0.5f, 0.5f}});
    loadFile(file);
    ASSERT_EQ(warnings_.lines.size(), 1u);
    EXPECT_TRUE(warnings_.has("the texture coordinates of 1 of 4 faces span no area")) << warnings_.lines[0];
    file.json["materials"][0].erase("normalTexture");
    warnings_.lines.clear();
    loadFile(file);
    EXPECT_TRUE(warnings_.lines.empty()) << "colors need no direction";
}

} // namespace
} // namespace relief::test
