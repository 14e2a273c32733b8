#include "cage/gltf_json.h"

#include <algorithm>
#include <limits>

namespace relief {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kLongest = 512ull << 20;
constexpr int kDeepest = 100; // brackets in brackets: they are parsed recursively

bool isWhole(const Json& value, std::uint64_t largest) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= largest;
}

bool isIndex(const Json& value) { return isWhole(value, std::numeric_limits<std::int32_t>::max()); }

template <typename Is>
bool isListOf(const Json& value, const Is& is) {
    return value.is_array() && std::all_of(value.begin(), value.end(), is);
}

void checkDepth(std::string_view text, const std::string& path) {
    int depth = 0;
    bool isInString = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char letter = text[i];
        if (isInString && letter == '\\') ++i;
        if (letter == '"') isInString = !isInString;
        if (isInString) continue;
        if (letter == '[' || letter == '{') ++depth;
        if (letter == ']' || letter == '}') --depth;
        if (depth > kDeepest) fail(Failure::input, "{}: JSON in more than {} brackets", path, kDeepest);
    }
}

/// The message without the library's own name for it.
std::string_view reasonOf(std::string_view error) { return error.substr(error.find(']') + 1); }

/// glTF 1.0 has objects where 2.0 has lists, and may omit "asset".
void checkVersion(const Json& json, const std::string& path) {
    constexpr const char* kNeed = "{}: glTF of version {}; relief reads 2.0, so export it again as glTF 2.0";
    const auto isDictionary = [&](const char* name) { return json.contains(name) && json[name].is_object(); };
    const bool isFirst = isDictionary("accessors") || isDictionary("meshes");
    if (!json.contains("asset") && !isFirst) fail(Failure::input, "{}: has no asset, so it is no glTF", path);
    const GltfElement root(json, path, "");
    const std::optional<GltfElement> asset = root.object("asset");
    const std::string version = asset && asset->has("version") ? asset->text("version") : isFirst ? "1.0" : "";
    if (version.empty()) fail(Failure::input, "{}: asset has no version; relief reads glTF 2.0", path);
    if (!version.starts_with("2.")) fail(Failure::input, kNeed, path, printable(version));
}

// --- extensions --------------------------------------------------------------------------------------------------

enum class ExtensionKind {
    read,     ///< relief reads it
    looks,    ///< it changes nothing about shape and motion
    geometry, ///< without it the file has another shape or motion
};

struct KnownExtension {
    std::string_view beginning; ///< of the name
    ExtensionKind kind;
    const char* loss = ""; ///< what is missing where relief ignores it
};

/// The first row whose `beginning` a name starts with applies; a name that fits none is of an unknown kind.
constexpr KnownExtension kExtensions[] = {
    {"KHR_mesh_quantization", ExtensionKind::read},
    {"KHR_draco_mesh_compression", ExtensionKind::read},
    {"EXT_meshopt_compression", ExtensionKind::read},
    {"KHR_materials_", ExtensionKind::looks},
    {"KHR_texture_", ExtensionKind::looks},
    {"KHR_lights_", ExtensionKind::looks},
    {"KHR_xmp", ExtensionKind::looks},
    {"KHR_audio", ExtensionKind::looks},
    {"EXT_texture_", ExtensionKind::looks},
    {"EXT_lights_", ExtensionKind::looks},
    {"MSFT_texture_", ExtensionKind::looks},
    {"MSFT_packing_", ExtensionKind::looks},
    {"EXT_mesh_gpu_instancing", ExtensionKind::geometry, "each mesh is drawn once, without its further instances"},
    {"KHR_animation_pointer", ExtensionKind::geometry, "what it animates stands still"},
    {"KHR_node_visibility", ExtensionKind::geometry, "hidden nodes are drawn"},
    {"KHR_interactivity", ExtensionKind::geometry, "nothing behaves"},
    {"KHR_physics_", ExtensionKind::geometry, "nothing is simulated"},
    {"KHR_gaussian_splatting", ExtensionKind::geometry, "splats are not drawn"},
    {"MSFT_physics", ExtensionKind::geometry, "nothing is simulated"},
    {"OMI_physics_", ExtensionKind::geometry, "nothing is simulated"},
    {"MPEG_accessor_timed", ExtensionKind::geometry, "data that change with time stand still"},
    {"MPEG_mesh_linking", ExtensionKind::geometry, "linked meshes do not follow"},
    {"VRMC_springBone", ExtensionKind::geometry, "hair and clothes do not swing"},
    {"VRMC_node_constraint", ExtensionKind::geometry, "constrained nodes do not follow"},
    {"CESIUM_RTC", ExtensionKind::geometry, "the object stands at the origin"},
};

const KnownExtension* findExtension(std::string_view name) {
    const auto* found = std::find_if(std::begin(kExtensions), std::end(kExtensions),
                                     [&](const KnownExtension& e) { return name.starts_with(e.beginning); });
    return found == std::end(kExtensions) ? nullptr : found;
}

void checkExtensions(const Json& json, const std::string& path, const Warn& warn) {
    const auto each = [&](const char* list, const auto& act) {
        if (!json.contains(list) || !json[list].is_array()) return;
        for (const Json& name : json[list])
            if (name.is_string()) act(name.get_ref<const std::string&>());
    };
    each("extensionsRequired", [&](const std::string& name) {
        const KnownExtension* known = findExtension(name);
        if (known == nullptr || known->kind == ExtensionKind::geometry)
            fail(Failure::input, "{}: needs the extension {}, which relief does not read; export it without", path,
                 printable(name));
    });
    each("extensionsUsed", [&](const std::string& name) {
        const KnownExtension* known = findExtension(name);
        if (known != nullptr && known->kind == ExtensionKind::geometry)
            warn(fmt::format("{}: the extension {} is ignored: {}", path, printable(name), known->loss));
    });
}

} // namespace

