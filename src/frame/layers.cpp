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
    constants.readsSampleBuffers = frame.raster == Raster::compute;
    return computes.start(
        "layers.comp", constants,
        {.function = drawn.surface != nullptr ? drawn.function() : nullptr, .isTriangles = drawn.isTriangles()});
}

/// Each instance writes the pixels that see it, the first one also those that see nothing.
void Renderer::Parts::layerValuesPass(VkCommandBuffer commands, const Frame& frame) {
    for (const Drawn& drawn : frame.drawn) {
        bind(commands, layerPipeline(frame, drawn).get(), drawn.set);
        vkCmdDispatch(commands, std::uint32_t(desc.width + 7) / 8, std::uint32_t(desc.height + 7) / 8, 1);
    }
    barrier(commands);
}

void Renderer::Parts::useLayerImages(Frame& frame) {
    if (!layerTargets) layerTargets = makeLayerTargets(device, desc);
    if (frame.hasInstances() && !layerTargets->instances)
        layerTargets->instances = makeInstanceTarget(device, desc, VK_SAMPLE_COUNT_1_BIT);
    for (Drawn& drawn : frame.drawn) {
        drawn.bindings[kBindDepths].view = layerTargets->depths.view.get();
        drawn.bindings[kBindNormals].view = layerTargets->normals.view.get();
        drawn.bindings[kBindColors].view = layerTargets->surfacePoints.view.get();
        drawn.bindings[kBindInstances] = resources.bindings()[kBindInstances];
        if (frame.hasInstances()) drawn.bindings[kBindInstances].view = layerTargets->instances->view.get();
    }
}

/// The samples and colours of the picture, which is finished, hold those of layers now.
void Renderer::Parts::useLayerBuffers(Frame& frame) {
    useSampleTables(frame, true);
    for (Drawn& drawn : frame.drawn) {
        for (const std::uint32_t slot : {kBindDepths, kBindNormals, kBindColors, kBindInstances})
            drawn.bindings[slot] = resources.bindings()[slot]; // images of one sample, which nothing reads
        drawn.bindings[kBindSampleColors] = buffers->colors.binding();
        if (frame.hasInstances()) drawn.bindings[kBindSampleInstances] = buffers->instances.binding();
        useDicedFaces(drawn);
    }
}

/// The triangles of the picture with one sample per pixel, by the same rasterizer. Vertices of a diced mesh belong to
/// several faces, which layers keep apart: draws of the device are one per face.
void Renderer::Parts::renderLayers(Frame& frame, Picture& picture) {
    // The instances of the picture again, with other targets.
    const bool inCompute = frame.raster == Raster::compute;
    if (layerValues.bytes == 0) layerValues = makeLayerBuffer(device, desc);
    for (Drawn& drawn : frame.drawn) drawn.inputs.targets.layers = layerValues.address;
    if (inCompute)
        useLayerBuffers(frame);
    else
        useLayerImages(frame);
    makeSets(frame, DrawPass::layers);

    // What each pixel sees, then what that is.
    const auto record = [&](VkCommandBuffer commands) {
        writeInputs(commands, frame);
        if (inCompute) {
            rasterize(commands, frame, {DrawPass::layers, buffers->samples.buffer, size()});
            resolveLayers(commands, frame);
        } else {
            layerPass(commands, frame);
        }
        layerValuesPass(commands, frame);
    };
    if (inCompute)
        submitRastered(record);
    else
        device.submitAndWait(record);

    // Layers have cage units, whatever the unit of the model is.
    const auto* values = static_cast<const float*>(layerValues.mapped);
    picture.layerValues.assign(values, values + std::size_t(desc.width) * std::size_t(desc.height) * kLayerChannels);
    if (frame.options.unit != 1) scaleLengths(picture.layerValues, frame.options.unit);
    picture.layers = frame.options.layers;
}

} // namespace relief
