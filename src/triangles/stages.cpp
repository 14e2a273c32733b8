#include "triangles/stages.h"

namespace relief {

const PendingPipeline& ComputeStages::start(const char* file, const SurfaceModel& model,
                                            const ShaderConstants& constants) {
    std::pair<std::string, std::vector<std::uint32_t>> key{file, constants.values()};
    key.second.push_back(model.isTriangles());
    const auto found = pipelines_.find(key);
    if (found != pipelines_.end()) return found->second;
    std::erase_if(pipelines_, [](const auto& each) { return areOfGoneFunction(each.first.second); });
    const Stage stage = shaderStage(device_, VK_SHADER_STAGE_COMPUTE_BIT, file, model);
    return pipelines_[key] = startCompute(
               device_, {.name = file, .stage = stage, .constants = constants.values(), .layout = passLayout(device_)});
}

} // namespace relief
