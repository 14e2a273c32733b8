#include <algorithm>
#include <bit>
#include <cstring>

#include "formula/formula.h"

namespace relief {
namespace {

constexpr std::size_t kPointsAtOnce = 1u << 20; ///< of one submission
constexpr std::uint32_t kGroup = 64;

} // namespace

FunctionEvaluator::FunctionEvaluator(Device& device, const HeightFunction& function)
    : device_(device),
      function_(function), layout_{{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                                   sizeof(std::uint32_t)},
      pipeline_(makeCompute(device, {.name = "height function",
                                     .stage = {VK_SHADER_STAGE_COMPUTE_BIT, function.evaluator()},
                                     .constants = {},
                                     .layout = layout_})) {}

std::vector<FunctionValue> FunctionEvaluator::evaluate(std::span<const FunctionPoint> points) {
    static_assert(sizeof(FunctionPoint) == 24);
    std::vector<FunctionValue> values;
    values.reserve(points.size());
    for (std::size_t first = 0; first < points.size(); first += kPointsAtOnce)
        for (const FunctionValue& value :
             evaluatePart(points.subspan(first, std::min(kPointsAtOnce, points.size() - first))).values)
            values.push_back(value);
    return values;
}

float FunctionEvaluator::bound() {
    RELIEF_CHECK(function_.statesBound());
    const FunctionPoint any;
    return evaluatePart(std::span(&any, 1)).bound;
}

FunctionEvaluator::Part FunctionEvaluator::evaluatePart(std::span<const FunctionPoint> points) {
    // Two words per point, and the bound.
    std::vector<std::uint32_t> words(2 * points.size() + 1);
    const Buffer in = uploadArray(device_, "points", points);
    const Buffer out =
        makeBuffer(device_, {.name = "values",
                             .bytes = words.size() * sizeof(std::uint32_t),
                             .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT});
    const Binding bindings[] = {{.storage = in.handle.get()}, {.storage = out.handle.get()}};
    const BindingSet set = makeBindingSet(device_, pipeline_, layout_, bindings);
    const Download download(device_, words.size() * sizeof(std::uint32_t));
    device_.submitAndWait([&](VkCommandBuffer commands) {
        bind(commands, pipeline_, set);
        const std::uint32_t block = std::uint32_t(points.size());
        push(commands, pipeline_, std::as_bytes(std::span(&block, 1)));
        vkCmdDispatch(commands, std::uint32_t((points.size() + kGroup - 1) / kGroup), 1, 1);
        download.record(commands, out);
    });
    std::memcpy(words.data(), download.bytes().data(), words.size() * sizeof(std::uint32_t));

    // Each value, whether its loops ran out, and the bound that the function states itself.
    Part part;
    part.values.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        part.values.push_back(
            {std::bit_cast<float>(words[2 * i]), words[2 * i + 1] > std::uint32_t(kMostFunctionTurns)});
    part.bound = std::bit_cast<float>(words.back());
    return part;
}

} // namespace relief
