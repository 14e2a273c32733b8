#include <algorithm>
#include <limits>
#include <optional>

#include "cage/gltf_json.h"

namespace relief {
namespace {

using Json = nlohmann::json;

constexpr std::uint64_t kLongest = 512ull << 20;
constexpr int kDeepest = 100; // brackets in brackets: some readers walk them recursively

/// What a member must be. tinygltf takes one of another type as missing and cuts numbers to 32 bits.
enum class Kind { integer, size, integers, numbers, boolean, string, object, objects, either };

struct MemberKind {
    std::string_view name;
    Kind kind;
};

constexpr MemberKind kMemberKinds[] = {
    {"accessors", Kind::objects},
    {"animations", Kind::objects},
    {"asset", Kind::object},
    {"attributes", Kind::object},
    {"buffer", Kind::integer},
    {"bufferView", Kind::integer},
    {"bufferViews", Kind::objects},
    {"buffers", Kind::objects},
    {"byteLength", Kind::size},
    {"byteOffset", Kind::size},
    {"byteStride", Kind::integer},
    {"channels", Kind::objects},
    {"children", Kind::integers},
    {"componentType", Kind::integer},
    {"count", Kind::integer},
    {"indices", Kind::either}, // of a primitive; in sparse accessors an object
    {"input", Kind::integer},
    {"interpolation", Kind::string},
    {"inverseBindMatrices", Kind::integer},
    {"joints", Kind::integers},
    {"material", Kind::integer},
    {"materials", Kind::objects},
    {"matrix", Kind::numbers},
    {"mesh", Kind::integer},
    {"meshes", Kind::objects},
    {"mode", Kind::integer},
    {"name", Kind::string},
    {"node", Kind::integer},
    {"nodes", Kind::either}, // of a scene; at the top objects
    {"normalized", Kind::boolean},
    {"output", Kind::integer},
    {"path", Kind::string},
    {"primitives", Kind::objects},
    {"rotation", Kind::numbers},
    {"sampler", Kind::integer},
    {"samplers", Kind::objects},
    {"scale", Kind::numbers},
    {"scene", Kind::integer},
    {"scenes", Kind::objects},
    {"skin", Kind::integer},
    {"skins", Kind::objects},
    {"sparse", Kind::object},
    {"target", Kind::either}, // of a channel an object; of buffer views {"targets",
                              // Kind::objects},
    {"translation", Kind::numbers},
    {"type", Kind::string},
    {"uri", Kind::string},
    {"values", Kind::object},
    {"version", Kind::string},
    {"weights", Kind::numbers},
};

struct RequiredMember {
    std::string_view parent, name;
};

constexpr RequiredMember kRequiredMembers[] = {
    {"accessors", "componentType"},
    {"accessors", "count"},
    {"accessors", "type"},
    {"asset", "version"},
    {"bufferViews", "buffer"},
    {"bufferViews", "byteLength"},
    {"buffers", "byteLength"},
    {"channels", "sampler"},
    {"channels", "target"},
    {"primitives", "attributes"},
    {"samplers", "input"},
    {"samplers", "output"},
    {"skins", "joints"},
    {"sparse", "count"},
    {"sparse", "indices"},
    {"sparse", "values"},
    {"target", "path"},
};

/// Members of the file's object that say something about geometry.
constexpr std::string_view kTopMembers[] = {
    "accessors", "animations", "asset", "bufferViews", "buffers", "extensionsRequired", "extensionsUsed", "materials",
    "meshes",    "nodes",      "scene", "scenes",      "skins"};

bool isSize(const Json& value) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= std::numeric_limits<std::uint32_t>::max();
}

bool isInteger(const Json& value) {
    return value.is_number_unsigned() && value.get<std::uint64_t>() <= std::numeric_limits<std::int32_t>::max();
}

template <typename Is>
bool areAll(const Json& values, const Is& is) {
    return std::all_of(values.begin(), values.end(), is);
}

bool isNumber(const Json& value) { return value.is_number(); }
bool isObject(const Json& value) { return value.is_object(); }
bool areIntegers(const Json& value) { return value.is_array() && areAll(value, isInteger); }
bool areObjects(const Json& value) { return value.is_array() && areAll(value, isObject); }

bool isOfKind(const Json& value, Kind kind) {
    switch (kind) {
    case Kind::integer: return isInteger(value);
    case Kind::size: return isSize(value);
    case Kind::integers: return areIntegers(value);
    case Kind::numbers: return value.is_array() && areAll(value, isNumber);
    case Kind::boolean: return value.is_boolean();
    case Kind::string: return value.is_string();
    case Kind::object: return value.is_object();
    case Kind::objects: return areObjects(value);
    case Kind::either: return isInteger(value) || areIntegers(value) || isObject(value) || areObjects(value);
    }
    return false;
}

const char* wordsFor(Kind kind) {
    switch (kind) {
    case Kind::integer: return "a whole number from 0 to 2147483647";
    case Kind::size: return "a whole number from 0 to 4294967295";
    case Kind::integers: return "a list of whole numbers from 0 to 2147483647";
    case Kind::numbers: return "a list of numbers";
    case Kind::boolean: return "true or false";
    case Kind::string: return "a string";
    case Kind::object: return "an object";
    case Kind::objects: return "a list of objects";
    case Kind::either: return "whole numbers from 0 to 2147483647, or objects";
    }
    return "";
}

std::optional<Kind> kindOf(std::string_view name) {
    for (const MemberKind& member : kMemberKinds)
        if (member.name == name) return member.kind;
    return std::nullopt;
}

void checkRequired(const Json& object, std::string_view parent, const std::string& place, const std::string& path) {
    for (const RequiredMember& member : kRequiredMembers)
        if (member.parent == parent && !object.contains(member.name))
            fail(Failure::input, "{}: {} has no {}", path, place, member.name);
}

/// `name` is the member that holds the value, or that holds the list that holds it.
void checkMembers(const Json& value, std::string_view name, const std::string& place, const std::string& path) {
    if (value.is_array())
        for (std::size_t i = 0; i < value.size() && value[i].is_structured(); ++i)
            checkMembers(value[i], name, fmt::format("{}/{}", place, i), path);
    if (!value.is_object()) return;
    checkRequired(value, name, place, path);
    const bool isOfAttributes = name == "attributes" || name == "targets"; // named by their meanings
    for (const auto& [key, member] : value.items()) {
        const std::string memberPlace = place.empty() ? key : fmt::format("{}/{}", place, printable(key));
        const std::optional<Kind> kind = isOfAttributes ? Kind::integer : kindOf(key);
        if (kind && !isOfKind(member, *kind))
            fail(Failure::input, "{}: {} must be {}", path, memberPlace, wordsFor(*kind));
        checkMembers(member, key, memberPlace, path);
    }
}

void keepTopMembers(Json& json) {
    for (auto member = json.begin(); member != json.end();) {
        const bool isKept =
            std::find(std::begin(kTopMembers), std::end(kTopMembers), member.key()) != std::end(kTopMembers);
        member = isKept ? std::next(member) : json.erase(member);
    }
}

/// What others may fill as they like.
void dropForeign(Json& value) {
    if (value.is_object()) value.erase("extras"), value.erase("extensions");
    for (Json& member : value)
        if (member.is_structured()) dropForeign(member);
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

} // namespace

std::string printable(std::string_view text) {
    constexpr std::size_t kLongestText = 160;
    text = text.substr(0, text.find('\n'));
    std::string line(text.substr(0, kLongestText));
    for (char& letter : line)
        if (static_cast<unsigned char>(letter) < ' ' || letter == '\x7f') letter = '?';
    return text.size() > kLongestText ? line + "..." : line;
}

Json parseGltfJson(std::string_view text, const std::string& path) {
    if (text.size() > kLongest)
        fail(Failure::input, "{}: {} of JSON; up to {} are read", path, humanBytes(text.size()), humanBytes(kLongest));
    checkDepth(text, path);
    Json json;
    try {
        json = Json::parse(text);
    } catch (const Json::exception& error) {
        fail(Failure::input, "{}: no valid JSON:{}", path, printable(reasonOf(error.what())));
    }
    if (!json.is_object() || !json.contains("asset")) fail(Failure::input, "{}: has no asset, so it is no glTF", path);
    keepTopMembers(json);
    dropForeign(json);
    checkMembers(json, "", "", path);
    return json;
}

} // namespace relief
