// Internal: what a renderer is made of.
#pragma once

#include "frame/passes.h"

namespace relief {

inline VkRenderingAttachmentInfo attachment(const Texture& target) {
    VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
    info.imageView = target.view.get();
    info.imageLayout = VK_IMAGE_LAYOUT_GENERAL;
    info.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
    info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
    return info; // cleared to zero: nothing, farthest depth
}

inline void setViewport(VkCommandBuffer commands, std::uint32_t width, std::uint32_t height) {
    const VkViewport viewport{0, 0, float(width), float(height), 0, 1};
    const VkRect2D scissor{{0, 0}, {width, height}};
    vkCmdSetViewport(commands, 0, 1, &viewport);
    vkCmdSetScissor(commands, 0, 1, &scissor);
}

/// Cleared targets of one size, drawn over as a whole.
class Rendering {
public:
    struct Targets {
        std::vector<VkRenderingAttachmentInfo> colors;
        std::optional<VkRenderingAttachmentInfo> depth;
        uvec2 size;
    };
    Rendering(VkCommandBuffer commands, std::uint32_t trianglesInFlight, Targets targets);
    Rendering(const Rendering&) = delete;
    Rendering& operator=(const Rendering&) = delete;

    [[nodiscard]] VkCommandBuffer commands() const { return commands_; }
    /// Triangles of the bound indices; where they are more than the device should keep it finishes some in between.
    void drawMesh(std::uint32_t first, std::uint32_t count);
    void end();

private:
    void begin() const;
    void goOn(); ///< when all that was drawn is done

    VkCommandBuffer commands_;
    Targets targets_;
    std::uint32_t most_, room_; ///< triangles until the next wait
};

struct Renderer::Parts {
    Parts(Device& device, const RendererDesc& desc)
        : device(device), desc(desc), targets(makeTargets(device, desc)), scene(makeSceneBuffer(device)),
          repeating(makeSampler(device, {})),
          clamped(makeSampler(device, {.wrapU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                       .wrapV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
          around(makeSampler(device, {.wrapV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
          nearest(makeSampler(device, {.filter = VK_FILTER_NEAREST,
                                       .wrapU = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                       .wrapV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE})),
          noWords(uploadWords(device, "nothing", {})), timer(device, 8), counter(device), rater(device), dicer(device) {
    }

    Device& device;
    RendererDesc desc;
    Targets targets;
    Buffer scene;
    Owned<VkSampler> repeating, clamped, around, nearest;
    TexelBuffer noWords;
    Timer timer;
    PipelineCounter counter;
    EdgeRater rater;
    Dicer dicer;
    std::map<std::vector<std::uint32_t>, Pipeline> pipelines; ///< by everything that tells two of them apart
    std::map<std::uint32_t, Buffer> grids;                    ///< index buffers of quads by their columns,
    std::map<std::uint32_t, Buffer> triangleGrids;            ///< of triangles by their rate
    std::optional<GpuEnvironment> studio;                     ///< made when first needed
    std::optional<LayerTargets> layerTargets;

    [[nodiscard]] uvec2 size() const { return {desc.width, desc.height}; }

    /// Everything that one call of render() needs.
    struct Frame {
        const Model& model;
        const RenderOptions& options;
        Scene scene{};
        Binding bindings[kBindCount] = {};
        EdgeRates rates;
        RateTexels rateTexels;
        TexelBuffer drawFaces;
        Buffer draws;
        DrawPlan plan;
        DicedMesh diced;
        BindingSet set;
    };

    enum class Pass { shadow, color, lines, light, cracks, layers, layerValues };

    ShaderConstants constantsOf(const Frame& frame, Pass pass) const;
    const Pipeline& pipelineOf(const Frame& frame, Pass pass);
    std::vector<Stage> stagesOf(const Frame& frame, Pass pass) const;
    void useEnvironment(Frame& frame);
    void describeView(Frame& frame);
    BindingSet bindingSet(const Frame& frame, Pass pass);
    void makeTriangles(Frame& frame, FrameStats& stats);
    void makePlan(Frame& frame, FrameStats& stats);
    void makeDiced(Frame& frame, FrameStats& stats);
    void makeGrids(const Model& model, const DrawPlan& plan);
    const Buffer& gridOf(const Model& model, const DrawBatch& batch) const;
    void drawPatches(VkCommandBuffer commands, const Frame& frame, Pass pass);
    void drawGrids(VkCommandBuffer commands, const Frame& frame, const Pipeline& pipeline, Pass pass);
    static std::span<const DrawBatch> batchesOf(const Frame& frame, Pass pass);
    static void drawDiced(Rendering& rendering, const Frame& frame, const Pipeline& pipeline, PushConstants constants);
    void draw(Rendering& rendering, const Frame& frame, Pass pass);
    void shadowPass(VkCommandBuffer commands, const Frame& frame);
    void colorPass(VkCommandBuffer commands, const Frame& frame);
    void lightPass(VkCommandBuffer commands, const Frame& frame);
    void renderLayers(const Model& model, const RenderOptions& options, Picture& picture);
    void layerPass(VkCommandBuffer commands, const Frame& frame);
    void layerValuesPass(VkCommandBuffer commands, const Frame& frame);
    [[nodiscard]] std::uint32_t trianglesInFlight(const Frame& frame) const {
        return frame.options.meshTrianglesInFlight.value_or(device.traits().meshTrianglesInFlight);
    }
    [[nodiscard]] bool castsShadows(const Frame& frame) const {
        return frame.options.lighting.castsShadows && frame.options.show == Show::shaded;
    }
};

} // namespace relief
