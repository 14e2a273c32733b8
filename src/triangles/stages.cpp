#include "triangles/stages.h"

namespace relief {

const PendingPipeline& ComputeStages::start(const char* file, const ShaderConstants& constants,
                                            const ShaderVariant& variant) {
    const std::vector<std::uint32_t> values = constants.values();
    std::vector<std::uint32_t> key = values;
    key.push_back(variant.isTriangles ? 1 : 0);
    for (const char* letter = file; *letter != 0; ++letter) key.push_back(std::uint32_t(*letter));
    return pipelines_.of(key, [&] {
        const Stage stage =
            shaderStage(device_, VK_SHADER_STAGE_COMPUTE_BIT, file, variant.function, variant.isTriangles);
        return startCompute(device_,
                            {.name = file, .stage = stage, .constants = values, .layout = passLayout(device_)});
    });
}

const PendingPipeline& ComputeStages::start(const char* file, const SurfaceModel& model,
                                            const ShaderConstants& constants) {
    return start(file, constants, {.function = model.function.get(), .isTriangles = model.isTriangles()});
}

} // namespace relief
