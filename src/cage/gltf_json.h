// The JSON of a glTF file. Members are judged where they are read and only then: what relief does not read (materials,
// cameras, extras, extensions, other animations, nodes that are not shown) may hold anything.
#pragma once

#include <optional>

#include <nlohmann/json.hpp>

#include "cage/gltf.h"

namespace relief {

/// Throws Failure::input as "PATH: PLACE: ...".
template <typename... Args>
[[noreturn]] void failAtElement(const std::string& path, std::string_view place, fmt::format_string<Args...> format,
                                Args&&... args) {
    fail(Failure::input, "{}: {}: {}", path, place, fmt::format(format, std::forward<Args>(args)...));
}

/// An object of the JSON and its place ("meshes/0/primitives/1"; "" for the file's own object). Functions that read a
/// member throw Failure::input, naming the file and the member's place, where it has another type than they ask for.
class GltfElement {
public:
    /// Throws where the value is no object. `value` and `path` outlive the element.
    GltfElement(const nlohmann::json& value, const std::string& path, std::string place);

    [[nodiscard]] const std::string& path() const { return *path_; }
    [[nodiscard]] const std::string& place() const { return place_; }
    [[nodiscard]] bool has(std::string_view member) const;
    /// The element itself. Throws where it has no such member.
    [[nodiscard]] const GltfElement& need(std::string_view member) const;

    /// A whole number of 31 bits, or nothing where the member is absent.
    [[nodiscard]] std::optional<std::uint32_t> integer(std::string_view member) const;
    /// A whole number of 32 bits; 0 where it is absent.
    [[nodiscard]] std::uint64_t size(std::string_view member) const;
    [[nodiscard]] bool boolean(std::string_view member) const;
    [[nodiscard]] std::string text(std::string_view member) const;
    [[nodiscard]] std::optional<double> number(std::string_view member) const; ///< nothing where it is absent
    [[nodiscard]] std::vector<double> numbers(std::string_view member) const;
    [[nodiscard]] std::vector<std::uint32_t> integers(std::string_view member) const;
    [[nodiscard]] std::optional<GltfElement> object(std::string_view member) const;
    /// How many entries a list has; 0 where it is absent.
    [[nodiscard]] std::size_t count(std::string_view member) const;
    /// An object of a list. `index` is below count().
    [[nodiscard]] GltfElement at(std::string_view member, std::size_t index) const;

    /// The member "name", or "" where it is no string: a name changes nothing, so a wrong one is no fault.
    [[nodiscard]] std::string name() const;
    /// An object that an extension has here, or nothing.
    [[nodiscard]] std::optional<GltfElement> extension(std::string_view name) const;

    /// Throws Failure::input as "PATH: PLACE: ...".
    template <typename... Args>
    [[noreturn]] void fail(fmt::format_string<Args...> format, Args&&... args) const {
        failAtElement(*path_, place_, format, std::forward<Args>(args)...);
    }

private:
    [[nodiscard]] const nlohmann::json* member(std::string_view name) const;
    [[nodiscard]] std::string placeOf(std::string_view name) const;
    [[noreturn]] void failKind(std::string_view name, const char* kind) const;

    const nlohmann::json* value_;
    const std::string* path_;
    std::string place_;
};

/// The JSON of a file of glTF 2.0 whose extensions are known. Throws Failure::input where the text is none, names
/// another version, or requires an extension that relief does not read, before anything else is judged.
/// `warn` gets the extensions that the file can be understood without, but is then shown otherwise than it was meant.
nlohmann::json parseGltfJson(std::string_view text, const std::string& path, const Warn& warn);

} // namespace relief
