// Height functions: GLSL that a person wrote, compiled at run time into every shader that evaluates heights.
#pragma once

#include <memory>
#include <span>

#include "gpu/gpu.h"

namespace relief {

// --- text ---------------------------------------------------------------------------------------------------------

/// A function as its author wrote it: `float height(vec3 p, vec2 st, float t)`, with what it needs besides.
struct FunctionText {
    std::string name; ///< of its file, or of the built-in function; for messages
    std::string text;
};

/// Files of more bytes are refused.
inline constexpr std::uint64_t kMostFunctionBytes = 1u << 16;

/// Words of SPIR-V, that of the evaluator included, of a function that is accepted.
inline constexpr std::size_t kMostFunctionWords = 12000;

/// Turns that all loops of one evaluation may take together. Every loop counts: one that never ends is an error, not a
/// program that hangs. Mesa 22.3's CPU driver ends the loops of an invocation after 65,535 turns without a word, which
/// this is far below.
inline constexpr int kMostFunctionTurns = 1000;

/// Names of the functions that are built in.
std::vector<std::string> listHeightFunctions();

/// A built-in function by its name, or the text of a file.
/// Throws as readFile, with Failure::input for more than kMostFunctionBytes.
FunctionText readHeightFunction(const std::string& nameOrPath);

// --- compiled -----------------------------------------------------------------------------------------------------

/// A height function and the shaders that contain it. Each shader is compiled when it is first asked for, and kept in
/// a folder of the user (cacheFolder) for the next process.
class HeightFunction : public std::enable_shared_from_this<HeightFunction> {
public:
    /// Compiles the function alone.
    /// Throws Failure::input with the file and line of an error, for text without the function `height`, and for text
    /// that declares what is not its own: uniforms, layouts, `main`, extensions.
    explicit HeightFunction(FunctionText text);
    ~HeightFunction();

    [[nodiscard]] const std::string& name() const;
    /// True where it declares `kBound`, the largest absolute value that it returns.
    [[nodiscard]] bool statesBound() const;
    /// Differs from that of every other function of this process, and is not 0: for keys of pipelines.
    [[nodiscard]] std::uint32_t number() const;
    /// Whether a function of that number exists. Pipelines of others are of no use any more.
    [[nodiscard]] static bool lives(std::uint32_t number);

    /// SPIR-V of a stage of the folder shaders/ with this function in it; empty for a stage that is
    /// the same without it. It lives as long as the function. Several threads may ask, also for the evaluator.
    [[nodiscard]] std::span<const std::uint32_t> shader(std::string_view file, bool isTriangles,
                                                        TableAccess access) const;
    /// SPIR-V of FunctionEvaluator's shader, which contains nothing else than the function.
    [[nodiscard]] std::span<const std::uint32_t> evaluator() const;

    /// What the process has spent on it so far.
    struct Costs {
        int compiledCount = 0, cachedCount = 0; ///< shaders that were compiled, and those that were kept from before
        double milliseconds = 0;
    };
    [[nodiscard]] Costs costs() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

/// The function of that text. While one lives it is the same one, so that nothing is compiled again where only the
/// scale of its heights changes. Throws as the constructor.
std::shared_ptr<const HeightFunction> shareHeightFunction(FunctionText text);

// --- values -------------------------------------------------------------------------------------------------------

/// What a function is given.
struct FunctionPoint {
    vec3 p{0};   ///< on the limit surface at rest, cage units
    vec2 st{0};  ///< texture coordinates
    float t = 0; ///< seconds
};

/// What it returned.
struct FunctionValue {
    float value = 0;
    bool hasTooManyTurns = false; ///< its loops took more than kMostFunctionTurns
};

/// Evaluates a function on a device, apart from all other shaders.
class FunctionEvaluator {
public:
    /// The function has to outlive it.
    FunctionEvaluator(Device& device, const HeightFunction& function);

    /// One value per point.
    std::vector<FunctionValue> evaluate(std::span<const FunctionPoint> points);
    /// The function's kBound. Throws Failure::internal where it states none.
    float bound();

private:
    struct Part {
        std::vector<FunctionValue> values;
        float bound = 0;
    };
    Part evaluatePart(std::span<const FunctionPoint> points);

    Device& device_;
    const HeightFunction& function_;
    PipelineLayoutDesc layout_;
    Pipeline pipeline_;
};

} // namespace relief
