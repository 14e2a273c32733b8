#include "formula/compile.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <set>

#include <pthread.h>

#include <glslang/Public/ResourceLimits.h>
#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>

#include "formula/sources.h"
#include "formula/tokens.h"

namespace relief {
namespace {

/// How the function is put among other text: `#include "height_function.glsl"` in shaders/function.glsl means this. The
/// second include is the function itself, under its author's name.
std::string functionText(const IsolatedText& isolated) {
    return fmt::format("int formula_turns = 0;\n"
                       "bool formula_turn() {{ return ++formula_turns <= {}; }}\n"
                       "#include \"function\"\n"
                       "\nfloat formula_value(vec3 p, vec2 st, float t) {{\n"
                       "    formula_turns = 0;\n"
                       "    return formula_height(p, st, t);\n"
                       "}}\n"
                       "{}",
                       kMostFunctionTurns, isolated.statesBound ? "#define FORMULA_STATES_BOUND\n" : "");
}

/// FunctionEvaluator's shader: nothing of shaders/ is in it.
constexpr std::string_view kEvaluator = R"(#version 460
#extension GL_GOOGLE_include_directive : require
layout(local_size_x = 64) in;
layout(std430, set = 0, binding = 0) readonly buffer Points { float points[]; };
layout(std430, set = 0, binding = 1) writeonly buffer Values { uint values[]; };
layout(push_constant) uniform Push { uint count; };
)"
                                        "#include \"height_function.glsl\"\n"
                                        R"(
void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    float value = formula_value(vec3(points[6u * i], points[6u * i + 1u], points[6u * i + 2u]),
                                vec2(points[6u * i + 3u], points[6u * i + 4u]), points[6u * i + 5u]);
    values[2u * i] = floatBitsToUint(value);
    values[2u * i + 1u] = uint(formula_turns);
#ifdef FORMULA_STATES_BOUND
    if (i == 0u) values[2u * count] = floatBitsToUint(formula_kBound);
#endif
}
)";

class Includer : public glslang::TShader::Includer {
public:
    Includer(const FunctionText& function, const IsolatedText& isolated)
        : function_(function), isolated_(isolated), wrapped_(functionText(isolated)) {}

    IncludeResult* includeLocal(const char* name, const char*, std::size_t) override {
        const std::string_view word(name);
        if (word == "height_function.glsl") return resultOf(name, wrapped_);
        if (word == "function") return resultOf(function_.name, isolated_.text);
        const ShaderSource* source = findShaderSource(word);
        return source != nullptr ? resultOf(name, source->text) : nullptr;
    }
    void releaseInclude(IncludeResult* result) override { delete result; }

private:
    static IncludeResult* resultOf(const std::string& name, std::string_view text) {
        return new IncludeResult(name, text.data(), text.size(), nullptr);
    }

    const FunctionText& function_;
    const IsolatedText& isolated_;
    std::string wrapped_;
};

EShLanguage languageOf(std::string_view file) {
    if (file.ends_with(".vert")) return EShLangVertex;
    if (file.ends_with(".tesc")) return EShLangTessControl;
    if (file.ends_with(".tese")) return EShLangTessEvaluation;
    if (file.ends_with(".frag")) return EShLangFragment;
    return EShLangCompute;
}

void startCompiler() {
    static std::once_flag once;
    std::call_once(once, [] { glslang::InitializeProcess(); });
}

std::string without(std::string text, std::string_view part) {
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at))
        text.erase(at, part.size());
    return text;
}

std::string replaced(std::string text, std::string_view part, std::string_view by) {
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + by.size()))
        text.replace(at, part.size(), by);
    return text;
}

/// The compiler's words for signs, and its phrases that say nothing to an author.
std::string inPlainWords(std::string message) {
    constexpr std::pair<std::string_view, std::string_view> kWords[] = {
        {"LEFT_PAREN", "'('"},   {"RIGHT_PAREN", "')'"},
        {"LEFT_BRACKET", "'['"}, {"RIGHT_BRACKET", "']'"},
        {"LEFT_BRACE", "'{'"},   {"RIGHT_BRACE", "'}'"},
        {"SEMICOLON", "';'"},    {"COMMA", "','"},
        {"COLON", "':'"},        {"EQUAL", "'='"},
        {"$end", "the end"},     {"'' : ", ""},
        {":  ", ": "},           {"memory exhausted", "brackets are nested too deep"}};
    for (const auto& [word, plain] : kWords) message = replaced(std::move(message), word, plain);
    constexpr std::string_view kExtension = "required extension not requested";
    if (const std::size_t at = message.find(kExtension); at != std::string::npos)
        message = message.substr(0, at) + "needs an extension of GLSL, and a height function has none";
    return message.substr(0, message.find_last_not_of(" :") + 1);
}

/// The line of a text where a word first stands as a whole; 1 where it does not.
std::ptrdiff_t lineOf(std::string_view word, std::string_view text) {
    for (const Token& token : readTokens(text))
        if (token.text == word) return token.line;
    return 1;
}

