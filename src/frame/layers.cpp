// Layers: what a pixel sees besides light.
#include <algorithm>

#include "frame/renderer_parts.h"

namespace relief {
namespace {

/// Where nothing is seen the depth stays behind everything.
void scaleLengths(std::vector<float>& values, double unit) {
    for (std::size_t first = 0; first < values.size(); first += kLayerChannels) {
        float &depth = values[first + kLayerDepth], &height = values[first + kLayerHeight];
        const bool isSeen = values[first + kLayerFace] >= 0;
        depth = float(isSeen ? unit * depth : std::max(unit, 1.0) * depth);
        height = float(unit * height);
    }
}

} // namespace

void Renderer::Parts::layerPass(VkCommandBuffer commands, const Frame& frame) {
    Rendering::Targets all{.colors = {attachment(layerTargets->normals), attachment(layerTargets->surfacePoints)},
                           .depth = attachment(layerTargets->depths),
                           .size = size()};
    if (frame.hasInstances()) all.colors.push_back(attachment(*layerTargets->instances));
    Rendering rendering = begin(commands, frame, std::move(all));
    draw(rendering, frame, DrawPass::layers);
    rendering.end();
}

const PendingPipeline& Renderer::Parts::layerPipeline(const Frame& frame, const Drawn& drawn) {
    ShaderConstants constants = constantsOf(frame, drawn, DrawPass::layers);
    constants.wantsTexCoords = false;
    constants.hasMotion = drawn.surface != nullptr && drawn.surface->hasMotion();
    return computePipeline("layers.comp", drawn.surface, constants);
}

/// Each instance writes the pixels that see it, the first one also those that see nothing.
void Renderer::Parts::layerValuesPass(VkCommandBuffer commands, const Frame& frame) {
    for (const Drawn& drawn : frame.drawn) {
        bind(commands, layerPipeline(frame, drawn).get(), drawn.set);
        vkCmdDispatch(commands, std::uint32_t(desc.width + 7) / 8, std::uint32_t(desc.height + 7) / 8, 1);
    }
    barrier(commands);
}

/// The triangles of the picture with one sample per pixel. Vertices of a diced mesh belong to several faces, which
/// layers keep apart: it is drawn face by face.
void Renderer::Parts::renderLayers(Frame& frame, Picture& picture) {
    // Targets are made when layers are first asked for.
    if (!layerTargets) layerTargets = makeLayerTargets(device, desc);
    if (frame.hasInstances() && !layerTargets->instances)
        layerTargets->instances = makeInstanceTarget(device, desc, VK_SAMPLE_COUNT_1_BIT);

    // The instances of the picture again, with other targets.
    for (Drawn& drawn : frame.drawn) {
        drawn.inputs.targets.layers = layerTargets->values.address;
        drawn.bindings[kBindDepths].view = layerTargets->depths.view.get();
        drawn.bindings[kBindNormals].view = layerTargets->normals.view.get();
        drawn.bindings[kBindColors].view = layerTargets->surfacePoints.view.get();
        drawn.bindings[kBindInstances] = resources.bindings()[kBindInstances];
        if (frame.hasInstances()) drawn.bindings[kBindInstances].view = layerTargets->instances->view.get();
    }
    makeSets(frame, DrawPass::layers);
    device.submitAndWait([&](VkCommandBuffer commands) {
        writeInputs(commands, frame);
        layerPass(commands, frame);
        layerValuesPass(commands, frame);
    });

    // Layers have cage units, whatever the unit of the model is.
    const auto* values = static_cast<const float*>(layerTargets->values.mapped);
    picture.layerValues.assign(values, values + std::size_t(desc.width) * std::size_t(desc.height) * kLayerChannels);
    if (frame.options.unit != 1) scaleLengths(picture.layerValues, frame.options.unit);
    picture.layers = frame.options.layers;
}

} // namespace relief
