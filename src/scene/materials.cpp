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
}

void takeNormals(LoadedObject& object, const std::vector<GltfMaterial>& materials, const ObjectDesc& desc,
                 const Warn& warn) {
    const GltfTexture* texture = findShared(materials, &GltfMaterial::normal, "--normal-map", warn);
    if (texture == nullptr) return;
    const NormalOptions options{.scale = texture->scale,
                                .wrap = desc.height.wrap.value_or(texture->isClamped ? Wrap::clamp : Wrap::repeat),
                                .limits = {}};
    object.normalMap = makeNormalMap(decodeTexture(*texture), texture->name, options, warn);
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

} // namespace

void takeGltfTextures(LoadedObject& object, const ObjectDesc& desc, const Warn& warn) {
    const std::string extension = lowerExtension(desc.cage);
    const bool isGltf = extension == ".gltf" || extension == ".glb";
    const bool wantsColors = desc.material.albedo.empty(), wantsNormals = desc.material.normalMap.path.empty();
    if (!isGltf || !object.cage.hasTexCoords() || (!wantsColors && !wantsNormals)) return;
    const std::vector<GltfMaterial> materials = readGltfMaterials(desc.cage, warn);
    if (wantsColors) takeOrWarn(warn, [&] { takeColors(object, materials, warn); });
    if (wantsNormals) takeOrWarn(warn, [&] { takeNormals(object, materials, desc, warn); });
}

} // namespace relief