/// The line of the last #if or #elif before another line.
int lineOfCondition(std::string_view text, int before) {
    int line = 1;
    for (const Token& token : readTokens(text))
        if (token.isOfDirective && (token.text == "if" || token.text == "elif") && token.line < before)
            line = token.line;
    return line;
}

/// "Recursion detected:", and on the line below "f(f1; calling g(f1;".
[[noreturn]] void failOfRecursion(const FunctionText& function, std::string_view log) {
    constexpr std::string_view kCalling = " calling ";
    const std::size_t calling = std::min(log.find(kCalling), log.size());
    const std::size_t start = log.find_last_of(" \n\t", calling > 0 ? calling - 1 : 0) + 1;
    const std::string_view called = log.substr(std::min(calling + kCalling.size(), log.size()));
    const std::string from = without(std::string(log.substr(start, log.find('(', start) - start)), kFunctionPrefix);
    const std::string to = without(std::string(called.substr(0, called.find('('))), kFunctionPrefix);
    fail(Failure::input, "{}:{}: {} calls {}: there is no recursion in GLSL", function.name,
         lineOf(from, function.text), from, from == to ? "itself" : to + ", which comes back to it");
}

/// One line of the compiler's log: the first error, at the function's own line where it lies there.
[[noreturn]] void failToCompile(const FunctionText& function, const ShaderRequest& request, std::string_view log) {
    constexpr std::string_view kError = "ERROR: ";
    if (log.find("Recursion detected") != std::string_view::npos) failOfRecursion(function, log);
    const std::size_t start = std::min(log.find(kError), log.size());
    const std::string line = without(std::string(log.substr(start, log.find('\n', start) - start)), kFunctionPrefix);
    const std::string own = fmt::format("{}{}:", kError, function.name);
    if (line.starts_with(own)) {
        // A condition is evaluated once its line has been read: the compiler names the next one.
        const std::string_view message = std::string_view(line).substr(own.size());
        if (message.find("'preprocessor evaluation'") != std::string_view::npos)
            fail(Failure::input, "{}:{}: the condition of this #if is no number", function.name,
                 lineOfCondition(function.text, std::atoi(message.data())));
        fail(Failure::input, "{}:{}", function.name, inPlainWords(std::string(message)));
    }
    if (!request.file.empty()) fail(Failure::internal, "{} with {}: {}", request.file, function.name, line);
    for (const char* mismatch :
         {"no matching overloaded function", "cannot convert return value", "type does not match"})
        if (line.find(mismatch) != std::string::npos)
            fail(Failure::input, "{}:{}: the function height is not float height(vec3 p, vec2 st, float t)",
                 function.name, lineOf("height", function.text));
    // What is left open shows behind the last line.
    const auto lines = 1 + std::count(function.text.begin(), function.text.end(), '\n');
    const std::size_t message = line.find(": ", kError.size());
    fail(Failure::input, "{}:{}: {}: is a brace or a semicolon missing before the end?", function.name, lines,
         inPlainWords(message == std::string::npos ? line : line.substr(message + 2)));
}

// --- SPIR-V

constexpr std::uint32_t kHeaderWords = 5, kDecorate = 71, kMemberDecorate = 72, kNoContraction = 42;

/// OpFNegate, OpFAdd, OpFSub, OpFMul, OpFDiv, OpFRem, OpFMod, and from OpVectorTimesScalar to OpDot.
bool isFloatArithmetic(std::uint32_t op) {
    return op == 127 || op == 129 || op == 131 || op == 133 || op == 136 || op == 140 || op == 141 ||
           (op >= 142 && op <= 148);
}

/// Decorates all arithmetic of floats, so that no driver contracts it in one stage and not in another.
void forbidContraction(std::vector<std::uint32_t>& words) {
    std::set<std::uint32_t> decorated;
    std::vector<std::uint32_t> added;
    std::size_t firstDecoration = 0;
    for (std::size_t at = kHeaderWords; at < words.size(); at += words[at] >> 16) {
        const std::uint32_t op = words[at] & 0xffffu;
        RELIEF_CHECK(words[at] >> 16 > 0u);
        if ((op == kDecorate || op == kMemberDecorate) && firstDecoration == 0) firstDecoration = at;
        if (op == kDecorate && words[at + 2] == kNoContraction) decorated.insert(words[at + 1]);
        if (isFloatArithmetic(op) && decorated.insert(words[at + 2]).second)
            added.insert(added.end(), {3u << 16 | kDecorate, words[at + 2], kNoContraction});
    }
    RELIEF_CHECK(firstDecoration > 0u);
    words.insert(words.begin() + std::ptrdiff_t(firstDecoration), added.begin(), added.end());
}

/// Largest array, or structure of arrays, in numbers: drivers compile larger ones for minutes.
constexpr double kMostNumbers = 1 << 14;

