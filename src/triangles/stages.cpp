#include "triangles/stages.h"

namespace relief {

GeometryInputs::GeometryInputs(Device& device)
    : scene_(makeSceneBuffer(device)), none_(uploadWords(device, "nothing", {})), sampler_(makeSampler(device, {})) {}

PipelineLayoutDesc GeometryInputs::layout() {
    PipelineLayoutDesc layout = passLayout();
    layout.bindings.resize(kBindDepths);
    return layout;
}

void GeometryInputs::fill(const Model& model, Scene& scene, std::span<Binding> bindings) const {
    model.describe(scene, bindings);
    bindings[kBindScene].uniform = scene_.handle.get();
    bindings[kBindEnvironment].view = bindings[kBindShadow].view = bindings[kBindAlbedo].view;
    for (const std::uint32_t image : {kBindAlbedo, kBindEnvironment, kBindShadow})
        bindings[image].sampler = sampler_.get();
    for (const std::uint32_t texels : {kBindDrawFaces, kBindDiceTable, kBindDiceTiles, kBindDiceFirsts})
        bindings[texels] = none_.binding();
    for (const std::uint32_t floats : {kBindEdgeRates, kBindLevels, kBindEdgeHeights})
        bindings[floats] = bindings[kBindPoints];
}

const Pipeline& ComputeStages::pipeline(const char* file, const Model& model, const ShaderConstants& constants) {
    std::pair<std::string, std::vector<std::uint32_t>> key{file, constants.values()};
    key.second.push_back(model.isTriangles());
    const auto found = pipelines_.find(key);
    if (found != pipelines_.end()) return found->second;
    const Stage stage{VK_SHADER_STAGE_COMPUTE_BIT, shaderCode(file, model.isTriangles())};
    return pipelines_[key] = makeCompute(
               device_,
               {.name = file, .stage = stage, .constants = constants.values(), .layout = GeometryInputs::layout()});
}

} // namespace relief
