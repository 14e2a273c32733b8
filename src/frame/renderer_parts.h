// Internal: what a renderer is made of, and what it makes of the instances of one picture.
#pragma once

#include <tuple>

#include "frame/passes.h"
#include "frame/rendering.h"

namespace relief {

/// What draws balls for matcaps: an eye far away sees a ball of radius 1, which fills the picture.
struct BallStudio {
    BallStudio(Device& device, int side);

    DenseMesh mesh;
    MeshModel model;
    Renderer renderer;

    /// Linear light with alpha, as seen from the direction `back`.
    Image draw(const Material& material, Lighting lighting, const dvec3& back);
};

/// Which kinds of triangles a picture has that the compute rasterizer draws by raster_thin.comp and raster_large.comp.
struct ListedTriangles {
    bool thin = false, large = false;
};

struct Renderer::Parts {
    using SamplerKey = std::tuple<Filter, float, Wrap>;

    Parts(Device& device, const RendererDesc& desc);

    Device& device;
    RendererDesc desc;
    Buffer picture;                     ///< what light.comp writes
    std::optional<SampleImages> images; ///< these and the others are made when a picture first needs them
    std::optional<Texture> shadow;
    std::optional<SampleBuffers> buffers;
    ListedTriangles drawsListed; ///< that a picture so far had
    PassResources resources;
    std::vector<Buffer> inputBuffers; ///< one per instance, and one for the passes over pixels
    Owned<VkSampler> around, nearest, smooth;
    std::map<SamplerKey, Owned<VkSampler>> samplers; ///< of the pictures of models
    Timer timer;
    std::optional<Timer> pieceTimer; ///< of a frame in pieces: dicing, then each target, of one piece after another
    PipelineCounter counter;
    EdgeRater rater;
    Dicer dicer;
    ComputeStages computes;
    KeptPipelines draws;                           ///< that the fixed function draws with
    std::map<std::uint32_t, Buffer> grids;         ///< index buffers of quads by their columns,
    std::map<std::uint32_t, Buffer> triangleGrids; ///< of triangles by their rate
    std::optional<GpuEnvironment> studio;          ///< uploaded when first needed
    std::unique_ptr<BallStudio> ball;              ///< made when first needed
    std::optional<GpuMatcap> ownMatcap;            ///< of the picture's own material and lights
    std::optional<Texture> shadingTable;           ///< of `tablePhong`
    PhongCoefficients tablePhong;
    Buffer occlusion; ///< two floats per pixel; made when first needed
    std::optional<LayerTargets> layerTargets;
    Buffer layerValues; ///< made when layers are first asked for

    [[nodiscard]] uvec2 size() const { return {desc.width, desc.height}; }

    /// One instance with everything that draws it.
    struct Drawn {
        const SurfaceModel* surface = nullptr; ///< one of them
        const MeshModel* mesh = nullptr;
        PassInputs inputs{}; ///< in the model's own space
        PassBindings bindings{};
        View view; ///< in the model's own space
        glm::dmat4 toWorld{1};
        View rateView; ///< what rates are measured from: `view`, or that of RenderOptions::rateCamera
        EdgeRates rates;
        RateTables rateTables;
        TexelBuffer drawFaces;
        Buffer draws;
        DrawPlan plan;
        DicedMesh diced;
        TexelBuffer faceTriangles; ///< kBindFaceTriangles, where something wants faces
        TexelBuffer dicedFaces;    ///< of layers and errors by the compute rasterizer: DicedMesh::faces
        std::uint32_t firstId = 0; ///< triangles of the instances before it
        BindingSet set;

        [[nodiscard]] const ModelPictures& pictures() const {
            return surface != nullptr ? surface->pictures : mesh->pictures;
        }
        [[nodiscard]] const HeightFunction* function() const {
            return surface != nullptr ? surface->function.get() : mesh->function.get();
        }
        [[nodiscard]] bool isBentByFunction() const {
            return surface != nullptr ? surface->functionBendsNormals : mesh->function != nullptr;
        }
        /// Null where none bends normals.
        [[nodiscard]] const HeightFunction* bendingFunction() const {
            return isBentByFunction() ? function() : nullptr;
        }
        [[nodiscard]] bool isTriangles() const { return surface != nullptr && surface->isTriangles(); }
    };

