#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

namespace relief {

/// The JSON of a glTF file without what says nothing about geometry. Throws Failure::input, naming the member's place
/// ("meshes/0/primitives/1/indices"), for members of a wrong type and missing ones.
nlohmann::json parseGltfJson(std::string_view text, const std::string& path);

/// The first line of foreign words as it may stand in a message: not too long, without control characters.
std::string printable(std::string_view text);

} // namespace relief