/// Numbers that the largest type takes.
double largestType(const std::vector<std::uint32_t>& words) {
    constexpr std::uint32_t kVector = 23, kMatrix = 24, kArray = 28, kStruct = 30, kConstant = 43;
    std::map<std::uint32_t, double> sizes, constants;
    const auto sizeOf = [&](std::uint32_t type) { return sizes.contains(type) ? sizes[type] : 1; };
    double largest = 1;
    for (std::size_t at = kHeaderWords; at < words.size(); at += words[at] >> 16) {
        const std::uint32_t op = words[at] & 0xffffu, count = words[at] >> 16;
        const std::uint32_t* operands = &words[at + 1];
        double size = 0;
        if (op == kConstant) constants[operands[1]] = operands[2];
        if (op == kVector || op == kMatrix) size = operands[2] * sizeOf(operands[1]);
        if (op == kArray) size = constants[operands[2]] * sizeOf(operands[1]);
        for (std::uint32_t i = 1; op == kStruct && i + 1 < count; ++i) size += sizeOf(operands[i]);
        if (size == 0) continue;
        sizes[operands[0]] = size;
        largest = std::max(largest, size);
    }
    return largest;
}

std::vector<std::uint32_t> compile(const FunctionText& function, const IsolatedText& isolated,
                                   const ShaderRequest& request) {
    startCompiler();
    const EShLanguage language = languageOf(request.file);
    const std::string_view text = request.file.empty() ? kEvaluator : findShaderSource(request.file)->text;
    const std::string name(request.file.empty() ? "evaluator" : request.file);
    std::string defines = "#define RELIEF_HEIGHT_FUNCTION\n";
    if (request.isTriangles) defines += "#define RELIEF_TRIANGLES\n";
    if (request.access == TableAccess::storageBuffers) defines += "#define RELIEF_STORAGE_TABLES\n";

    // As the build calls the compiler: Vulkan 1.3.
    glslang::TShader shader(language);
    const char* const start = text.data();
    const int length = int(text.size());
    const char* const nameStart = name.c_str();
    shader.setStringsWithLengthsAndNames(&start, &length, &nameStart, 1);
    shader.setPreamble(defines.c_str());
    shader.setEnvInput(glslang::EShSourceGlsl, language, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_3);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_6);
    const auto messages = EShMessages(EShMsgSpvRules | EShMsgVulkanRules);
    Includer includer(function, isolated);
    if (!shader.parse(GetDefaultResources(), 460, false, messages, includer))
        failToCompile(function, request, shader.getInfoLog());
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(messages)) failToCompile(function, request, program.getInfoLog());

    // SPIR-V as it is: shaders are optimised once their constants are known (gpu/specialize.h).
    std::vector<std::uint32_t> words;
    glslang::SpvOptions options;
    options.disableOptimizer = true;
    glslang::GlslangToSpv(*program.getIntermediate(language), words, &options);
    if (request.file.empty() && largestType(words) > kMostNumbers)
        fail(Failure::input,
             "{}: it has an array of {:.3g} numbers, {} are the most: drivers would compile for minutes", function.name,
             largestType(words), std::size_t(kMostNumbers));
    forbidContraction(words);
    return words;
}

/// The compiler walks through expressions by recursion, some hundred bytes of stack per operator: enough for
/// kMostFunctionBytes of them.
constexpr std::size_t kStackBytes = 256u << 20;

/// Calls `work` on a thread with that stack, and waits for it. Exceptions arrive here.
void runOnLargeStack(const std::function<void()>& work) {
    struct Call {
        const std::function<void()>& work;
        std::exception_ptr error;
    } call{work, nullptr};
    const auto run = [](void* argument) -> void* {
        auto& made = *static_cast<Call*>(argument);
        try {
            made.work();
        } catch (...) {
            made.error = std::current_exception();
        }
        return nullptr;
    };
    pthread_attr_t attributes;
    pthread_attr_init(&attributes);
    pthread_attr_setstacksize(&attributes, kStackBytes);
    pthread_t thread{};
    const int error = pthread_create(&thread, &attributes, run, &call);
    pthread_attr_destroy(&attributes);
    if (error != 0) fail(Failure::device, "no thread can be started to compile a height function: out of memory");
    pthread_join(thread, nullptr);
    if (call.error) std::rethrow_exception(call.error);
}

} // namespace

std::vector<std::uint32_t> compileShader(const FunctionText& function, const IsolatedText& isolated,
                                         const ShaderRequest& request) {
    std::vector<std::uint32_t> words;
    runOnLargeStack([&] { words = compile(function, isolated, request); });
    return words;
}

std::string compilerVersion() {
    const glslang::Version version = glslang::GetVersion();
    return fmt::format("{}.{}.{}{}", version.major, version.minor, version.patch, version.flavor);
}

const ShaderSource* findShaderSource(std::string_view name) {
    for (const ShaderSource& source : shaderSources())
        if (source.name == name) return &source;
    return nullptr;
}

} // namespace relief