    /// A picture in the making.
    struct Frame {
        const RenderOptions& options;
        const Technique& technique;
        Path path;           ///< of its surfaces
        PassInputs inputs{}; ///< of the passes over pixels, in the world
        PassBindings bindings{};
        std::vector<Drawn> drawn;
        std::vector<pass::Material> materials;
        Raster raster = Raster::hardware, shadowRaster = Raster::hardware;
        Buffer materialTable; ///< where there are several instances
        BindingSet set;
        FrameStats stats;

        std::uint32_t shading = kShadingPhysical; ///< kShading...
        bool writesIds = false; ///< of the compute rasterizer: raster_resolve.comp makes normals and colours of them

        [[nodiscard]] bool hasInstances() const { return drawn.size() > 1; }
        [[nodiscard]] bool rastersInCompute() const {
            return raster == Raster::compute || shadowRaster == Raster::compute;
        }
        [[nodiscard]] bool isDicedInPieces() const {
            return std::ranges::any_of(drawn, [](const Drawn& each) { return each.diced.pieces != nullptr; });
        }
        [[nodiscard]] bool hasOcclusion() const {
            return technique.isLit && options.lighting.occlusionRadius > 0 &&
                   (shading == kShadingPhysical || shading == kShadingConserving);
        }
        /// A matcap has the light of all lights in it.
        [[nodiscard]] std::span<const DistantLight> otherLights() const {
            if (!technique.isLit || shading == kShadingMatcap) return {};
            return options.lighting.others;
        }
        [[nodiscard]] bool castsShadows() const {
            return options.lighting.castsShadows && technique.isLit && shading != kShadingMatcap;
        }
        /// Of draws alone: Mesa's CPU driver ends the process where dispatches are counted between draws.
        [[nodiscard]] bool countsPipeline() const { return options.countsPipeline && raster == Raster::hardware; }
    };

    // What a frame is made of, in this order.
    Frame prepare(std::span<const Instance> instances, const RenderOptions& options, DrawPass pass);
    void record(VkCommandBuffer commands, Frame& frame);
    Picture read(Frame& frame);

    // prepare()
    void describeView(Frame& frame);
    void useEnvironment(Frame& frame);
    void useLight(Frame& frame, const DistantLight& light);
    void useShading(Frame& frame);
    void useOcclusion(Frame& frame);
    void makeOwnMatcap(const Material& material, const RenderOptions& options);
    VkSampler samplerOf(const RenderOptions& options, Wrap wrap);
    void useSamplers(const Frame& frame, Drawn& drawn);
    Drawn describe(const Frame& frame, const Instance& instance, std::size_t number);
    void makeTriangles(const Frame& frame, Drawn& drawn, FrameStats& stats);
    void makePlan(const Frame& frame, Drawn& drawn, FrameStats& stats);
    [[nodiscard]] DiceOptions diceOptionsOf(const Frame& frame, const Drawn& drawn) const;
    void makeDiced(const Frame& frame, Drawn& drawn, FrameStats& stats);
    void makeGrids(const SurfaceModel& model, const DrawPlan& plan);
    void makeSets(Frame& frame, DrawPass pass);
    void useImages(Frame& frame);
    void writeInputs(VkCommandBuffer commands, const Frame& frame);

    // Pipelines. Each starts to be made when it is first asked for.
    ShaderConstants constantsOf(const Frame& frame, const Drawn& drawn, DrawPass pass) const;
    const PendingPipeline& drawPipeline(const Frame& frame, const Drawn& drawn, DrawPass pass);
    void startPipelines(const Frame& frame);
    void startGuessedPipelines(Frame& frame);
    std::vector<Stage> stagesOf(const Frame& frame, const Drawn& drawn, DrawPass pass) const;
    const PendingPipeline& lightPipeline(const Frame& frame, bool addsLight = false);
    const PendingPipeline& occlusionPipeline(const Frame& frame);

    // Draws.
    [[nodiscard]] const Buffer& gridOf(const SurfaceModel& model, const DrawBatch& batch) const;
    void draw(Rendering& rendering, const Frame& frame, DrawPass pass);
    void drawPatches(VkCommandBuffer commands, const Drawn& drawn, DrawPass pass);
    void drawGrids(Rendering& rendering, const Drawn& drawn, const Pipeline& pipeline, DrawPass pass);
    static void drawDiced(Rendering& rendering, const Frame& frame, const Drawn& drawn, const Pipeline& pipeline);
    static void drawDicedFaces(Rendering& rendering, const Drawn& drawn, const Pipeline& pipeline);
    Rendering begin(VkCommandBuffer commands, const Frame& frame, Rendering::Targets all) const;

