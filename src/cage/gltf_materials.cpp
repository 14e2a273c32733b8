#include <set>

#include "cage/gltf_reader.h"

namespace relief {
namespace {

/// Finds the materials that are shown. Nodes, meshes and primitives are as readGltf finds them.
class MaterialReader {
public:
    MaterialReader(const GltfDocument& document, const Warn& warn)
        : document_(document), root_(document.root()), buffers_(document), warn_(warn) {}

    std::vector<GltfMaterial> read();

private:
    [[nodiscard]] std::set<std::uint32_t> shownMeshes() const;
    [[nodiscard]] std::set<std::uint32_t> materialsOf(const GltfElement& mesh) const;
    GltfMaterial readMaterial(const GltfElement& from);
    std::optional<GltfTexture> readTexture(const GltfElement& from, const char* member);
    GltfTexture takeTexture(const GltfElement& info);
    [[nodiscard]] bool isClamped(const GltfElement& texture) const;
    [[nodiscard]] std::string bytesOf(const GltfElement& image);

    const GltfDocument& document_;
    GltfElement root_;
    GltfBuffers buffers_;
    const Warn& warn_;
};

std::vector<GltfMaterial> MaterialReader::read() {
    const auto all = document_.json.find("materials");
    if (all == document_.json.end() || !all->is_array()) return {}; // then no primitive's number is judged
    std::set<std::uint32_t> used;
    for (const std::uint32_t mesh : shownMeshes()) used.merge(materialsOf(root_.at("meshes", mesh)));
    std::vector<GltfMaterial> materials;
    for (const std::uint32_t index : used) {
        try {
            materials.push_back(readMaterial(document_.entry("materials", "material", index, "meshes")));
        } catch (const Error& error) { // a material that is no object, or a list that is none
            warn_(fmt::format("{}; it is drawn without that material", error.what()));
        }
    }
    return materials;
}

/// Meshes of the nodes below those of the scene.
std::set<std::uint32_t> MaterialReader::shownMeshes() const {
    std::vector<std::uint32_t> nodes;
    if (root_.count("scenes") == 0)
        for (std::uint32_t node = 0; node < root_.count("nodes"); ++node) nodes.push_back(node);
    else
        nodes = document_.entry("scenes", "scene", root_.integer("scene").value_or(0), "scene").integers("nodes");
    std::set<std::uint32_t> seen, meshes;
    while (!nodes.empty()) {
        const std::uint32_t index = nodes.back();
        nodes.pop_back();
        if (!seen.insert(index).second) continue;
        const GltfElement node = document_.entry("nodes", "node", index, "nodes");
        const std::optional<std::uint32_t> mesh = node.integer("mesh");
        if (mesh && *mesh < root_.count("meshes")) meshes.insert(*mesh);
        for (const std::uint32_t child : node.integers("children")) nodes.push_back(child);
    }
    return meshes;
}

std::set<std::uint32_t> MaterialReader::materialsOf(const GltfElement& mesh) const {
    std::set<std::uint32_t> materials;
    for (std::size_t i = 0; i < mesh.count("primitives"); ++i) {
        const GltfElement primitive = mesh.at("primitives", i);
        const bool isSurface = primitive.integer("mode").value_or(TINYGLTF_MODE_TRIANGLES) >= TINYGLTF_MODE_TRIANGLES;
        const std::optional<std::uint32_t> material = primitive.integer("material");
        if (isSurface && material) materials.insert(*material);
    }
    return materials;
}

GltfMaterial MaterialReader::readMaterial(const GltfElement& from) {
    GltfMaterial material{.name = from.name()};
    material.normal = readTexture(from, "normalTexture");
    const std::optional<GltfElement> base = from.object("pbrMetallicRoughness");
    if (!base) return material;
    material.baseColor = readTexture(*base, "baseColorTexture");
    const std::vector<double> factor = base->numbers("baseColorFactor");
    if (factor.size() >= 3) material.baseColorFactor = {factor[0], factor[1], factor[2]};
    return material;
}

std::optional<GltfTexture> MaterialReader::readTexture(const GltfElement& from, const char* member) {
    try {
        const std::optional<GltfElement> info = from.object(member);
        if (info) return takeTexture(*info);
    } catch (const Error& error) {
        warn_(fmt::format("{}; it is drawn without that texture", error.what()));
    }
    return {};
}

/// Follows texture information to its texture and on to the picture (sections 5.30, 5.29 and 5.18).
GltfTexture MaterialReader::takeTexture(const GltfElement& info) {
    const std::uint32_t set = info.integer("texCoord").value_or(0);
    if (set != document_.uvSet) info.fail("is mapped by TEXCOORD_{}; TEXCOORD_{} is read", set, document_.uvSet);
    if (info.extension("KHR_texture_transform")) info.fail("is transformed (KHR_texture_transform)");
    const GltfElement texture =
        document_.entry("textures", "texture", *info.need("index").integer("index"), info.place());
    if (!texture.has("source")) texture.fail("has no picture that is a PNG or JPEG");
    const GltfElement image = document_.entry("images", "image", *texture.integer("source"), texture.place());
    GltfTexture result{.name = fmt::format("{}: {}", document_.path, image.place()),
                       .bytes = bytesOf(image),
                       .isClamped = isClamped(texture)};
    result.scale = info.number("scale").value_or(1);
    return result;
}

/// Samplers wrap along s and t; relief knows one rule for both.
bool MaterialReader::isClamped(const GltfElement& texture) const {
    const std::optional<std::uint32_t> number = texture.integer("sampler");
    if (!number) return false;
    const GltfElement sampler = document_.entry("samplers", "sampler", *number, texture.place());
    const auto alongS = int(sampler.integer("wrapS").value_or(TINYGLTF_TEXTURE_WRAP_REPEAT));
    const auto alongT = int(sampler.integer("wrapT").value_or(TINYGLTF_TEXTURE_WRAP_REPEAT));
    const bool isPlain = alongS == alongT && alongS != TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT;
    if (!isPlain)
        warn_(fmt::format("{}: {}: mirrors the texture, or continues it in two ways; it repeats here", document_.path,
                          sampler.place()));
    return isPlain && alongS == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
}

std::string MaterialReader::bytesOf(const GltfElement& image) {
    const std::optional<std::uint32_t> view = image.integer("bufferView");
    if (!view) return readGltfPicture(image);
    const std::span<const unsigned char> bytes = buffers_.view(*view, image.place());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

} // namespace

std::vector<GltfMaterial> readGltfMaterials(const std::string& path, const Warn& warn, std::uint32_t uvSet) {
    GltfDocument document = loadGltfDocument(path, warn);
    document.uvSet = uvSet;
    return MaterialReader(document, warn).read();
}

} // namespace relief
