// Textures that a glTF file's own material names.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "scene/loading.h"

namespace relief {
namespace {

using TextureOf = std::optional<GltfTexture> GltfMaterial::*;

/// The texture that all materials share, or null. Warns where some have another one, or none.
const GltfTexture* findShared(const std::vector<GltfMaterial>& materials, TextureOf member, const std::string& option,
                              const Warn& warn) {
    const auto has = std::ranges::find_if(materials, [&](const GltfMaterial& m) { return (m.*member).has_value(); });
    if (has == materials.end()) return nullptr;
    const GltfTexture& first = *((*has).*member);
    const auto isSame = [&](const GltfMaterial& m) { return m.*member && (m.*member)->name == first.name; };
    if (std::ranges::all_of(materials, isSame)) return &first;
    warn(fmt::format(
        "{}: its {} materials do not share it, and it is ignored: textures of several materials are drawn where their "
        "names differ, texture coordinates lie in 0..1 and no other map is asked for; name one with {}",
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

// --- materials with textures of their own ----------------------------------------------------------------------------

/// Whether any of them has another picture, or uses one in another way.
bool differ(const std::vector<GltfMaterial>& materials) {
    const auto usesOf = [](const GltfMaterial& m) {
        const auto nameOf = [](const std::optional<GltfTexture>& t) { return t ? t->name : std::string(); };
        const double scale = m.normal ? m.normal->scale : 1;
        return std::tuple(nameOf(m.baseColor), nameOf(m.normal), scale, m.baseColorFactor.x, m.baseColorFactor.y,
                          m.baseColorFactor.z);
    };
    return std::ranges::any_of(materials,
                               [&](const GltfMaterial& m) { return usesOf(m) != usesOf(materials.front()); });
}

/// Returns the material of each part of a cage, found by its name; empty where a name is not that of exactly one.
std::vector<std::size_t> findMaterials(const Cage& cage, const std::vector<GltfMaterial>& materials) {
    std::vector<std::size_t> found;
    for (const CagePart& part : cage.parts) {
        const auto hasName = [&](const GltfMaterial& m) { return !m.name.empty() && m.name == part.material; };
        if (std::ranges::count_if(materials, hasName) != 1) return {};
        found.push_back(std::size_t(std::ranges::find_if(materials, hasName) - materials.begin()));
    }
    return found;
}

bool areInUnitSquare(const Cage& cage) {
    constexpr float kSlack = 1e-4f;
    return std::ranges::all_of(cage.texCoords, [&](const vec2& st) {
        return st.x >= -kSlack && st.x <= 1 + kSlack && st.y >= -kSlack && st.y <= 1 + kSlack;
    });
}

/// Moves the texture coordinates of each part to the unit square (i,0) of its material i.
void moveToSquares(Cage& cage, const std::vector<std::size_t>& materialOfPart) {
    std::map<std::pair<std::uint32_t, std::size_t>, std::uint32_t> moved; // of a coordinate and a material
    const std::vector<vec2> before = std::exchange(cage.texCoords, {});
    std::size_t corner = 0;
    for (std::size_t part = 0; part < cage.parts.size(); ++part) {
        const CagePart& faces = cage.parts[part];
        const std::size_t material = materialOfPart[part];
        for (std::uint32_t face = 0; face < faces.faceCount; ++face)
            for (std::uint32_t k = 0; k < cage.faceSizes[faces.firstFace + face]; ++k, ++corner) {
                std::uint32_t& index = cage.texCorners[corner];
                const auto [entry, isNew] = moved.try_emplace({index, material}, std::uint32_t(cage.texCoords.size()));
                if (isNew) cage.texCoords.push_back(before[index] + vec2(float(material), 0));
                index = entry->second;
            }
    }
    RELIEF_CHECK(corner == cage.texCorners.size());
}

/// Multiplies sRGB codes with a linear factor.
Image scaledColors(Image image, const dvec3& factor) {
    const auto linearOf = [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); };
    const auto codeOf = [](double c) { return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055; };
    if (factor == dvec3(1)) return image;
    const auto channels = std::size_t(image.channels);
    for (std::size_t i = 0; i < image.texels.size(); ++i)
        if (i % channels < 3) image.texels[i] = float(codeOf(linearOf(image.texels[i]) * factor[int(i % channels)]));
    return image;
}

/// The picture of a texture; null, with a warning, where it cannot be decoded.
std::optional<Image> tryDecode(const std::optional<GltfTexture>& texture, const Warn& warn) {
    std::optional<Image> image;
    if (texture) takeOrWarn(warn, [&] { image = toColors(decodeTexture(*texture)); });
    return image;
}

PictureSquare squareOf(std::size_t material, Image image) {
    const ivec2 size(image.width, image.height);
    auto shared = std::make_shared<Image>(std::move(image));
    return {.place = {int(material), 0}, .size = size, .read = [shared](const Warn&) { return *shared; }};
}

Image oneTexel(const vec3& color) {
    return {.width = 1, .height = 1, .channels = 3, .texels = {color.x, color.y, color.z}};
}

/// One picture of the base colors of all materials, white where one has no texture, times their factors.
void takeSplitColors(LoadedObject& object, const std::vector<GltfMaterial>& materials, const std::string& name,
                     const Warn& warn) {
    std::vector<PictureSquare> squares;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        Image image = tryDecode(materials[i].baseColor, warn).value_or(oneTexel(vec3(1)));
        squares.push_back(squareOf(i, scaledColors(std::move(image), materials[i].baseColorFactor)));
    }
    JoinedPictures joined = joinSquares(squares, {}, name, warn);
    object.albedo = std::move(joined.image);
    object.albedoTiles = joined.tiles;
    object.wrap = Wrap::clamp; // the last square does not continue in the first
    object.textureColor = vec3(1);
}

/// One normal map of those of all materials, straight where one has none.
void takeSplitNormals(LoadedObject& object, const std::vector<GltfMaterial>& materials, const std::string& name,
                      const Warn& warn) {
    const vec3 straight(0.5f, 0.5f, 1);
    std::vector<PictureSquare> squares;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const std::optional<GltfTexture>& texture = materials[i].normal;
        Image codes = oneTexel(straight);
        if (const std::optional<Image> image = tryDecode(texture, warn)) {
            const NormalMap map = makeNormalMap(*image, texture->name, {.scale = texture->scale, .limits = {}}, warn);
            codes = {.width = map.width, .height = map.height, .channels = 3, .texels = {}};
            for (const vec3& n : map.normals)
                for (int k = 0; k < 3; ++k) codes.texels.push_back(0.5f * n[k] + 0.5f);
        }
        squares.push_back(squareOf(i, std::move(codes)));
    }
    JoinedPictures joined = joinSquares(squares, straight, name, warn);
    object.normalMap = makeNormalMap(joined.image, name, {.wrap = Wrap::clamp, .limits = {}}, warn);
    object.normalMap->tiles = joined.tiles;
}

bool isGltf(const std::string& path) {
    const std::string extension = lowerExtension(path);
    return extension == ".gltf" || extension == ".glb";
}

} // namespace

GltfLooks readLooks(Cage& cage, const ObjectDesc& desc, const Warn& warn) {
    const bool wantsColors = desc.material.albedo.empty(), wantsNormals = desc.material.normalMap.path.empty();
    if (!isGltf(desc.cage) || (!wantsColors && !wantsNormals)) return {};
    GltfLooks looks{.materials = readGltfMaterials(desc.cage, warn, desc.uvSet)};
    const auto hasTexture = [](const GltfMaterial& m) { return m.baseColor || m.normal; };
    const bool areAlone = wantsColors && wantsNormals && desc.height.path.empty() && desc.height.function.empty();
    if (!areAlone || !cage.hasTexCoords() || std::ranges::none_of(looks.materials, hasTexture) ||
        !differ(looks.materials) || !areInUnitSquare(cage))
        return looks;
    const std::vector<std::size_t> found = findMaterials(cage, looks.materials);
    looks.isSplit = !found.empty();
    if (looks.isSplit) moveToSquares(cage, found);
    return looks;
}

void takeGltfTextures(LoadedObject& object, const ObjectDesc& desc, const GltfLooks& looks, const Warn& warn) {
    const std::vector<GltfMaterial>& materials = looks.materials;
    if (materials.empty()) return;
    if (!object.cage.hasTexCoords()) return warnOfNoTexCoords(materials, desc, warn);
    const auto hasColors = [](const GltfMaterial& m) { return m.baseColor || m.baseColorFactor != dvec3(1); };
    if (looks.isSplit) {
        if (std::ranges::any_of(materials, hasColors))
            takeOrWarn(warn, [&] { takeSplitColors(object, materials, desc.cage + ": base colors", warn); });
        if (std::ranges::any_of(materials, [](const GltfMaterial& m) { return m.normal.has_value(); }))
            takeOrWarn(warn, [&] { takeSplitNormals(object, materials, desc.cage + ": normal maps", warn); });
        return;
    }
    if (desc.material.albedo.empty()) takeOrWarn(warn, [&] { takeColors(object, materials, warn); });
    if (desc.material.normalMap.path.empty()) takeOrWarn(warn, [&] { takeNormals(object, materials, desc, warn); });
}

} // namespace relief