    // The compute rasterizer: raster.cpp.
    [[nodiscard]] std::string obstacleToPicture(const Frame& frame) const;
    [[nodiscard]] std::string obstacleToRaster(const Frame& frame) const;
    [[nodiscard]] std::optional<std::uint64_t> pieceTrianglesOf(const Frame& frame) const;
    void chooseRasters(Frame& frame, std::uint64_t triangleCount) const;
    [[nodiscard]] bool needsIds(const Frame& frame) const;
    void useBuffers(Frame& frame);
    void makeMeshBuffers(const Frame& frame);
    const PendingPipeline& resolvePipeline(const Frame& frame, const Drawn& drawn);
    void resolve(VkCommandBuffer commands, const Frame& frame);
    void resolveMesh(VkCommandBuffer commands, const Frame& frame, const Drawn& drawn, const Dicer::PieceSize& mesh,
                     std::uint32_t firstId);
    void dispatchPixels(VkCommandBuffer commands, const Pipeline& pipeline, const Drawn& drawn,
                        std::uint32_t triangleCount, std::uint32_t firstId) const;
    void resolveLayers(VkCommandBuffer commands, const Frame& frame);
    void useDicedFaces(Drawn& drawn);
    void useSampleTables(Frame& frame, bool writesColors);
    void submit(Frame& frame);
    void submitRastered(const std::function<void(VkCommandBuffer)>& record);
    const PendingPipeline& rasterPipeline(const char* file, const Frame& frame, const Drawn& drawn, DrawPass pass);
    /// What a pass writes.
    struct RasterTarget {
        DrawPass pass;
        const Buffer& buffer;
        uvec2 size;
    };
    [[nodiscard]] RasterTarget shadowTarget() const {
        return {DrawPass::shadow, buffers->shadow.buffer, uvec2(desc.shadowSide)};
    }
    /// Clears the targets of passes, and writes all instances to them: in one go, because a surface that is diced in
    /// pieces is diced once per call. `times` gets a stamp at first, and per piece or mesh one after dicing and after
    /// each target.
    void rasterize(VkCommandBuffer commands, const Frame& frame, std::span<const RasterTarget> targets,
                   Timer* times = nullptr);
    void makePieceTimer(VkCommandBuffer commands, const Frame& frame, std::size_t targetCount);
    void readPieceTimes(Frame& frame) const;
    void rasterize(VkCommandBuffer commands, const Frame& frame, const RasterTarget& target) {
        rasterize(commands, frame, std::span(&target, 1));
    }
    void rasterizeMesh(VkCommandBuffer commands, const Frame& frame, const Drawn& drawn, const Dicer::PieceSize& mesh,
                       std::uint32_t firstId, const RasterTarget& target);

    // Passes.
    void shadowPass(VkCommandBuffer commands, const Frame& frame);
    void surfacePass(VkCommandBuffer commands, const Frame& frame);
    void occlusionPass(VkCommandBuffer commands, const Frame& frame);
    void lightPass(VkCommandBuffer commands, const Frame& frame, bool addsLight = false);
    void otherLightPasses(VkCommandBuffer commands, Frame& frame);
    std::vector<int> crossingsOfDraws(Frame& frame);
    std::vector<int> crossingsInCompute(Frame& frame);
    void renderLayers(Frame& frame, Picture& picture);
    void useLayerImages(Frame& frame);
    void useLayerBuffers(Frame& frame);
    void layerPass(VkCommandBuffer commands, const Frame& frame);
    void layerValuesPass(VkCommandBuffer commands, const Frame& frame);
    const PendingPipeline& layerPipeline(const Frame& frame, const Drawn& drawn);
};

/// kShading... of a picture. Throws Failure::usage for what cannot be drawn together.
std::uint32_t shadingOf(std::span<const Instance> instances, const RenderOptions& options);
pass::Material toPass(const Material& material, std::uint32_t shading);
DistantLight keyOf(const Lighting& lighting);

} // namespace relief
