#include <algorithm>

#include "triangles/dice_table.h"
#include "triangles/stages.h"

namespace relief {
namespace {

constexpr std::uint32_t kCapturedBytes = 16; ///< position, 1 on a boundary

} // namespace

struct Capturer::Parts {
    explicit Parts(Device& device) : device(device), resources(device), dicer(device) {}
    Device& device;
    PassResources resources;
    Dicer dicer;
    std::map<std::vector<std::uint32_t>, Pipeline> pipelines; ///< by everything in which two of them may differ
};

namespace {

struct Capture {
    Capturer::Parts& parts;
    const SurfaceModel& model;
    const TriangleOptions& options;
    const EdgeRates& rates;
    Device& device = parts.device;

    Buffer makeTarget(std::uint64_t vertexCount, VkBufferUsageFlags usage) {
        const std::uint64_t bytes = vertexCount * kCapturedBytes;
        if (bytes > device.traits().heapBytes / 2)
            fail(Failure::device, "{} captured vertices take {}; this device has {}: lower the rate", vertexCount,
                 humanBytes(bytes), humanBytes(device.traits().heapBytes));
        return makeBuffer(device,
                          {.name = "captured vertices",
                           .bytes = bytes,
                           .usage = usage | VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT});
    }

    /// A pipeline without pictures: vertices are captured, triangles are not drawn.
    const Pipeline& pipelineOf(const std::vector<Stage>& stages, VkPrimitiveTopology topology) {
        ShaderConstants constants = constantsOf(model, NormalKind::limit);
        constants.hasMips = rates.hasMips();
        constants.readsNodes = readsNodes(model, rates);
        std::vector<std::uint32_t> key = constants.values();
        key.insert(key.end(), {std::uint32_t(topology), model.isTriangles()});
        const auto found = parts.pipelines.find(key);
        if (found != parts.pipelines.end()) return found->second;
        return parts.pipelines[key] = makeGraphics(device, {.name = "capture",
                                                            .stages = stages,
                                                            .constants = constants.values(),
                                                            .layout = passLayout(device),
                                                            .topology = topology,
                                                            .rasterizerDiscard = true,
                                                            .colorFormats = {},
                                                            .depthFormat = VK_FORMAT_UNDEFINED});
    }

    /// Runs `draw` with everything bound.
    template <typename Draw>
    void run(const Pipeline& pipeline, const DrawPlan& plan, const Buffer& target, const Draw& draw) {
        // What the shaders read.
        const RateTables rateTables = uploadRates(device, model, rates);
        const TexelBuffer drawFaces = uploadWords(device, "faces to draw", plan.faces);
        PassInputs inputs{};
        PassBindings bindings = parts.resources.bindings();
        describe(model, inputs, bindings);
        inputs.targets.captured = target.address;
        describeRates(model, rates, rateTables, inputs, bindings);
        bindings[kBindDrawFaces] = drawFaces.binding();
        const BindingSet set = makeBindingSet(device, pipeline, passLayout(device), bindings);
        // Draws need a rendering scope, although none of them rasterizes.
        device.submitAndWait([&](VkCommandBuffer commands) {
            constexpr std::uint32_t notANumber = 0xffffffffu; // what is never written must not look like a point
            vkCmdFillBuffer(commands, target.handle.get(), 0, VK_WHOLE_SIZE, notANumber);
            parts.resources.write(commands, inputs);
            VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
            info.renderArea = {{0, 0}, {1, 1}};
            info.layerCount = 1;
            vkCmdBeginRendering(commands, &info);
            const VkViewport viewport{0, 0, 1, 1, 0, 1};
            const VkRect2D scissor{{0, 0}, {1, 1}};
            vkCmdSetViewport(commands, 0, 1, &viewport);
            vkCmdSetScissor(commands, 0, 1, &scissor);
            bind(commands, pipeline, set);
            draw(commands);
            vkCmdEndRendering(commands);
            barrier(commands);
        });
    }

    CapturedMesh readBack(const Buffer& target, std::uint64_t vertexCount) {
        std::vector<vec4> vertices(vertexCount);
        downloadBytes(device, target, std::as_writable_bytes(std::span(vertices)));
        CapturedMesh mesh;
        for (const vec4& v : vertices) {
            mesh.positions.emplace_back(v);
            mesh.isOnBoundary.push_back(v.w > 0);
        }
        return mesh;
    }

