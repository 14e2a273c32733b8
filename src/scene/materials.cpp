// Textures that a glTF file's own material names.
#include <algorithm>

#include "cage/gltf.h"
#include "scene/loading.h"

namespace relief {
namespace {

using TextureOf = std::optional<GltfTexture> GltfMaterial::*;

/// The texture that all materials share, or null. Warns where some have another one, or none: relief draws one per
/// object.
const GltfTexture* findShared(const std::vector<GltfMaterial>& materials, TextureOf member, const std::string& option,
                              const Warn& warn) {
    const auto has = std::ranges::find_if(materials, [&](const GltfMaterial& m) { return (m.*member).has_value(); });
    if (has == materials.end()) return nullptr;
    const GltfTexture& first = *((*has).*member);
    const auto isSame = [&](const GltfMaterial& m) { return m.*member && (m.*member)->name == first.name; };
    if (std::ranges::all_of(materials, isSame)) return &first;
    warn(fmt::format(
        "{}: its {} materials do not share it, and relief draws one texture per object: it is ignored; name "
        "one with {}",
        first.name, materials.size(), option));
    return nullptr;
}

/// Warns where materials use a texture that they share in different ways: relief draws the first one's.
template <typename Value>
void warnOfDifferences(const std::vector<GltfMaterial>& materials, const GltfTexture& texture, const char* what,
                       const Value& valueOf, const Warn& warn) {
    const auto isAsFirst = [&](const GltfMaterial& m) { return valueOf(m) == valueOf(materials.front()); };
    if (std::ranges::all_of(materials, isAsFirst)) return;
    warn(fmt::format("{}: its {} materials differ in {}, and relief draws one material per object: that of the first "
                     "one, {}, is taken",
                     texture.name, materials.size(), what,
                     materials.front().name.empty() ? "which has no name" : materials.front().name));
}

Image decodeTexture(const GltfTexture& texture) {
    return decodeImage({reinterpret_cast<const unsigned char*>(texture.bytes.data()), texture.bytes.size()},
                       texture.name);
}

/// Makes three channels of a picture of gray levels; others stay as they are.
Image toColors(Image image) {
    if (image.channels >= 3) return image;
    Image colors{.width = image.width, .height = image.height, .channels = 3, .texels = {}};
    colors.texels.reserve(image.texels.size() / std::size_t(image.channels) * 3);
    for (std::size_t i = 0; i < image.texels.size(); i += std::size_t(image.channels))
        colors.texels.insert(colors.texels.end(), 3, image.texels[i]);
    return colors;
}

void takeColors(LoadedObject& object, const std::vector<GltfMaterial>& materials, const Warn& warn) {
    const GltfTexture* texture = findShared(materials, &GltfMaterial::baseColor, "--albedo", warn);
    if (texture == nullptr) return;
    object.albedo = toColors(decodeTexture(*texture));
    object.textureColor = vec3(materials.front().baseColorFactor);
    const auto factorOf = [](const GltfMaterial& m) { return m.baseColorFactor; };
    warnOfDifferences(materials, *texture, "baseColorFactor", factorOf, warn);
}

void takeNormals(LoadedObject& object, const std::vector<GltfMaterial>& materials, const ObjectDesc& desc,
                 const Warn& warn) {
    const GltfTexture* texture = findShared(materials, &GltfMaterial::normal, "--normal-map", warn);
    if (texture == nullptr) return;
    const NormalOptions options{.scale = texture->scale,
                                .wrap = desc.height.wrap.value_or(texture->isClamped ? Wrap::clamp : Wrap::repeat),
                                .limits = {}};
    object.normalMap = makeNormalMap(decodeTexture(*texture), texture->name, options, warn);
    const auto useOf = [](const GltfMaterial& m) { return std::pair(m.normal->scale, m.normal->isClamped); };
    warnOfDifferences(materials, *texture, "the scale of their normals or how they wrap", useOf, warn);
}

/// Looks change no shape: where a picture cannot be used, that is said, and the object is drawn without it.
template <typename Take>
void takeOrWarn(const Warn& warn, const Take& take) {
    try {
        take();
    } catch (const Error& error) {
        if (error.failure == Failure::device) throw; // out of memory
        warn(fmt::format("{}; it is drawn without that texture", error.what()));
    }
}

/// Warns of textures, which nothing of the object says where to put.
void warnOfNoTexCoords(const std::vector<GltfMaterial>& materials, const ObjectDesc& desc, const Warn& warn) {
    for (const GltfMaterial& m : materials) {
        const std::optional<GltfTexture>& texture = m.normal ? m.normal : m.baseColor;
        if (!texture) continue;
        warn(fmt::format("{}: material {} has a texture, and the faces have no texture coordinates (TEXCOORD_0): it is "
                         "drawn without that texture",
                         desc.cage, m.name.empty() ? "without a name" : m.name));
        return;
    }
}

} // namespace

void takeGltfTextures(LoadedObject& object, const ObjectDesc& desc, const Warn& warn) {
    const std::string extension = lowerExtension(desc.cage);
    const bool isGltf = extension == ".gltf" || extension == ".glb";
    const bool wantsColors = desc.material.albedo.empty(), wantsNormals = desc.material.normalMap.path.empty();
    if (!isGltf || (!wantsColors && !wantsNormals)) return;
    const std::vector<GltfMaterial> materials = readGltfMaterials(desc.cage, warn, desc.uvSet);
    if (!object.cage.hasTexCoords()) return warnOfNoTexCoords(materials, desc, warn);
    if (wantsColors) takeOrWarn(warn, [&] { takeColors(object, materials, warn); });
    if (wantsNormals) takeOrWarn(warn, [&] { takeNormals(object, materials, desc, warn); });
}

} // namespace relief
