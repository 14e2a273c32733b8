// Internal: GLSL to SPIR-V by the library glslang.
#pragma once

#include "formula/isolate.h"

namespace relief {

/// Which shader is wanted.
struct ShaderRequest {
    std::string_view file; ///< of shaders/; empty: that of FunctionEvaluator
    bool isTriangles = false;
    TableAccess access = TableAccess::texelBuffers;

    auto operator<=>(const ShaderRequest&) const = default;
};

/// Compiles a shader with a function in it, all of its arithmetic with NoContraction: every stage gives the same bits.
/// Throws Failure::input with the file and line of an error in the function, Failure::internal for one elsewhere.
std::vector<std::uint32_t> compileShader(const FunctionText& function, const IsolatedText& isolated,
                                         const ShaderRequest& request);

/// The compiler's version, for keys of caches.
std::string compilerVersion();

} // namespace relief
