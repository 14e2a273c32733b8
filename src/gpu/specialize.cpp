#include "gpu/specialize.h"

#include <string>
#include <string_view>
#include <unordered_map>

#include <spirv-tools/optimizer.hpp>

#include "gpu/shader_cache.h"

namespace relief {
namespace {

constexpr std::string_view kPassesVersion = "specialize 1"; ///< of what is done here, for keys of the cache

std::string_view bytesOf(std::span<const std::uint32_t> words) {
    return {reinterpret_cast<const char*>(words.data()), words.size_bytes()};
}

/// The constants get their values, branches that these decide go, and what nobody reads any more. None of these passes
/// regroups arithmetic: what is folded has operands that are all constant.
void registerPasses(spvtools::Optimizer& optimizer, std::span<const std::uint32_t> constants) {
    std::unordered_map<std::uint32_t, std::vector<std::uint32_t>> values;
    for (std::uint32_t i = 0; i < constants.size(); ++i) values[i] = {constants[i]};
    optimizer.RegisterPass(spvtools::CreateSetSpecConstantDefaultValuePass(values))
        .RegisterPass(spvtools::CreateFreezeSpecConstantValuePass())
        .RegisterPass(spvtools::CreateFoldSpecConstantOpAndCompositePass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateCFGCleanupPass())
        .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateScalarReplacementPass())
        .RegisterPass(spvtools::CreateSSARewritePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateCFGCleanupPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        .RegisterPass(spvtools::CreateCompactIdsPass());
}

} // namespace

std::vector<std::uint32_t> specialize(std::span<const std::uint32_t> code, std::span<const std::uint32_t> constants) {
    Digest digest = makeDigest();
    digest.add(kPassesVersion);
    digest.add(bytesOf(constants));
    digest.add(bytesOf(code));
    if (auto kept = readCachedShader(digest)) return std::move(*kept);

    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_3);
    registerPasses(optimizer, constants);
    spvtools::OptimizerOptions options;
    options.set_run_validator(false); // the validation layer does it where it is on
    std::vector<std::uint32_t> words;
    if (!optimizer.Run(code.data(), code.size(), &words, options)) return {code.begin(), code.end()};
    writeCachedShader(digest, words);
    return words;
}

} // namespace relief
