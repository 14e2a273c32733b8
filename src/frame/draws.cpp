// The triangles of a frame: rates, plans or a diced mesh, and the calls that draw them.
#include <algorithm>

#include "frame/renderer_parts.h"

namespace relief {

void Renderer::Parts::makeTriangles(const Frame& frame, Drawn& drawn, FrameStats& stats) {
    const SurfaceModel& model = *drawn.surface;
    double milliseconds = 0;
    drawn.rates = rater.rates(model, frame.options, drawn.rateView, &milliseconds);
    stats.rateMs += milliseconds;
    drawn.rateTables = uploadRates(device, model, drawn.rates);
    describeRates(model, drawn.rates, drawn.rateTables, drawn.inputs, drawn.bindings);
    if (frame.path == Path::dice)
        makeDiced(frame, drawn, stats);
    else
        makePlan(frame, drawn, stats);
}

void Renderer::Parts::makePlan(const Frame& frame, Drawn& drawn, FrameStats& stats) {
    const RenderOptions& o = frame.options;
    const SurfaceModel& model = *drawn.surface;
    const std::vector<char> isVisible = visibleFaces(model, drawn.inputs.view.toClip, drawn.view, drawn.rates);
    const DrawPlan& plan = drawn.plan =
        frame.path == Path::grid
            ? planGrids(model, drawn.rates, isVisible)
            : planPatches(model, drawn.rates,
                          o.tessellatedVerticesPerDraw.value_or(device.traits().tessellatedVerticesPerDraw), isVisible);

    // What the frame reports, summed over its instances.
    stats.triangleCount += plan.triangleCount;
    stats.vertexCount += plan.vertexCount;
    stats.faceCount += plan.faces.size();
    stats.hiddenFaceCount += plan.faces.size() - plan.visibleFaceCount;
    stats.drawCount += std::uint32_t(plan.batches.size());
    stats.maxRate = std::max(stats.maxRate, plan.maxRate);

    // What the draws read: grids share index buffers, patches have one indirect draw per batch.
    drawn.drawFaces = uploadWords(device, "faces to draw", plan.faces);
    drawn.bindings[kBindDrawFaces] = drawn.drawFaces.binding();
    if (frame.path == Path::grid) {
        makeGrids(model, plan);
        return;
    }
    std::vector<VkDrawIndirectCommand> calls;
    for (const DrawBatch& batch : plan.batches) calls.push_back({batch.faceCount, 1, batch.firstFace, 0});
    drawn.draws = uploadArray<VkDrawIndirectCommand>(device, "draws", calls, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT);
}

DiceOptions Renderer::Parts::diceOptionsOf(const Frame& frame, const Drawn& drawn) const {
    const bool hasLayers = !frame.options.layers.empty();
    const DrawPass mostWanted = hasLayers ? DrawPass::layers : frame.technique.pass;
    // Vertices hold what the pass that wants most reads: of layers that is more than of colors.
    const ShaderConstants constants = constantsOf(frame, drawn, mostWanted);
    return {.normal = frame.options.normal,
            .wantsTexCoords = constants.wantsTexCoords && constants.hasTexCoords,
            .wantsTexGradients = constants.hasTexGradients,
            .wantsFaces = rowOf(mostWanted).namesPoints,
            .memory = frame.options.memory,
            .pieceTriangles = pieceTrianglesOf(frame)};
}

void Renderer::Parts::makeDiced(const Frame& frame, Drawn& drawn, FrameStats& stats) {
    drawn.diced = dicer.dice(*drawn.surface, drawn.rates, diceOptionsOf(frame, drawn));
    const DicedMesh& mesh = drawn.diced;
    drawn.bindings[kBindMesh] = mesh.vertices.binding();
    drawn.bindings[kBindMeshIndices] = mesh.indices.binding();
    drawn.bindings[kBindMeshTexCoords] = mesh.texCoords.binding();
    drawn.bindings[kBindMeshTexGradients] = mesh.texGradients.binding();
    // Which face a triangle belongs to, for layers and the pictures that show faces or their rates.
    if (frame.technique.wantsFaces || !mesh.faces.empty()) {
        std::vector<std::uint32_t> words;
        for (std::size_t face = 0; face < mesh.faceRates.size(); ++face)
            words.insert(words.end(), {mesh.firstTriangles[face], mesh.faceRates[face]});
        drawn.faceTriangles = uploadWords(device, "triangles of faces", words);
        drawn.bindings[kBindFaceTriangles] = drawn.faceTriangles.binding();
    }
    stats.triangleCount += mesh.allTriangles;
    stats.vertexCount += mesh.sampleCount;
    stats.faceCount += drawn.surface->faces.size();
    ++stats.drawCount;
    stats.maxRate = std::max(stats.maxRate, mesh.maxRate);
    stats.diceMs += mesh.milliseconds;
}

/// One index buffer per number of columns, tall enough for every batch of quads that has as many.
void Renderer::Parts::makeGrids(const SurfaceModel& model, const DrawPlan& plan) {
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

const Buffer& Renderer::Parts::gridOf(const SurfaceModel& model, const DrawBatch& batch) const {
    return (model.isTriangles() ? triangleGrids : grids).at(batch.columns);
}

namespace {

std::span<const DrawBatch> batchesOf(const DrawPlan& plan, DrawPass pass) {
    const std::span<const DrawBatch> all = plan.batches;
    return rowOf(pass).drawsHidden ? all : all.first(plan.visibleBatchCount);
}

} // namespace

void Renderer::Parts::draw(Rendering& rendering, const Frame& frame, DrawPass pass) {
    const VkCommandBuffer commands = rendering.commands();
    for (const Drawn& drawn : frame.drawn) {
        const Pipeline& pipeline = drawPipeline(frame, drawn, pass).get();
        bind(commands, pipeline, drawn.set);
        if (drawn.mesh != nullptr) {
            pushConstants(commands, pipeline, MeshPush{});
            vkCmdBindIndexBuffer(commands, drawn.mesh->indices.buffer.handle.get(), 0, VK_INDEX_TYPE_UINT32);
            rendering.drawMesh(0, drawn.mesh->triangleCount);
        } else if (frame.path == Path::dice) {
            if (rowOf(pass).namesPoints)
                drawDicedFaces(rendering, drawn, pipeline);
            else
                drawDiced(rendering, frame, drawn, pipeline);
        } else if (frame.path == Path::tessellation) {
            drawPatches(commands, drawn, pass);
        } else {
            drawGrids(rendering, drawn, pipeline, pass);
        }
    }
}

void Renderer::Parts::drawPatches(VkCommandBuffer commands, const Drawn& drawn, DrawPass pass) {
    const std::uint32_t atOnce = device.traits().maxDrawIndirectCount;
    const auto count = std::uint32_t(batchesOf(drawn.plan, pass).size());
    for (std::uint32_t first = 0; first < count; first += atOnce)
        vkCmdDrawIndirect(commands, drawn.draws.handle.get(), first * sizeof(VkDrawIndirectCommand),
                          std::min(atOnce, count - first), sizeof(VkDrawIndirectCommand));
}

void Renderer::Parts::drawGrids(Rendering& rendering, const Drawn& drawn, const Pipeline& pipeline, DrawPass pass) {
    const VkCommandBuffer commands = rendering.commands();
    for (const DrawBatch& batch : batchesOf(drawn.plan, pass)) {
        pushConstants(commands, pipeline, GridPush{batch.columns, batch.rows, 0});
        vkCmdBindIndexBuffer(commands, gridOf(*drawn.surface, batch).handle.get(), 0, VK_INDEX_TYPE_UINT32);
        rendering.drawGrids(batch.columns * batch.rows * (drawn.isTriangles() ? 1 : 2), batch.firstFace,
                            batch.faceCount);
    }
}

namespace {

/// A draw per face that has triangles, after `prepare(face)`.
template <typename Prepare>
void drawFaces(Rendering& rendering, const DicedMesh& mesh, const Prepare& prepare) {
    for (std::uint32_t face = 0; face + 1 < mesh.firstTriangles.size(); ++face) {
        const std::uint32_t first = mesh.firstTriangles[face], count = mesh.firstTriangles[face + 1] - first;
        if (count == 0) continue;
        prepare(face);
        rendering.drawMesh(first, count);
    }
}

} // namespace

/// The whole mesh at once, or face by face where the technique shows what belongs to faces.
void Renderer::Parts::drawDiced(Rendering& rendering, const Frame& frame, const Drawn& drawn,
                                const Pipeline& pipeline) {
    const VkCommandBuffer commands = rendering.commands();
    const DicedMesh& mesh = drawn.diced;
    vkCmdBindIndexBuffer(commands, mesh.indices.buffer.handle.get(), 0, VK_INDEX_TYPE_UINT32);
    if (!frame.technique.wantsFaces) {
        pushConstants(commands, pipeline, MeshPush{});
        rendering.drawMesh(0, mesh.triangleCount);
        return;
    }
    drawFaces(rendering, mesh, [&](std::uint32_t face) {
        pushConstants(commands, pipeline, MeshPush{.isOneFace = 1, .face = face, .rate = mesh.faceRates[face]});
    });
}

/// Face by face, each with what the numbers of its vertices mean.
void Renderer::Parts::drawDicedFaces(Rendering& rendering, const Drawn& drawn, const Pipeline& pipeline) {
    const VkCommandBuffer commands = rendering.commands();
    const DicedMesh& mesh = drawn.diced;
    RELIEF_CHECK(mesh.faces.size() + 1 == mesh.firstTriangles.size());
    vkCmdBindIndexBuffer(commands, mesh.indices.buffer.handle.get(), 0, VK_INDEX_TYPE_UINT32);
    drawFaces(rendering, mesh, [&](std::uint32_t face) { pushConstants(commands, pipeline, mesh.faces[face]); });
}

} // namespace relief
