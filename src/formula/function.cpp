#include <filesystem>
#include <map>
#include <mutex>
#include <set>

#include "base/clock.h"
#include "formula/sources.h"
#include "gpu/shader_cache.h"

namespace relief {
namespace {

constexpr std::string_view kBuiltInFolder = "functions/", kExtension = ".glsl";

/// Whether a file of shaders/ includes the function, or hands on or takes what a function needs per fragment; or one
/// that it includes does.
bool dependsOnFunction(std::string_view file, std::set<std::string_view>& seen) {
    if (file == "height_function.glsl" || file == "varyings.glsl") return true;
    const ShaderSource* source = findShaderSource(file);
    if (source == nullptr || !seen.insert(file).second) return false;
    constexpr std::string_view kInclude = "#include \"";
    for (std::size_t at = source->text.find(kInclude); at != std::string_view::npos;
         at = source->text.find(kInclude, at)) {
        at += kInclude.size();
        if (dependsOnFunction(source->text.substr(at, source->text.find('"', at) - at), seen)) return true;
    }
    return false;
}

bool dependsOnFunction(std::string_view file) {
    std::set<std::string_view> seen;
    return dependsOnFunction(file, seen);
}

/// Numbers of the functions that exist.
struct Living {
    std::mutex mutex;
    std::uint32_t lastNumber = 0;
    std::set<std::uint32_t> numbers;
};

Living& living() {
    static Living all;
    return all;
}

} // namespace

std::vector<std::string> listHeightFunctions() {
    std::vector<std::string> names;
    for (const ShaderSource& source : shaderSources())
        if (source.name.starts_with(kBuiltInFolder))
            names.emplace_back(source.name.substr(kBuiltInFolder.size(),
                                                  source.name.size() - kBuiltInFolder.size() - kExtension.size()));
    return names;
}

FunctionText readHeightFunction(const std::string& nameOrPath) {
    const ShaderSource* source = findShaderSource(fmt::format("{}{}{}", kBuiltInFolder, nameOrPath, kExtension));
    if (source != nullptr) return {nameOrPath, std::string(source->text)};
    // A name without a folder and an extension is meant for a built-in one.
    std::error_code ignored;
    if (nameOrPath.find_first_of("./") == std::string::npos && !std::filesystem::exists(nameOrPath, ignored))
        fail(Failure::file, "{}: no such file, and no height function that is built in; those are {}", nameOrPath,
             fmt::join(listHeightFunctions(), ", "));
    FunctionText function{nameOrPath, readFile(nameOrPath, kMostFunctionBytes)};
    if (function.text.starts_with("\xef\xbb\xbf")) function.text.erase(0, 3); // a byte-order mark
    return function;
}

struct HeightFunction::Parts {
    Parts();
    ~Parts();
    Parts(const Parts&) = delete;
    Parts& operator=(const Parts&) = delete;

    FunctionText function;
    IsolatedText isolated;
    std::uint32_t number = 0;
    std::mutex mutex; ///< of what follows
    std::map<ShaderRequest, std::vector<std::uint32_t>> shaders;
    Costs costs;

    std::span<const std::uint32_t> shader(const ShaderRequest& request);
    [[nodiscard]] Digest digestOf(const ShaderRequest& request) const;
};

HeightFunction::Parts::Parts() {
    const std::lock_guard lock(living().mutex);
    number = ++living().lastNumber;
    living().numbers.insert(number);
}

HeightFunction::Parts::~Parts() {
    const std::lock_guard lock(living().mutex);
    living().numbers.erase(number);
}

bool HeightFunction::lives(std::uint32_t number) {
    const std::lock_guard lock(living().mutex);
    return living().numbers.contains(number);
}

HeightFunction::HeightFunction(FunctionText text) : parts_(std::make_unique<Parts>()) {
    parts_->function = std::move(text);
    parts_->isolated = isolate(parts_->function);
    const std::size_t words = parts_->shader({}).size();
    if (words > kMostFunctionWords)
        fail(Failure::input,
             "{}: it compiles to {} words of SPIR-V, {} are the most: drivers would compile for minutes",
             parts_->function.name, words, kMostFunctionWords);
}

HeightFunction::~HeightFunction() = default;

/// Computes the digest of everything that decides what the compiler makes.
Digest HeightFunction::Parts::digestOf(const ShaderRequest& request) const {
    static const Digest ofSources = [] {
        Digest digest = makeDigest();
        digest.add(compilerVersion());
        for (const ShaderSource& source : shaderSources()) digest.add(source.name), digest.add(source.text);
        return digest;
    }();
    Digest digest = ofSources;
    digest.add(isolated.text);
    digest.add(request.file);
    digest.add(request.isTriangles ? "triangles" : "quads");
    digest.add(request.access == TableAccess::storageBuffers ? "storage" : "texels");
    return digest;
}

std::span<const std::uint32_t> HeightFunction::Parts::shader(const ShaderRequest& request) {
    const std::lock_guard lock(mutex);
    const auto found = shaders.find(request);
    if (found != shaders.end()) return found->second;
    const double start = secondsNow();
    const Digest digest = digestOf(request);
    std::optional<std::vector<std::uint32_t>> words = readCachedShader(digest);
    if (words) {
        ++costs.cachedCount;
    } else {
        words = compileShader(function, isolated, request);
        writeCachedShader(digest, *words);
        ++costs.compiledCount;
    }
    costs.milliseconds += 1e3 * (secondsNow() - start);
    return shaders[request] = std::move(*words);
}

const std::string& HeightFunction::name() const { return parts_->function.name; }
bool HeightFunction::statesBound() const { return parts_->isolated.statesBound; }
std::uint32_t HeightFunction::number() const { return parts_->number; }
HeightFunction::Costs HeightFunction::costs() const {
    const std::lock_guard lock(parts_->mutex);
    return parts_->costs;
}

std::span<const std::uint32_t> HeightFunction::shader(std::string_view file, bool isTriangles,
                                                      TableAccess access) const {
    if (!dependsOnFunction(file)) return {};
    return parts_->shader({findShaderSource(file)->name, isTriangles, access}); // a name that lasts
}

std::span<const std::uint32_t> HeightFunction::evaluator() const { return parts_->shader({}); }

std::shared_ptr<const HeightFunction> shareHeightFunction(FunctionText text) {
    static std::mutex mutex;
    static std::map<std::pair<std::string, std::string>, std::weak_ptr<const HeightFunction>> living;
    const std::lock_guard lock(mutex);
    std::erase_if(living, [](const auto& each) { return each.second.expired(); });
    std::weak_ptr<const HeightFunction>& kept = living[{text.name, text.text}];
    std::shared_ptr<const HeightFunction> function = kept.lock();
    if (!function) kept = function = std::make_shared<const HeightFunction>(std::move(text));
    return function;
}

} // namespace relief
