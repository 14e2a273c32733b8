#include <algorithm>
#include <chrono>
#include <cmath>

#include <glm/trigonometric.hpp>

#include "frame/renderer_parts.h"

namespace relief {
namespace {

double secondsNow() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::uint32_t showConstant(Show show) {
    constexpr std::uint32_t kConstants[] = {kShowShaded, kShowNormal, kShowHeight,
                                            kShowRate,   kShowFaces,  kShowWireframe};
    return kConstants[int(show)];
}

} // namespace

Renderer::Renderer(Device& device, const RendererDesc& desc) {
    if (desc.width < 1 || desc.height < 1 || desc.width > 16384 || desc.height > 16384)
        fail(Failure::usage, "a picture of {} x {} is not in 1..16384 each way", desc.width, desc.height);
    parts_ = std::make_unique<Parts>(device, desc);
}

Renderer::~Renderer() = default;

ShaderConstants Renderer::Parts::constantsOf(const Frame& frame, Pass pass) const {
    ShaderConstants c = relief::constantsOf(frame.model, frame.options.normal);
    c.hasMips = frame.rates.hasMips();
    // Where positions are all that counts no normal is cheaper than the limit normal.
    if (pass == Pass::shadow || pass == Pass::cracks) c.normal = NormalKind::limit;
    if (pass == Pass::cracks) c.show = kShowCracks;
    if (pass == Pass::color) {
        c.show = showConstant(frame.options.show);
        c.hasAlbedoMap = frame.model.hasAlbedoMap() && frame.model.hasTexCoords() && frame.options.show == Show::shaded;
        c.wantsTexCoords = c.hasAlbedoMap;
    }
    if (pass == Pass::lines) c.show = kShowLines;
    if (pass == Pass::layers || pass == Pass::layerValues) {
        c.show = kShowLayers;
        c.wantsTexCoords = pass == Pass::layers;
        c.hasMotion = pass == Pass::layerValues && frame.model.hasMotion();
    }
    if (pass == Pass::light) return {.show = showConstant(frame.options.show)};
    return c;
}

std::vector<Stage> Renderer::Parts::stagesOf(const Frame& frame, Pass pass) const {
    const bool isTriangles = frame.model.isTriangles();
    std::vector<Stage> stages;
    if (frame.model.isDense() || frame.options.path == Path::dice) {
        stages = {{VK_SHADER_STAGE_VERTEX_BIT, shaderCode("mesh.vert")}};
    } else if (frame.options.path == Path::grid) {
        stages = {{VK_SHADER_STAGE_VERTEX_BIT, shaderCode("grid.vert", isTriangles)}};
    } else {
        stages = {{VK_SHADER_STAGE_VERTEX_BIT, shaderCode("patch.vert", isTriangles)},
                  {VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, shaderCode("patch.tesc", isTriangles)},
                  {VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, shaderCode("patch.tese", isTriangles)}};
    }
    const char* fragment = pass == Pass::cracks ? "crack.frag" : pass == Pass::layers ? "layers.frag" : "surface.frag";
    if (pass != Pass::shadow) stages.push_back({VK_SHADER_STAGE_FRAGMENT_BIT, shaderCode(fragment)});
    return stages;
}

const Pipeline& Renderer::Parts::pipelineOf(const Frame& frame, Pass pass) {
    const std::vector<std::uint32_t> constants = constantsOf(frame, pass).values();
    std::vector<std::uint32_t> key = constants;
    key.insert(key.end(), {std::uint32_t(pass), std::uint32_t(frame.options.path), frame.model.isDense(),
                           frame.model.isTriangles()});
    const auto found = pipelines.find(key);
    if (found != pipelines.end()) return found->second;

    if (pass == Pass::light || pass == Pass::layerValues) {
        const Stage stage{VK_SHADER_STAGE_COMPUTE_BIT, pass == Pass::light
                                                           ? shaderCode("light.comp")
                                                           : shaderCode("layers.comp", frame.model.isTriangles())};
        return pipelines[key] = makeCompute(
                   device, {.name = "light", .stage = stage, .constants = constants, .layout = passLayout()});
    }
    const bool isPatches = !frame.model.isDense() && frame.options.path == Path::tessellation;
    GraphicsDesc graphics;
    graphics.name = pass == Pass::shadow ? "shadow" : pass == Pass::lines ? "lines" : "color";
    graphics.stages = stagesOf(frame, pass);
    graphics.constants = constants;
    graphics.layout = passLayout();
    graphics.topology = isPatches ? VK_PRIMITIVE_TOPOLOGY_PATCH_LIST : VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    graphics.depthFormat = pass == Pass::shadow ? kShadowFormat : kDepthFormat;
    if (pass != Pass::shadow) {
        graphics.colorFormats = {kNormalFormat, kColorFormat};
        graphics.samples = VK_SAMPLE_COUNT_4_BIT;
    }
    if (pass == Pass::cracks) {
        graphics.additiveBlend = true;
        graphics.colorFormats = {kCrackFormat};
        graphics.depthFormat = VK_FORMAT_UNDEFINED;
        graphics.samples = VK_SAMPLE_COUNT_1_BIT;
    }
    if (pass == Pass::layers) {
        graphics.colorFormats = {kLayerFormat, kLayerFormat};
        graphics.samples = VK_SAMPLE_COUNT_1_BIT;
    }
    if (pass == Pass::lines) {
        graphics.polygonMode = VK_POLYGON_MODE_LINE;
        graphics.depthBias = true;
    }
    return pipelines[key] = makeGraphics(device, graphics);
}

void Renderer::Parts::useEnvironment(Frame& frame) {
    const GpuEnvironment* environment = frame.options.lighting.environment;
    if (environment == nullptr) {
        if (!studio) studio = uploadEnvironment(device, studioEnvironment());
        environment = &*studio;
    }
    std::ranges::copy(environment->irradiance, frame.scene.irradiance);
    frame.scene.environmentLevel = std::round(frame.scene.roughness * float(environment->levels.desc.mipCount - 1));
    frame.bindings[kBindEnvironment] = {.view = environment->levels.view.get(), .sampler = around.get()};
}

void Renderer::Parts::describeView(Frame& frame) {
    const RenderOptions& o = frame.options;
    Scene& s = frame.scene;
    frame.model.describe(s, frame.bindings);
    s.worldToClip = perspectiveMatrix(o.camera, double(desc.width) / desc.height);
    s.worldToClipBefore =
        o.cameraBefore ? perspectiveMatrix(*o.cameraBefore, double(desc.width) / desc.height) : s.worldToClip;
    s.clipToWorld = mat4(glm::inverse(glm::dmat4(s.worldToClip)));
    s.pictureTarget = targets.picture.address;
    s.pictureSize = {desc.width, desc.height};
    s.eye = vec3(o.camera.eye);
    s.exposure = 1;
    const dvec3 key = directionAt(o.lighting.keyAzimuth, o.lighting.keyElevation);
    s.keyDirection = vec3(key);
    s.keyRadiance = vec3(float(o.lighting.keyStrength)) * vec3(1.0f, 0.97f, 0.92f);
    s.albedo = o.material.albedo;
    s.roughness = std::clamp(o.material.roughness, 0.05f, 1.0f);
    useEnvironment(frame);
    s.hasShadows = castsShadows(frame) ? 1 : 0;
    s.worldToShadow = shadowMatrix(key, o.bounds);
    s.shadowBias = float(1.5 * o.bounds.diagonal() / desc.shadowSide);
    s.shadowSoftness = 3.0f / float(desc.shadowSide);

    const VkSampler wrap = frame.model.wrap() == Wrap::repeat ? repeating.get() : clamped.get();
    frame.bindings[kBindScene].uniform = scene.handle.get();
    frame.bindings[kBindAlbedo].sampler = wrap;
    frame.bindings[kBindShadow].view = targets.shadow.view.get();
    frame.bindings[kBindDepths].view = targets.depths.view.get();
    frame.bindings[kBindNormals].view = targets.normals.view.get();
    frame.bindings[kBindColors].view = targets.colors.view.get();
    for (const std::uint32_t image : {kBindShadow, kBindDepths, kBindNormals, kBindColors})
        frame.bindings[image].sampler = nearest.get();
    for (const std::uint32_t texels : {kBindDrawFaces, kBindDiceTable, kBindDiceTiles, kBindDiceFirsts})
        frame.bindings[texels] = noWords.binding();
    for (const std::uint32_t floats : {kBindEdgeRates, kBindLevels, kBindEdgeHeights})
        frame.bindings[floats] = frame.bindings[kBindPoints];
}

BindingSet Renderer::Parts::bindingSet(const Frame& frame, Pass pass) {
    return makeBindingSet(device, pipelineOf(frame, pass), passLayout(), frame.bindings);
}

void Renderer::Parts::shadowPass(VkCommandBuffer commands, const Frame& frame) {
    Rendering rendering(commands, trianglesInFlight(frame), {{}, attachment(targets.shadow), uvec2(desc.shadowSide)});
    draw(rendering, frame, Pass::shadow);
    rendering.end();
}

void Renderer::Parts::colorPass(VkCommandBuffer commands, const Frame& frame) {
    Rendering rendering(
        commands, trianglesInFlight(frame),
        {{attachment(targets.normals), attachment(targets.colors)}, attachment(targets.depths), size()});
    draw(rendering, frame, Pass::color);
    if (frame.options.show == Show::wireframe) draw(rendering, frame, Pass::lines);
    rendering.end();
}

void Renderer::Parts::lightPass(VkCommandBuffer commands, const Frame& frame) {
    const Pipeline& pipeline = pipelineOf(frame, Pass::light);
    bind(commands, pipeline, frame.set);
    pushConstants(commands, pipeline, {});
    vkCmdDispatch(commands, std::uint32_t(desc.width + 7) / 8, std::uint32_t(desc.height + 7) / 8, 1);
    barrier(commands);
}

Picture Renderer::render(const Model& model, const RenderOptions& options) {
    Parts& parts = *parts_;
    if (options.show == Show::wireframe && !parts.device.traits().hasWireframe)
        fail(Failure::usage, "{} cannot draw lines of triangles; --show wireframe needs it",
             parts.device.traits().name);
    const double start = secondsNow();
    Picture picture;
    picture.isDisplayReferred = options.show != Show::shaded;
    FrameStats& stats = picture.stats;

    Parts::Frame frame{.model = model, .options = options};
    parts.describeView(frame);
    if (model.isDense()) {
        stats.triangleCount = model.indexCount() / 3;
        stats.vertexCount = model.vertexCount();
        stats.drawCount = 1;
    } else {
        parts.makeTriangles(frame, stats);
    }
    const bool castsShadows = parts.castsShadows(frame);
    frame.set = parts.bindingSet(frame, Parts::Pass::color);
    parts.device.submitAndWait([&](VkCommandBuffer commands) {
        parts.timer.reset(commands);
        writeScene(commands, parts.scene, frame.scene);
        parts.timer.stamp(commands);
        if (castsShadows) parts.shadowPass(commands, frame);
        parts.timer.stamp(commands);
        if (options.countsPipeline) parts.counter.begin(commands);
        parts.colorPass(commands, frame);
        if (options.countsPipeline) parts.counter.end(commands);
        parts.timer.stamp(commands);
        parts.lightPass(commands, frame);
        parts.timer.stamp(commands);
    });
    const std::vector<double> times = parts.timer.intervals();
    if (times.size() == 3) stats.shadowMs = times[0], stats.colorMs = times[1], stats.lightMs = times[2];
    if (options.countsPipeline) stats.pipeline = parts.counter.counts();
    const auto* halves = static_cast<const std::uint16_t*>(parts.targets.picture.mapped);
    picture.width = parts.desc.width;
    picture.height = parts.desc.height;
    picture.halves.assign(halves, halves + std::size_t(picture.width) * std::size_t(picture.height) * 4);
    if (!options.layers.empty()) parts.renderLayers(model, options, picture);
    stats.wallMs = 1e3 * (secondsNow() - start);
    return picture;
}

std::uint64_t Renderer::crackPixels(const Model& model, const RenderOptions& options, const vec3& shift) {
    Parts& parts = *parts_;
    Parts::Frame frame{.model = model, .options = options};
    parts.describeView(frame);
    frame.scene.crackShift = shift;
    FrameStats stats;
    if (!model.isDense()) parts.makeTriangles(frame, stats);
    frame.set = parts.bindingSet(frame, Parts::Pass::cracks);
    const auto width = std::uint32_t(parts.desc.width), height = std::uint32_t(parts.desc.height);
    const Texture sums =
        makeTexture(parts.device, {.name = "cracks",
                                   .width = width,
                                   .height = height,
                                   .format = kCrackFormat,
                                   .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    const Buffer read = makeBuffer(parts.device, {.name = "cracks",
                                                  .bytes = std::uint64_t(width) * height * 2,
                                                  .usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                                                  .memory = MemoryUse::readback});
    parts.device.submitAndWait([&](VkCommandBuffer commands) {
        writeScene(commands, parts.scene, frame.scene);
        Rendering rendering(commands, parts.trianglesInFlight(frame), {{attachment(sums)}, {}, parts.size()});
        parts.draw(rendering, frame, Parts::Pass::cracks);
        rendering.end();
        VkBufferImageCopy region{};
        region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
        region.imageExtent = {width, height, 1};
        vkCmdCopyImageToBuffer(commands, sums.handle.get(), VK_IMAGE_LAYOUT_GENERAL, read.handle.get(), 1, &region);
        barrier(commands);
    });
    const auto* halves = static_cast<const std::uint16_t*>(read.mapped);
    // A sum that is not 0; minus zero is zero.
    return std::uint64_t(std::count_if(halves, halves + std::size_t(width) * height,
                                       [](std::uint16_t half) { return (half & 0x7fffu) != 0; }));
}

} // namespace relief
