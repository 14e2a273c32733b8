// A glTF file like the public NormalTangentMirrorTest, made in code: a plane whose halves have mirrored texture
// coordinates, with a base color and a normal map.
#pragma once

#include "gltf.h"

namespace relief::test {

/// The bytes of an 8-bit PNG.
inline std::string pngOf(const Image& image) {
    const TemporaryFolder folder;
    writeImage(folder / "a.png", image, SampleType::uint8);
    return readFile(folder / "a.png");
}

/// 8 x 8 codes of normals: straight in the upper half of the picture, tilted in the lower one.
inline Image tiltedBelow(const vec3& tilted) {
    Image image{.width = 8, .height = 8, .channels = 3, .texels = {}};
    for (int i = 0; i < 64; ++i) {
        const vec3 code = 0.5f * glm::normalize(i < 32 ? vec3(0, 0, 1) : tilted) + 0.5f;
        image.texels.insert(image.texels.end(), {code.x, code.y, code.z});
    }
    return image;
}

/// 4 x 4 texels of one color.
inline Image colored(const vec3& color) {
    Image image{.width = 4, .height = 4, .channels = 3, .texels = {}};
    for (int i = 0; i < 16; ++i) image.texels.insert(image.texels.end(), {color.x, color.y, color.z});
    return image;
}

/// Two squares in the plane z = 0 that face +z, from -1 to 1. The picture's left edge lies at x = -1 and at x = 1, its
/// right one where the squares meet; its upper edge lies at y = 1.
inline GltfFile mirroredPlane(const Image& color, const Image& normals) {
    GltfFile file;
    file.addMesh({{-1, -1, 0}, {0, -1, 0}, {1, -1, 0}, {-1, 1, 0}, {0, 1, 0}, {1, 1, 0}},
                 {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4});
    file.attributes()["NORMAL"] = file.add(std::vector<vec3>(6, vec3(0, 0, 1)));
    file.attributes()["TEXCOORD_0"] = file.add(std::vector<vec2>{{0, 1}, {1, 1}, {0, 1}, {0, 0}, {1, 0}, {0, 0}});
    file.addNode({{"mesh", 0}});
    const auto addPicture = [&](const Image& image) {
        const std::string png = pngOf(image);
        file.json["images"].push_back(
            {{"bufferView", file.addView(std::vector<char>(png.begin(), png.end()))}, {"mimeType", "image/png"}});
        file.json["textures"].push_back({{"source", file.json["images"].size() - 1}});
        return Json{{"index", file.json["textures"].size() - 1}};
    };
    const Json base = addPicture(color), normal = addPicture(normals);
    file.json["materials"] = {
        {{"name", "plane"}, {"normalTexture", normal}, {"pbrMetallicRoughness", {{"baseColorTexture", base}}}}};
    file.json["meshes"][0]["primitives"][0]["material"] = 0;
    return file;
}

} // namespace relief::test
