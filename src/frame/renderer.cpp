#include "frame/renderer_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/clock.h"

namespace relief {
namespace {

SamplerDesc clampedSampler(VkFilter filter) {
    return {.filter = filter,
            .wrapU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
            .wrapV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};
}

/// The scale of a matrix that rotates and scales uniformly.
double scaleOf(const mat4& toWorld) { return std::cbrt(glm::determinant(glm::dmat3(mat3(toWorld)))); }

void checkSize(const RendererDesc& desc) {
    if (desc.width < 1 || desc.height < 1 || desc.width > 16384 || desc.height > 16384)
        fail(Failure::usage, "a picture of {} x {} is not in 1..16384 each way", desc.width, desc.height);
}

} // namespace

Renderer::Renderer(Device& device, const RendererDesc& desc) {
    checkSize(desc);
    parts_ = std::make_unique<Parts>(device, desc);
}

Renderer::~Renderer() = default;

void Renderer::resize(const RendererDesc& desc) {
    checkSize(desc);
    Parts& parts = *parts_;
    const RendererDesc before = std::exchange(parts.desc, desc);
    if (before.shadowSide != desc.shadowSide) parts.shadow.reset(), parts.buffers.reset();
    if (before.width == desc.width && before.height == desc.height) return;
    parts.images.reset();
    parts.buffers.reset();
    parts.layerTargets.reset();
    parts.layerValues = {};
    parts.occlusion = {};
    parts.picture = {}; // ends before its successor is made, which takes its memory
    parts.picture = makePictureBuffer(parts.device, desc);
}

Renderer::Parts::Parts(Device& device, const RendererDesc& desc)
    : device(device), desc(desc), picture(makePictureBuffer(device, desc)), resources(device),
      around(makeSampler(device, {.wrapV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
      nearest(makeSampler(device, clampedSampler(VK_FILTER_NEAREST))),
      smooth(makeSampler(device, clampedSampler(VK_FILTER_LINEAR))), timer(device, 8), counter(device), rater(device),
      dicer(device), computes(device) {}

// --- prepare --------------------------------------------------------------------------------------------------------

void Renderer::Parts::useEnvironment(Frame& frame) {
    const GpuEnvironment* environment = frame.options.lighting.environment;
    if (environment == nullptr) {
        if (!studio) studio = uploadEnvironment(device, studioEnvironment());
        environment = &*studio;
    }
    const double azimuth = frame.options.lighting.environmentAzimuth;
    std::ranges::copy(turnIrradiance(environment->irradiance, azimuth), frame.inputs.light.irradiance);
    frame.inputs.light.environmentTurn = float(std::remainder(azimuth, 360.0) / 360);
    for (pass::Material& material : frame.materials) {
        material.environmentLevel = environment->levelOf(material.roughness);
        if (frame.shading == kShadingPhysical) material.environmentLevel = std::round(material.environmentLevel);
    }
    frame.bindings[kBindEnvironment] = {.view = environment->levels.view.get(), .sampler = around.get()};
}

/// Camera and light in the world, and the samples of the picture: what the passes over pixels read.
void Renderer::Parts::describeView(Frame& frame) {
    // The camera. fromClip is inverted in double precision: its terms differ by many orders of magnitude.
    const RenderOptions& o = frame.options;
    pass::View& view = frame.inputs.view;
    const double aspect = double(desc.width) / desc.height;
    view.toClip = perspectiveMatrix(o.camera, aspect);
    view.toClipBefore = o.cameraBefore ? perspectiveMatrix(*o.cameraBefore, aspect) : view.toClip;
    view.fromClip = mat4(glm::inverse(glm::dmat4(view.toClip)));
    view.normalToWorld = mat3(1);
    view.eye = vec3(o.camera.eye);
    view.pictureSize = {desc.width, desc.height};

    useLight(frame, keyOf(o.lighting));
    // The samples that light.comp reads.
    frame.bindings = resources.bindings();
    useEnvironment(frame);
    useShading(frame);
    frame.inputs.material = frame.materials.front();
    frame.inputs.targets.picture = picture.address;
}

/// The images that the device draws to, as what light.comp reads. Bound are some in any case, for Vulkan wants images
/// of as many samples as the shader says: single pixels where the compute rasterizer makes the picture's.
void Renderer::Parts::useImages(Frame& frame) {
    const bool areDrawn = frame.raster == Raster::hardware;
    if (!images || (areDrawn && images->isPlaceholder)) {
        images = makeSampleImages(device, areDrawn ? desc : RendererDesc{.width = 1, .height = 1});
        images->isPlaceholder = !areDrawn;
    }
    const TextureDesc& marks = images->instances.desc;
    if (areDrawn && frame.hasInstances() && uvec2(marks.width, marks.height) != size())
        images->instances = makeInstanceTarget(device, desc, VK_SAMPLE_COUNT_4_BIT);
    const auto use = [&](std::uint32_t slot, const Texture& image) {
        frame.bindings[slot] = {.view = image.view.get(), .sampler = nearest.get()};
    };
    if (frame.castsShadows() && frame.shadowRaster == Raster::hardware) {
        if (!shadow) shadow = makeShadowImage(device, desc);
        use(kBindShadow, *shadow);
    }
    use(kBindDepths, images->depths);
    use(kBindNormals, images->normals);
    use(kBindColors, images->colors);
    use(kBindInstances, images->instances);
}

VkSampler Renderer::Parts::samplerOf(const RenderOptions& options, Wrap wrap) {
    Owned<VkSampler>& sampler = samplers[{options.filter, options.anisotropy, wrap}];
    if (sampler.get() == VK_NULL_HANDLE) {
        SamplerDesc sampling;
        sampling.filter = options.filter == Filter::nearest ? VK_FILTER_NEAREST : VK_FILTER_LINEAR;
        sampling.readsMips = options.filter == Filter::mipmap || options.filter == Filter::anisotropic;
        if (options.filter == Filter::anisotropic)
            sampling.anisotropy = std::min(options.anisotropy, device.traits().maxAnisotropy);
        if (wrap == Wrap::clamp) sampling.wrapU = sampling.wrapV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
        sampler = makeSampler(device, sampling);
    }
    return sampler.get();
}

void Renderer::Parts::useSamplers(const Frame& frame, Drawn& drawn) {
    const auto use = [&](std::uint32_t slot, const auto& map) {
        if (map) drawn.bindings[slot].sampler = samplerOf(frame.options, map->wrap);
    };
    use(kBindAlbedo, drawn.pictures().albedo);
    use(kBindSlopes, drawn.pictures().slopes);
    use(kBindNormalMap, drawn.pictures().normalMap);
}

/// An instance with its tables, and the view in the model's own space.
Renderer::Parts::Drawn Renderer::Parts::describe(const Frame& frame, const Instance& instance, std::size_t number) {
    Drawn drawn{.surface = instance.surface, .mesh = instance.mesh};

    // Everything that the frame has, with the tables of this model in place of none.
    drawn.inputs = frame.inputs;
    drawn.bindings = frame.bindings;
    if (drawn.surface != nullptr)
        relief::describe(*drawn.surface, drawn.inputs, drawn.bindings);
    else
        relief::describe(*drawn.mesh, drawn.inputs, drawn.bindings);
    useSamplers(frame, drawn);
    drawn.bindings[kBindInputs].uniform = inputBuffers[number].handle.get();
    drawn.inputs.material = frame.materials[number];

    // Vertices stay in the model's own space, where floats are precise; the matrices lead from there.
    const glm::dmat4 toWorld(instance.toWorld), fromWorld = glm::inverse(toWorld);
    drawn.toWorld = toWorld;
    const double scale = scaleOf(instance.toWorld);
    RELIEF_CHECK(scale > 0);
    pass::View& view = drawn.inputs.view;
    const auto fromModel = [&](mat4& matrix) { matrix = mat4(glm::dmat4(matrix) * toWorld); };
    fromModel(view.toClip), fromModel(view.toClipBefore), fromModel(drawn.inputs.light.toShadow);
    view.fromClip = mat4(fromWorld * glm::inverse(glm::dmat4(frame.inputs.view.toClip)));
    view.normalToWorld = mat3(glm::dmat3(toWorld) / scale);
    view.eye = vec3(dvec3(fromWorld * glm::dvec4(frame.options.camera.eye, 1)));
    view.instance = std::uint32_t(number);
    drawn.view = viewOf(frame.options.camera, desc.height);
    drawn.view.eye = view.eye;
    drawn.view.nearDistance = float(drawn.view.nearDistance / scale);
    drawn.rateView = drawn.view;
    if (frame.options.rateCamera) {
        drawn.rateView = viewOf(*frame.options.rateCamera, desc.height);
        drawn.rateView.eye = vec3(dvec3(fromWorld * glm::dvec4(frame.options.rateCamera->eye, 1)));
        drawn.rateView.nearDistance = float(drawn.rateView.nearDistance / scale);
    }
    return drawn;
}

Renderer::Parts::Frame Renderer::Parts::prepare(std::span<const Instance> instances, const RenderOptions& options,
                                                DrawPass pass) {
    Frame frame{.options = options, .technique = techniqueOf(options.show), .path = options.path};
    frame.shading = shadingOf(instances, options);
    if (instances.empty() || instances.size() > kMostInstances)
        fail(Failure::usage, "a picture of {} instances is not in 1..{}", instances.size(), kMostInstances);

    // What all instances share; their numbers on samples where there are several.
    for (const Instance& instance : instances) frame.materials.push_back(toPass(instance.material, frame.shading));
    while (inputBuffers.size() < instances.size() + 1) inputBuffers.push_back(makeInputBuffer(device));
    frame.drawn.resize(instances.size());
    describeView(frame);
    if (frame.hasInstances()) {
        frame.materialTable = uploadArray<pass::Material>(device, "materials", frame.materials);
        frame.inputs.targets.materials = frame.materialTable.address;
    }
    frame.bindings[kBindInputs].uniform = inputBuffers[instances.size()].handle.get();

    // The triangles of each. Pipelines of pictures are made while the device measures rates and dices.
    for (std::size_t i = 0; i < instances.size(); ++i) frame.drawn[i] = describe(frame, instances[i], i);
    if (pass == DrawPass::surface) startGuessedPipelines(frame);
    for (Drawn& drawn : frame.drawn) {
        if (drawn.surface != nullptr) {
            makeTriangles(frame, drawn, frame.stats);
        } else {
            frame.stats.triangleCount += drawn.mesh->triangleCount;
            frame.stats.vertexCount += drawn.mesh->vertexCount;
            ++frame.stats.drawCount;
        }
    }

    // What makes samples of them.
    chooseRasters(frame, frame.stats.triangleCount);
    useImages(frame);
    if (frame.rastersInCompute()) useBuffers(frame);
    if (frame.hasOcclusion()) useOcclusion(frame);
    if (pass == DrawPass::surface) startPipelines(frame);
    return frame;
}

/// Descriptor sets for all passes of a picture. Every pipeline has the same layout (passLayout), so that a set made for
/// one serves all.
void Renderer::Parts::makeSets(Frame& frame, DrawPass pass) {
    const PipelineLayoutDesc layout = passLayout(device);
    for (Drawn& drawn : frame.drawn)
        drawn.set =
            makeBindingSet(device,
                           (frame.raster == Raster::compute
                                ? rasterPipeline("raster_triangles.comp", frame, drawn, pass)
                                : drawPipeline(frame, drawn, pass == DrawPass::surface ? frame.technique.pass : pass))
                               .get(),
                           layout, drawn.bindings);
    if (pass == DrawPass::surface)
        frame.set = makeBindingSet(device, lightPipeline(frame).get(), layout, frame.bindings);
}

void Renderer::Parts::writeInputs(VkCommandBuffer commands, const Frame& frame) {
    for (std::size_t i = 0; i < frame.drawn.size(); ++i)
        relief::writeInputs(commands, inputBuffers[i], frame.drawn[i].inputs);
    relief::writeInputs(commands, inputBuffers[frame.drawn.size()], frame.inputs);
}

// --- record ---------------------------------------------------------------------------------------------------------

Rendering Renderer::Parts::begin(VkCommandBuffer commands, const Frame& frame, Rendering::Targets all) const {
    return {commands, frame.options.meshTrianglesInFlight.value_or(device.traits().meshTrianglesInFlight),
            std::move(all)};
}

void Renderer::Parts::shadowPass(VkCommandBuffer commands, const Frame& frame) {
    if (frame.shadowRaster == Raster::compute) {
        rasterize(commands, frame, shadowTarget());
        return;
    }
    Rendering rendering = begin(commands, frame, {{}, attachment(*shadow), uvec2(desc.shadowSide)});
    draw(rendering, frame, DrawPass::shadow);
    rendering.end();
}

void Renderer::Parts::surfacePass(VkCommandBuffer commands, const Frame& frame) {
    if (frame.raster == Raster::compute) {
        const RasterTarget both[] = {{DrawPass::surface, buffers->samples.buffer, size()}, shadowTarget()};
        const bool hasPieces = frame.isDicedInPieces();
        const std::span<const RasterTarget> targets = std::span(both).first(hasPieces && frame.castsShadows() ? 2 : 1);
        if (hasPieces) makePieceTimer(commands, frame, targets.size());
        rasterize(commands, frame, targets, hasPieces ? &*pieceTimer : nullptr);
        if (frame.writesIds) resolve(commands, frame);
        return;
    }
    Rendering::Targets all{
        {attachment(images->normals), attachment(images->colors)}, attachment(images->depths), size()};
    if (frame.hasInstances()) all.colors.push_back(attachment(images->instances));
    Rendering rendering = begin(commands, frame, std::move(all));
    draw(rendering, frame, frame.technique.pass);
    if (frame.technique.hasLines) draw(rendering, frame, DrawPass::lines);
    rendering.end();
}

void Renderer::Parts::lightPass(VkCommandBuffer commands, const Frame& frame, bool addsLight) {
    bind(commands, lightPipeline(frame, addsLight).get(), frame.set);
    vkCmdDispatch(commands, std::uint32_t(desc.width + 7) / 8, std::uint32_t(desc.height + 7) / 8, 1);
    barrier(commands);
}

void Renderer::Parts::record(VkCommandBuffer commands, Frame& frame) {
    timer.reset(commands);
    writeInputs(commands, frame);
    timer.stamp(commands);
    if (frame.castsShadows() && !frame.isDicedInPieces()) shadowPass(commands, frame);
    timer.stamp(commands);
    if (frame.countsPipeline()) counter.begin(commands);
    surfacePass(commands, frame);
    if (frame.countsPipeline()) counter.end(commands);
    timer.stamp(commands);
    if (frame.hasOcclusion()) {
        occlusionPass(commands, frame);
        timer.stamp(commands);
    }
    lightPass(commands, frame);
    timer.stamp(commands);
    if (frame.otherLights().empty()) return;
    otherLightPasses(commands, frame);
    timer.stamp(commands);
}

// --- read -----------------------------------------------------------------------------------------------------------

Picture Renderer::Parts::read(Frame& frame) {
    const std::vector<double> times = timer.intervals();
    const std::size_t light = frame.hasOcclusion() ? 3 : 2, others = light + 1;
    if (times.size() > light) {
        frame.stats.shadowMs = times[0], frame.stats.colorMs = times[1], frame.stats.lightMs = times[light];
        if (frame.hasOcclusion()) frame.stats.occlusionMs = times[2];
        if (!frame.otherLights().empty()) frame.stats.otherLightsMs = times[others];
        if (frame.isDicedInPieces()) readPieceTimes(frame);
    }
    if (frame.countsPipeline()) frame.stats.pipeline = counter.counts();
    const auto* halves = static_cast<const std::uint16_t*>(this->picture.mapped);
    Picture picture;
    picture.width = desc.width;
    picture.height = desc.height;
    picture.isDisplayReferred = !frame.technique.isLit;
    picture.halves.assign(halves, halves + std::size_t(picture.width) * std::size_t(picture.height) * 4);
    if (!frame.options.layers.empty()) renderLayers(frame, picture);
    picture.stats = frame.stats;
    return picture;
}

Picture Renderer::render(std::span<const Instance> instances, const RenderOptions& options) {
    Parts& parts = *parts_;
    const double start = secondsNow();
    if (options.shading == Shading::matcap && options.matcap == nullptr && !instances.empty())
        parts.makeOwnMatcap(instances.front().material, options);
    Parts::Frame frame = parts.prepare(instances, options, DrawPass::surface);
    parts.makeSets(frame, DrawPass::surface);
    parts.submit(frame);
    Picture picture = parts.read(frame);
    picture.stats.wallMs = 1e3 * (secondsNow() - start);
    return picture;
}

std::vector<int> Renderer::countCrossings(const Instance& instance, const RenderOptions& options, const vec3& shift) {
    // The instance alone.
    Parts& parts = *parts_;
    Parts::Frame frame = parts.prepare(std::span(&instance, 1), options, DrawPass::cracks);
    frame.drawn.front().inputs.view.crackShift = shift;
    return frame.raster == Raster::compute ? parts.crossingsInCompute(frame) : parts.crossingsOfDraws(frame);
}

std::uint64_t Renderer::crackPixels(const Instance& instance, const RenderOptions& options, const vec3& shift) {
    const std::vector<int> sums = countCrossings(instance, options, shift);
    return std::uint64_t(std::ranges::count_if(sums, [](int sum) { return sum != 0; }));
}

} // namespace relief