    CapturedMesh patches();
    CapturedMesh grids();
    CapturedMesh diced();
};

CapturedMesh Capture::patches() {
    if (!device.traits().hasTransformFeedback)
        fail(Failure::usage, "{} has no transform feedback: its tessellated triangles cannot be read back",
             device.traits().name);
    const DrawPlan plan = planPatches(
        model, rates, options.tessellatedVerticesPerDraw.value_or(device.traits().tessellatedVerticesPerDraw));
    const Pipeline& pipeline =
        pipelineOf({shaderStage(device, VK_SHADER_STAGE_VERTEX_BIT, "patch.vert", model),
                    shaderStage(device, VK_SHADER_STAGE_TESSELLATION_CONTROL_BIT, "patch.tesc", model),
                    shaderStage(device, VK_SHADER_STAGE_TESSELLATION_EVALUATION_BIT, "patch_capture.tese", model)},
                   VK_PRIMITIVE_TOPOLOGY_PATCH_LIST);

    // Transform feedback writes three vertices per triangle, in the order of the draws.
    const std::uint64_t vertexCount = plan.triangleCount * 3;
    const Buffer target = makeTarget(vertexCount, VK_BUFFER_USAGE_TRANSFORM_FEEDBACK_BUFFER_BIT_EXT);
    const auto bindTarget = PFN_vkCmdBindTransformFeedbackBuffersEXT(
        vkGetDeviceProcAddr(device.handle(), "vkCmdBindTransformFeedbackBuffersEXT"));
    const auto begin =
        PFN_vkCmdBeginTransformFeedbackEXT(vkGetDeviceProcAddr(device.handle(), "vkCmdBeginTransformFeedbackEXT"));
    const auto end =
        PFN_vkCmdEndTransformFeedbackEXT(vkGetDeviceProcAddr(device.handle(), "vkCmdEndTransformFeedbackEXT"));
    run(pipeline, plan, target, [&](VkCommandBuffer commands) {
        const VkBuffer buffer = target.handle.get();
        const VkDeviceSize offset = 0, size = target.bytes;
        bindTarget(commands, 0, 1, &buffer, &offset, &size);
        begin(commands, 0, 0, nullptr, nullptr);
        for (const DrawBatch& batch : plan.batches) vkCmdDraw(commands, batch.faceCount, 1, batch.firstFace, 0);
        end(commands, 0, 0, nullptr, nullptr);
    });
    // Vertices are written once per triangle: their numbers are the indices.
    CapturedMesh mesh = readBack(target, vertexCount);
    for (std::uint32_t i = 0; i < vertexCount; ++i) mesh.indices.push_back(i);
    return mesh;
}

CapturedMesh Capture::grids() {
    if (!device.traits().hasVertexStores)
        fail(Failure::usage, "{} does not let vertex shaders write: its grids cannot be read back",
             device.traits().name);
    const DrawPlan plan = planGrids(model, rates);
    const Pipeline& pipeline = pipelineOf({shaderStage(device, VK_SHADER_STAGE_VERTEX_BIT, "grid_capture.vert", model)},
                                          VK_PRIMITIVE_TOPOLOGY_POINT_LIST);

    // Points of all grids, batch after batch, written by the vertex shader itself.
    std::uint64_t vertexCount = 0;
    for (const DrawBatch& b : plan.batches) vertexCount += std::uint64_t(b.columns + 1) * (b.rows + 1) * b.faceCount;
    const Buffer target = makeTarget(vertexCount, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
    run(pipeline, plan, target, [&](VkCommandBuffer commands) {
        std::uint32_t first = 0;
        for (const DrawBatch& b : plan.batches) {
            const std::uint32_t size = (b.columns + 1) * (b.rows + 1);
            // Instances count from firstFace: where instance 0 would be, in arithmetic that wraps.
            const std::uint32_t base = first - b.firstFace * size;
            pushConstants(commands, pipeline, GridPush{b.columns, b.rows, base});
            vkCmdDraw(commands, size, b.faceCount, 0, b.firstFace);
            first += size * b.faceCount;
        }
    });

    // Triangles by the indices that the draws of this path use.
    CapturedMesh mesh = readBack(target, vertexCount);
    std::uint32_t first = 0;
    for (const DrawBatch& b : plan.batches) {
        const std::vector<std::uint32_t> grid =
            model.isTriangles() ? triangleGridIndices(b.columns) : gridIndices(b.columns, b.rows);
        for (std::uint32_t face = 0; face < b.faceCount; ++face) {
            for (const std::uint32_t index : grid) mesh.indices.push_back(first + index);
            first += (b.columns + 1) * (b.rows + 1);
        }
    }
    return mesh;
}

CapturedMesh Capture::diced() {
    const DicedMesh diced = parts.dicer.dice(model, rates, {.normal = NormalKind::limit, .memory = options.memory});
    DenseMesh host = relief::readBack(device, diced);
    return {std::move(host.positions), boundaryVertices(makeDiceTable(device, model), model, diced),
            std::move(host.indices)};
}

} // namespace

Capturer::Capturer(Device& device) : parts_(std::make_unique<Parts>(device)) {}
Capturer::~Capturer() = default;

CapturedMesh Capturer::capture(const SurfaceModel& model, const TriangleOptions& options, const EdgeRates& rates) {
    Capture capture{*parts_, model, options, rates};
    if (options.path == Path::dice) return capture.diced();
    return options.path == Path::grid ? capture.grids() : capture.patches();
}

} // namespace relief
