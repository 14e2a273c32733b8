#include "model/stages.h"

namespace relief {
namespace {

void checkQuery(const Model& model, const SampleQuery& query, std::size_t row) {
    if (query.face >= model.faces().size())
        fail(Failure::input, "point {}: face {} is not in 0..{}", row, query.face, model.faces().size() - 1);
    if (model.faces()[query.face].root == kNoPatch)
        fail(Failure::input, "point {}: face {} is a hole", row, query.face);
    const vec2 uv = query.uv;
    const bool isInside = uv.x >= 0 && uv.y >= 0 && (model.isTriangles() ? uv.x + uv.y <= 1 : uv.x <= 1 && uv.y <= 1);
    if (!isInside)
        fail(Failure::input, "point {}: (u,v) = ({}, {}) is outside the face: {}", row, uv.x, uv.y,
             model.isTriangles() ? "u, v >= 0 and u + v <= 1" : "both in 0..1");
}

} // namespace

PipelineLayoutDesc passLayout() {
    PipelineLayoutDesc layout{std::vector<VkDescriptorType>(kBindCount, VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER),
                              sizeof(PushConstants)};
    layout.bindings[kBindScene] = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
    for (const std::uint32_t image :
         {kBindHeight, kBindAlbedo, kBindEnvironment, kBindShadow, kBindDepths, kBindNormals, kBindColors})
        layout.bindings[image] = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    return layout;
}

TexelBuffer uploadWords(Device& device, const std::string& name, std::span<const std::uint32_t> words) {
    return uploadTexels(device, {.name = name}, VK_FORMAT_R32_UINT, std::as_bytes(words));
}

Buffer makeSceneBuffer(Device& device) {
    return makeBuffer(device, {.name = "scene",
                               .bytes = sizeof(Scene),
                               .usage = VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT});
}

void writeScene(VkCommandBuffer commands, const Buffer& buffer, const Scene& scene) {
    vkCmdUpdateBuffer(commands, buffer.handle.get(), 0, sizeof(Scene), &scene);
    barrier(commands);
}

namespace {

/// Everything but the samples of a picture.
PipelineLayoutDesc sampleLayout() {
    PipelineLayoutDesc layout = passLayout();
    layout.bindings.resize(kBindDepths);
    return layout;
}

} // namespace

SurfaceSampler::SurfaceSampler(Device& device)
    : device_(device), sampler_(makeSampler(device, {})), scene_(makeSceneBuffer(device)),
      none_(uploadWords(device, "nothing", {})) {}

const Pipeline& SurfaceSampler::pipelineOf(const Model& model, const SampleOptions& options) {
    const ShaderConstants constants{.isGenericBasis = options.isGenericBasis,
                                    .hasTexCoords = model.hasTexCoords(),
                                    .hasHeight = model.hasHeight(),
                                    .normal = options.normal,
                                    .wantsTexCoords = true};
    std::vector<std::uint32_t> key = constants.values();
    key.push_back(model.isTriangles());
    const auto found = pipelines_.find(key);
    if (found != pipelines_.end()) return found->second;
    const Stage stage{VK_SHADER_STAGE_COMPUTE_BIT, shaderCode("sample.comp", model.isTriangles())};
    return pipelines_[key] = makeCompute(
               device_, {.name = "sample", .stage = stage, .constants = constants.values(), .layout = sampleLayout()});
}

std::vector<SampleResult> SurfaceSampler::sample(const Model& model, std::span<const SampleQuery> queries,
                                                 const SampleOptions& options) {
    for (std::size_t i = 0; i < queries.size(); ++i) checkQuery(model, queries[i], options.firstRow + i);
    const Buffer in = uploadArray(device_, "queries", queries);
    std::vector<SampleResult> results(queries.size());
    const Buffer out =
        makeBuffer(device_, {.name = "results",
                             .bytes = results.size() * sizeof(SampleResult),
                             .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT});
    // What the shader does not read is bound all the same: Mesa 22.3's CPU driver walks every descriptor of a set.
    Scene scene{};
    Binding bindings[kBindCount];
    model.describe(scene, bindings);
    scene.sampleQueries = in.address;
    scene.sampleResults = out.address;
    bindings[kBindScene].uniform = scene_.handle.get();
    bindings[kBindEnvironment].view = bindings[kBindShadow].view = bindings[kBindAlbedo].view;
    bindings[kBindEdgeRates].texels = bindings[kBindDrawFaces].texels = none_.view.get();
    for (const std::uint32_t image : {kBindHeight, kBindAlbedo, kBindEnvironment, kBindShadow})
        bindings[image].sampler = sampler_.get();

    const Pipeline& pipeline = pipelineOf(model, options);
    const PipelineLayoutDesc layout = sampleLayout();
    const BindingSet set = makeBindingSet(device_, pipeline, layout, std::span(bindings, layout.bindings.size()));
    device_.run([&](VkCommandBuffer commands) {
        writeScene(commands, scene_, scene);
        bind(commands, pipeline, set);
        pushConstants(commands, pipeline, {.passNumber = std::uint32_t(queries.size())});
        vkCmdDispatch(commands, std::uint32_t((queries.size() + 63) / 64), 1, 1);
    });
    downloadBytes(device_, out, std::as_writable_bytes(std::span(results)));
    return results;
}

} // namespace relief
