#pragma once

#include <nlohmann/json.hpp>

#include "cage/gltf.h"

namespace relief {

/// The JSON of a glTF file without what says nothing about geometry. Throws Failure::input, naming the member's place
/// ("meshes/0/primitives/1/indices"), for members of a wrong type and missing ones.
nlohmann::json parseGltfJson(std::string_view text, const std::string& path);

} // namespace relief
