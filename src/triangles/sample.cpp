#include <algorithm>

#include "triangles/stages.h"

namespace relief {
namespace {

void checkQuery(const SurfaceModel& model, const SampleQuery& query, std::size_t row) {
    if (query.face >= model.faces.size())
        fail(Failure::input, "point {}: face {} is not in 0..{}", row, query.face, model.faces.size() - 1);
    if (model.faces[query.face].root == kNoPatch) fail(Failure::input, "point {}: face {} is a hole", row, query.face);
    const vec2 uv = query.uv;
    const bool isInside = uv.x >= 0 && uv.y >= 0 && (model.isTriangles() ? uv.x + uv.y <= 1 : uv.x <= 1 && uv.y <= 1);
    if (!isInside)
        fail(Failure::input, "point {}: (u,v) = ({}, {}) is outside the face: {}", row, uv.x, uv.y,
             model.isTriangles() ? "u, v >= 0 and u + v <= 1" : "both in 0..1");
}

} // namespace

struct SurfaceSampler::Parts {
    explicit Parts(Device& device) : device(device), resources(device), stages(device) {}
    Device& device;
    PassResources resources;
    ComputeStages stages;
};

SurfaceSampler::SurfaceSampler(Device& device) : parts_(std::make_unique<Parts>(device)) {}
SurfaceSampler::~SurfaceSampler() = default;

std::vector<SampleResult> SurfaceSampler::sample(const SurfaceModel& model, std::span<const SampleQuery> queries,
                                                 const SampleOptions& options) {
    for (std::size_t i = 0; i < queries.size(); ++i) checkQuery(model, queries[i], options.firstRow + i);

    // What the shader reads and writes.
    Device& device = parts_->device;
    const Buffer in = uploadArray(device, "queries", queries);
    std::vector<SampleResult> results(queries.size());
    const Buffer out =
        makeBuffer(device, {.name = "results",
                            .bytes = results.size() * sizeof(SampleResult),
                            .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT});
    PassInputs inputs{};
    PassBindings bindings = parts_->resources.bindings();
    describe(model, inputs, bindings);
    inputs.targets.sampleQueries = in.address;
    inputs.targets.sampleResults = out.address;

    // One invocation per query.
    ShaderConstants constants = constantsOf(model, options.normal);
    constants.isGenericBasis = options.isGenericBasis;
    constants.wantsTexCoords = true;
    const Pipeline& pipeline = parts_->stages.pipeline("sample.comp", model, constants);
    const Download download(device, results.size() * sizeof(SampleResult));
    const BindingSet set = makeBindingSet(device, pipeline, passLayout(device), bindings);
    device.submitAndWait([&](VkCommandBuffer commands) {
        parts_->resources.write(commands, inputs);
        bind(commands, pipeline, set);
        pushConstants(commands, pipeline, SamplePush{std::uint32_t(queries.size())});
        vkCmdDispatch(commands, std::uint32_t((queries.size() + 63) / 64), 1, 1);
        download.record(commands, out);
    });
    std::ranges::copy(download.bytes(), std::as_writable_bytes(std::span(results)).begin());
    // A function's slopes are those by (u,v) already, which the derivatives of texture coordinates must not turn.
    if (model.function)
        for (SampleResult& result : results) result.stu = {1, 0}, result.stv = {0, 1};
    return results;
}

} // namespace relief