std::string printable(std::string_view text) {
    constexpr std::size_t kLongestText = 160;
    text = text.substr(0, text.find('\n'));
    std::string line(text.substr(0, kLongestText));
    for (char& letter : line)
        if (static_cast<unsigned char>(letter) < ' ' || letter == '\x7f') letter = '?';
    return text.size() > kLongestText ? line + "..." : line;
}

// --- one element -------------------------------------------------------------------------------------------------

GltfElement::GltfElement(const Json& value, const std::string& path, std::string place)
    : value_(&value), path_(&path), place_(std::move(place)) {
    if (!value.is_object()) relief::fail(Failure::input, "{}: {} must be an object", path, place_);
}

const Json* GltfElement::member(std::string_view name) const {
    const auto found = value_->find(name);
    return found == value_->end() ? nullptr : &*found;
}

std::string GltfElement::placeOf(std::string_view name) const {
    return place_.empty() ? std::string(name) : fmt::format("{}/{}", place_, name);
}

void GltfElement::failKind(std::string_view name, const char* kind) const {
    relief::fail(Failure::input, "{}: {} must be {}", *path_, placeOf(name), kind);
}

bool GltfElement::has(std::string_view name) const { return member(name) != nullptr; }

const GltfElement& GltfElement::need(std::string_view name) const {
    if (!has(name)) relief::fail(Failure::input, "{}: {} has no {}", *path_, place_, name);
    return *this;
}

std::optional<std::uint32_t> GltfElement::integer(std::string_view name) const {
    const Json* value = member(name);
    if (value == nullptr) return std::nullopt;
    if (!isIndex(*value)) failKind(name, "a whole number from 0 to 2147483647");
    return value->get<std::uint32_t>();
}

std::uint64_t GltfElement::size(std::string_view name) const {
    const Json* value = member(name);
    if (value == nullptr) return 0;
    if (!isWhole(*value, std::numeric_limits<std::uint32_t>::max()))
        failKind(name, "a whole number from 0 to 4294967295");
    return value->get<std::uint64_t>();
}

bool GltfElement::boolean(std::string_view name) const {
    const Json* value = member(name);
    if (value == nullptr) return false;
    if (!value->is_boolean()) failKind(name, "true or false");
    return value->get<bool>();
}

std::string GltfElement::text(std::string_view name) const {
    const Json* value = member(name);
    if (value == nullptr) return "";
    if (!value->is_string()) failKind(name, "a string");
    return value->get<std::string>();
}

std::optional<double> GltfElement::number(std::string_view name) const {
    const Json* value = member(name);
    if (value == nullptr) return std::nullopt;
    if (!value->is_number()) failKind(name, "a number");
    return value->get<double>();
}

std::vector<double> GltfElement::numbers(std::string_view name) const {
    const Json* value = member(name);
    if (value == nullptr) return {};
    if (!isListOf(*value, [](const Json& number) { return number.is_number(); })) failKind(name, "a list of numbers");
    return value->get<std::vector<double>>();
}

std::vector<std::uint32_t> GltfElement::integers(std::string_view name) const {
    const Json* value = member(name);
    if (value == nullptr) return {};
    if (!isListOf(*value, isIndex)) failKind(name, "a list of whole numbers from 0 to 2147483647");
    return value->get<std::vector<std::uint32_t>>();
}

std::optional<GltfElement> GltfElement::object(std::string_view name) const {
    const Json* value = member(name);
    if (value == nullptr) return std::nullopt;
    return GltfElement(*value, *path_, placeOf(name));
}

std::size_t GltfElement::count(std::string_view name) const {
    const Json* value = member(name);
    if (value == nullptr) return 0;
    if (!value->is_array()) failKind(name, "a list of objects");
    return value->size();
}

GltfElement GltfElement::at(std::string_view name, std::size_t index) const {
    return {(*member(name))[index], *path_, fmt::format("{}/{}", placeOf(name), index)};
}

std::string GltfElement::name() const {
    const Json* value = member("name");
    return value != nullptr && value->is_string() ? value->get<std::string>() : "";
}

std::optional<GltfElement> GltfElement::extension(std::string_view name) const {
    const Json* all = member("extensions");
    if (all == nullptr || !all->is_object()) return std::nullopt;
    return GltfElement(*all, *path_, placeOf("extensions")).object(name);
}

Json parseGltfJson(std::string_view text, const std::string& path, const Warn& warn) {
    if (text.size() > kLongest)
        fail(Failure::input, "{}: {} of JSON; up to {} are read", path, humanBytes(text.size()), humanBytes(kLongest));
    checkDepth(text, path);
    Json json;
    try {
        json = Json::parse(text);
    } catch (const Json::exception& error) {
        fail(Failure::input, "{}: no valid JSON:{}", path, printable(reasonOf(error.what())));
    }
    if (!json.is_object()) fail(Failure::input, "{}: has no asset, so it is no glTF", path);
    checkVersion(json, path);
    checkExtensions(json, path, warn);
    return json;
}

} // namespace relief
