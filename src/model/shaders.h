// The compiled shaders: the build turns shaders/* into SPIR-V and embeds it.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "gpu/gpu.h"

namespace relief {

/// SPIR-V of a stage by its file's name, for faces with four sides or three and for a way of reading tables. Throws
/// Failure::internal for unknown names.
std::span<const std::uint32_t> shaderCode(std::string_view name, bool isTriangles, TableAccess access);

} // namespace relief
