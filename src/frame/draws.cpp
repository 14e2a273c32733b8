// The triangles of a frame: rates, plans or a diced mesh, and the calls that draw them.
#include <algorithm>

#include "frame/renderer_parts.h"

namespace relief {

void Renderer::Parts::makeTriangles(Frame& frame, FrameStats& stats) {
    frame.rates = rater.rates(frame.model, frame.options, viewOf(frame.options.camera, desc.height), &stats.rateMs);
    frame.rateTexels = uploadRates(device, frame.model, frame.rates);
    useRates(frame.model, frame.rates, frame.rateTexels, frame.scene, frame.bindings);
    if (frame.options.path == Path::dice)
        makeDiced(frame, stats);
    else
        makePlan(frame, stats);
}

void Renderer::Parts::makePlan(Frame& frame, FrameStats& stats) {
    const RenderOptions& o = frame.options;
    const std::vector<char> isVisible =
        visibleFaces(frame.model, frame.scene.worldToClip, viewOf(o.camera, desc.height), frame.rates);
    const DrawPlan& plan = frame.plan =
        o.path == Path::grid
            ? planGrids(frame.model, frame.rates, isVisible)
            : planPatches(frame.model, frame.rates,
                          o.tessellatedVerticesPerDraw.value_or(device.traits().tessellatedVerticesPerDraw), isVisible);
    stats.triangleCount = plan.triangleCount;
    stats.vertexCount = plan.vertexCount;
    stats.faceCount = plan.faces.size();
    stats.hiddenFaceCount = plan.faces.size() - plan.visibleFaceCount;
    stats.drawCount = std::uint32_t(plan.batches.size());
    stats.maxRate = plan.maxRate;
    frame.drawFaces = uploadWords(device, "faces to draw", plan.faces);
    frame.bindings[kBindDrawFaces].texels = frame.drawFaces.view.get();
    if (o.path == Path::grid) {
        makeGrids(frame.model, plan);
        return;
    }
    std::vector<VkDrawIndirectCommand> calls;
    for (const DrawBatch& batch : plan.batches) calls.push_back({batch.faceCount, 1, batch.firstFace, 0});
    frame.draws = uploadArray<VkDrawIndirectCommand>(device, "draws", calls, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
}

void Renderer::Parts::makeDiced(Frame& frame, FrameStats& stats) {
    frame.diced = dicer.dice(frame.model, frame.rates,
                             {.normal = frame.options.normal,
                              .wantsTexCoords = constantsOf(frame, Pass::color).wantsTexCoords,
                              .memory = frame.options.memory});
    const DicedMesh& mesh = frame.diced;
    frame.bindings[kBindMesh].texels = mesh.vertices.view.get();
    frame.bindings[kBindMeshTexCoords].texels = mesh.texCoords.view.get();
    stats.triangleCount = mesh.triangleCount;
    stats.vertexCount = mesh.sampleCount;
    stats.faceCount = frame.model.faces().size();
    stats.drawCount = 1;
    stats.maxRate = mesh.maxRate;
    stats.diceMs = mesh.milliseconds;
}

/// Index buffers for all batches: of quads one with the most rows for each number of columns.
void Renderer::Parts::makeGrids(const Model& model, const DrawPlan& plan) {
    std::map<std::uint32_t, std::uint32_t> mostRows;
    for (const DrawBatch& batch : plan.batches) mostRows[batch.columns] = std::max(mostRows[batch.columns], batch.rows);
    for (const auto& [columns, rows] : mostRows) {
        Buffer& grid = model.isTriangles() ? triangleGrids[columns] : grids[columns];
        const std::vector<std::uint32_t> indices =
            model.isTriangles() ? triangleGridIndices(columns) : gridIndices(columns, rows);
        if (grid.bytes < indices.size() * 4)
            grid = uploadArray<std::uint32_t>(device, "grid", indices, VK_BUFFER_USAGE_INDEX_BUFFER_BIT);
    }
}

const Buffer& Renderer::Parts::gridOf(const Model& model, const DrawBatch& batch) const {
    return (model.isTriangles() ? triangleGrids : grids).at(batch.columns);
}

/// What casts a shadow may be out of sight, and cracks are counted through all that there is.
std::span<const DrawBatch> Renderer::Parts::batchesOf(const Frame& frame, Pass pass) {
    const std::span<const DrawBatch> all = frame.plan.batches;
    return pass == Pass::shadow || pass == Pass::cracks ? all : all.first(frame.plan.visibleBatchCount);
}

Rendering::Rendering(VkCommandBuffer commands, std::uint32_t trianglesInFlight, Targets targets)
    : commands_(commands), targets_(std::move(targets)), most_(trianglesInFlight), room_(most_) {
    begin();
    setViewport(commands, targets_.size.x, targets_.size.y);
}

void Rendering::begin() const {
    VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
    info.renderArea = {{0, 0}, {targets_.size.x, targets_.size.y}};
    info.layerCount = 1;
    info.colorAttachmentCount = std::uint32_t(targets_.colors.size());
    info.pColorAttachments = targets_.colors.data();
    info.pDepthAttachment = targets_.depth ? &*targets_.depth : nullptr;
    vkCmdBeginRendering(commands_, &info);
}

void Rendering::end() {
    vkCmdEndRendering(commands_);
    barrier(commands_);
}

void Rendering::goOn() {
    end();
    for (VkRenderingAttachmentInfo& color : targets_.colors) color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    if (targets_.depth) targets_.depth->loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
    begin();
    room_ = most_;
}

void Rendering::drawMesh(std::uint32_t first, std::uint32_t count) {
    while (count > 0) {
        if (room_ == 0) goOn();
        const std::uint32_t part = std::min(count, room_);
        vkCmdDrawIndexed(commands_, 3 * part, 1, 3 * first, 0, 0);
        first += part, count -= part, room_ -= part;
    }
}

void Renderer::Parts::draw(Rendering& rendering, const Frame& frame, Pass pass) {
    const VkCommandBuffer commands = rendering.commands();
    const Pipeline& pipeline = pipelineOf(frame, pass);
    bind(commands, pipeline, frame.set);
    PushConstants constants{.drawsShadow = pass == Pass::shadow ? 1u : 0u};
    pushConstants(commands, pipeline, constants);
    if (frame.model.isDense()) {
        vkCmdBindIndexBuffer(commands, frame.model.indices().handle.get(), 0, VK_INDEX_TYPE_UINT32);
        rendering.drawMesh(0, frame.model.indexCount() / 3);
    } else if (frame.options.path == Path::dice) {
        drawDiced(rendering, frame, pipeline, constants);
    } else if (frame.options.path == Path::tessellation) {
        drawPatches(commands, frame, pass);
    } else {
        drawGrids(commands, frame, pipeline, pass);
    }
}

void Renderer::Parts::drawPatches(VkCommandBuffer commands, const Frame& frame, Pass pass) {
    const std::uint32_t atOnce = device.traits().maxDrawIndirectCount;
    const auto count = std::uint32_t(batchesOf(frame, pass).size());
    for (std::uint32_t first = 0; first < count; first += atOnce)
        vkCmdDrawIndirect(commands, frame.draws.handle.get(), first * sizeof(VkDrawIndirectCommand),
                          std::min(atOnce, count - first), sizeof(VkDrawIndirectCommand));
}

void Renderer::Parts::drawGrids(VkCommandBuffer commands, const Frame& frame, const Pipeline& pipeline, Pass pass) {
    PushConstants constants{.drawsShadow = pass == Pass::shadow ? 1u : 0u};
    for (const DrawBatch& batch : batchesOf(frame, pass)) {
        constants.passNumber = batch.columns;
        constants.passRows = batch.rows;
        pushConstants(commands, pipeline, constants);
        vkCmdBindIndexBuffer(commands, gridOf(frame.model, batch).handle.get(), 0, VK_INDEX_TYPE_UINT32);
        const std::uint32_t indexCount = batch.columns * batch.rows * (frame.model.isTriangles() ? 3 : 6);
        vkCmdDrawIndexed(commands, indexCount, batch.faceCount, 0, 0, batch.firstFace);
    }
}

/// The whole mesh at once, or face by face where the picture shows what belongs to faces.
void Renderer::Parts::drawDiced(Rendering& rendering, const Frame& frame, const Pipeline& pipeline,
                                PushConstants constants) {
    const VkCommandBuffer commands = rendering.commands();
    const DicedMesh& mesh = frame.diced;
    vkCmdBindIndexBuffer(commands, mesh.indices.handle.get(), 0, VK_INDEX_TYPE_UINT32);
    if (frame.options.show != Show::faces && frame.options.show != Show::rate) {
        rendering.drawMesh(0, mesh.triangleCount);
        return;
    }
    for (std::uint32_t face = 0; face + 1 < mesh.firstTriangles.size(); ++face) {
        const std::uint32_t first = mesh.firstTriangles[face], count = mesh.firstTriangles[face + 1] - first;
        if (count == 0) continue;
        constants.passFirst = face;
        constants.passRows = 1;
        constants.passNumber = mesh.faceRates[face];
        pushConstants(commands, pipeline, constants);
        rendering.drawMesh(first, count);
    }
}

} // namespace relief
