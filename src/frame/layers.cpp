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
    Rendering rendering(commands, trianglesInFlight(frame),
                        {.colors = {attachment(layerTargets->normals), attachment(layerTargets->places)},
                         .depth = attachment(layerTargets->depths),
                         .size = size()});
    draw(rendering, frame, Pass::layers);
    rendering.end();
}

void Renderer::Parts::layerValuesPass(VkCommandBuffer commands, const Frame& frame) {
    const Pipeline& pipeline = pipelineOf(frame, Pass::layerValues);
    bind(commands, pipeline, frame.set);
    pushConstants(commands, pipeline, {.passRows = frame.model.isDense() ? 1u : 0u});
    vkCmdDispatch(commands, std::uint32_t(desc.width + 7) / 8, std::uint32_t(desc.height + 7) / 8, 1);
    barrier(commands);
}

/// Vertices of a diced mesh belong to several faces, which layers tell apart: there the grid draws the same surface.
void Renderer::Parts::renderLayers(const Model& model, const RenderOptions& options, Picture& picture) {
    if (!layerTargets) layerTargets = makeLayerTargets(device, desc);
    RenderOptions own = options;
    if (own.path == Path::dice) own.path = Path::grid;
    own.show = Show::shaded;
    Frame frame{.model = model, .options = own};
    describeView(frame);
    frame.scene.layerTarget = layerTargets->values.address;
    frame.bindings[kBindDepths].view = layerTargets->depths.view.get();
    frame.bindings[kBindNormals].view = layerTargets->normals.view.get();
    frame.bindings[kBindColors].view = layerTargets->places.view.get();
    FrameStats stats;
    if (!model.isDense()) makeTriangles(frame, stats);
    frame.set = bindingSet(frame, Pass::layers);
    device.submitAndWait([&](VkCommandBuffer commands) {
        writeScene(commands, scene, frame.scene);
        layerPass(commands, frame);
        layerValuesPass(commands, frame);
    });
    const auto* values = static_cast<const float*>(layerTargets->values.mapped);
    picture.layerValues.assign(values, values + std::size_t(desc.width) * std::size_t(desc.height) * kLayerChannels);
    if (options.unit != 1) scaleLengths(picture.layerValues, options.unit);
    picture.layers = options.layers;
}

} // namespace relief
