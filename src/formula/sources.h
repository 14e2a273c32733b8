// Internal: the text of the shaders, as the build found it.
#pragma once

#include <span>
#include <string_view>

namespace relief {

struct ShaderSource {
    std::string_view name; ///< as in #include: "heights.glsl", "shared/inputs.h"
    std::string_view text;
};

/// All files of the folder shaders/, and osd_patch_basis.glsl.
std::span<const ShaderSource> shaderSources();
/// One of them; null where there is none of that name.
const ShaderSource* findShaderSource(std::string_view name);

} // namespace relief
