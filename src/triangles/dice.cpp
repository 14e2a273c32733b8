#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/clock.h"
#include "shared/dice.h"
#include "shared/rates.h"
#include "triangles/dice_work.h"
#include "triangles/stages.h"

namespace relief {
namespace {

constexpr std::uint64_t kVertexBytes = 32; ///< position and height, normal

void checkMemory(const Device& device, std::uint64_t bytes, const DiceWork& work,
                 std::optional<std::uint64_t> allowed) {
    if (work.triangleCount > 0xffffffffu)
        fail(Failure::device, "dicing makes {} triangles, more than 32 bits can number: lower the rate",
             work.triangleCount);
    const std::uint64_t limit = allowed.value_or(device.traits().heapBytes / 2);
    const std::string whole =
        work.pieces.size() > 1 ? fmt::format(" at a time, of {} triangles in all", work.triangleCount) : "";
    if (bytes > limit)
        fail(Failure::device,
             "dicing makes {} vertices and {} triangles{}, {}; {} are allowed: lower the rate or raise --memory",
             work.mostVertices(), work.mostTriangles(), whole, humanBytes(bytes), humanBytes(limit));
    const std::uint64_t mostVertices = largestTable(device, 16) / kVertexBytes;
    if (work.mostVertices() > mostVertices)
        fail(Failure::device, "dicing makes {} vertices; this device reads {} at most: lower the rate",
             work.mostVertices(), mostVertices);
}

} // namespace

/// The workgroups of one shader, in as many dispatches as they need.
struct DicePass {
    const char* file;
    std::uint64_t groups;
    DicePush push;
    bool isCommon = false; ///< kIsCommon of shaders/dice.glsl
    const Pipeline* pipeline = nullptr;
};

/// Passes that make vertices, and those that make triangles of them.
struct DicePasses {
    std::vector<DicePass> vertices, triangles;

    [[nodiscard]] std::vector<DicePass> all() const {
        std::vector<DicePass> both = vertices;
        both.insert(both.end(), triangles.begin(), triangles.end());
        return both;
    }
};

/// Texels of the table of tiles where each kind begins; the insides of faces are at 0.
struct FirstDiceTiles {
    std::uint32_t rings, cells, pieces, otherVertices;
};

/// What dicing shaders read.
struct DiceTables {
    RateTables rates;
    TexelBuffer tiles, firsts;
    FirstDiceTiles first;
};

/// A mesh that is diced piece by piece: all that its shaders read, and the passes of each piece.
struct DicedPieces {
    DiceTables tables;
    PassInputs inputs{};
    BindingSet set;
    std::vector<Dicer::PieceSize> sizes;
    std::vector<std::vector<DicePass>> passes; ///< of each piece; on edges and in corners with the first one
};

struct Dicer::Parts {
    explicit Parts(Device& device) : device(device), resources(device), stages(device), timer(device, 2) {}

    const DiceTable& tableOf(const SurfaceModel& model) {
        return tables.of(model, [&] { return makeDiceTable(device, model); });
    }
    /// The constants that all dicing shaders of a model share, without those that depend on rates.
    [[nodiscard]] ShaderConstants constantsFor(const SurfaceModel& model, const DiceOptions& options) const;
    void startPipelines(const SurfaceModel& model, ShaderConstants constants);
    /// Makes the buffers of the mesh and writes them.
    DicedMesh dice(const SurfaceModel& model, const EdgeRates& rates, const DiceOptions& options);

    DiceTables makeTables(const SurfaceModel& model, const EdgeRates& rates, const DiceWork& work);
    DicePasses passesOf(const DiceWork& work, std::size_t piece, const DiceTable& table,
                        const FirstDiceTiles& first) const;
    /// Finds the pipelines of passes that have work to do.
    void findPipelines(std::vector<DicePass>& passes, const SurfaceModel& model, ShaderConstants constants);
    static void record(VkCommandBuffer commands, std::span<const DicePass> passes, const BindingSet& set);
    /// Returns the milliseconds that the passes take.
    double runPasses(std::span<const DicePass> passes, const BindingSet& set, const PassInputs& inputs);

    Device& device;
    PassResources resources;
    ComputeStages stages;
    Timer timer;
    PerModel<DiceTable> tables;
};

Dicer::Dicer(Device& device) : parts_(std::make_unique<Parts>(device)) {}
Dicer::~Dicer() = default;

namespace {

/// Bytes of gradients per vertex.
std::uint64_t gradientBytes(const SurfaceModel& model, const DiceOptions& options) {
    if (!options.wantsTexGradients) return 0;
    return sizeof(vec4) * (model.functionBendsNormals ? kRestGradientTexels : kGradientTexels);
}

std::uint64_t byteCountOf(const SurfaceModel& model, const DiceWork& work, const DiceOptions& options) {
    const std::uint64_t vertexBytes =
        kVertexBytes + (options.wantsTexCoords ? sizeof(vec2) : 0) + gradientBytes(model, options);
    return work.mostVertices() * vertexBytes + work.mostTriangles() * 12;
}

/// The buffers of a mesh, not written yet, and what is known of it beforehand.
DicedMesh allocateMesh(Device& device, const SurfaceModel& model, const DiceWork& work, const DiceOptions& options) {
    constexpr VkBufferUsageFlags usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;
    const std::uint64_t vertexCount = work.mostVertices(), triangleCount = work.mostTriangles();
    // Texture coordinates are an empty table where nothing reads them.
    DicedMesh mesh;
    mesh.vertices = makeTexels(device, {.name = "diced vertices", .bytes = vertexCount * kVertexBytes, .usage = usage},
                               VK_FORMAT_R32G32B32A32_SFLOAT);
    mesh.texCoords = makeTexels(device,
                                {.name = "diced texture coordinates",
                                 .bytes = options.wantsTexCoords ? vertexCount * sizeof(vec2) : 0,
                                 .usage = usage},
                                VK_FORMAT_R32G32_SFLOAT);
    mesh.texGradients = makeTexels(
        device,
        {.name = "diced texture gradients", .bytes = vertexCount * gradientBytes(model, options), .usage = usage},
        VK_FORMAT_R32G32B32A32_SFLOAT);
    mesh.indices = makeIndices(device, triangleCount * 3);

    // Known before anything is diced.
    mesh.firstTriangles = work.firstTriangles;
    mesh.faceRates = work.faceRates;
    mesh.runFirsts = work.runFirsts;
    mesh.sampleCount = work.sampleCount;
    mesh.allTriangles = work.triangleCount;
    mesh.vertexCount = std::uint32_t(vertexCount);
    mesh.triangleCount = std::uint32_t(triangleCount);
    mesh.maxRate = work.maxRate;
    mesh.byteCount = byteCountOf(model, work, options);
    mesh.hasTexCoords = options.wantsTexCoords;
    return mesh;
}

} // namespace

DicePasses Dicer::Parts::passesOf(const DiceWork& work, std::size_t number, const DiceTable& table,
                                  const FirstDiceTiles& first) const {
    const auto others = std::uint32_t(work.otherVertices.size());
    const std::uint32_t group = device.traits().smallGroup;
    const DicePiece& piece = work.pieces[number];
    const auto part = [](const DiceRange& range, std::uint32_t firstTile) {
        return DicePush{.first = firstTile + std::uint32_t(range.first)};
    };
    DicePasses passes;
    passes.vertices = {{"dice_insides.comp", piece.regularInsides.count, part(piece.regularInsides, 0), true},
                       {"dice_insides.comp", piece.otherInsides.count, part(piece.otherInsides, 0)}};
    // Vertices on edges and in corners stay for the other pieces.
    if (number == 0)
        passes.vertices.insert(
            passes.vertices.end(),
            {{"dice_edges.comp", work.edgePieces.size(), {.first = first.pieces}, true},
             {"dice_edges.comp", (others + group - 1) / group, {.count = others, .list = first.otherVertices}},
             {"dice_smooth_edges.comp", table.runs.size() - table.firstSmoothRun, {.first = table.firstSmoothRun}}});
    passes.triangles = {{"dice_triangles.comp", piece.cells.count, part(piece.cells, first.cells), true},
                        {"dice_triangles.comp", piece.rings.count, part(piece.rings, first.rings)}};
    return passes;
}

void Dicer::Parts::findPipelines(std::vector<DicePass>& passes, const SurfaceModel& model, ShaderConstants constants) {
    std::vector<const PendingPipeline*> pending;
    for (const DicePass& pass : passes) {
        constants.isCommon = pass.isCommon;
        pending.push_back(pass.groups > 0 ? &stages.start(pass.file, model, constants) : nullptr);
    }
    for (std::size_t i = 0; i < passes.size(); ++i)
        if (pending[i] != nullptr) passes[i].pipeline = &pending[i]->get();
}

ShaderConstants Dicer::Parts::constantsFor(const SurfaceModel& model, const DiceOptions& options) const {
    ShaderConstants constants = constantsOf(model, options.normal);
    constants.wantsTexCoords = options.wantsTexCoords;
    constants.hasTexGradients = options.wantsTexGradients;
    constants.hasSlopes =
        options.wantsTexGradients && (model.functionBendsNormals || model.pictures.slopes.has_value());
    constants.groupSize = device.traits().smallGroup;
    return constants;
}

/// In the order of passesOf(). Rates may leave some of them without work; most have some with all rates.
void Dicer::Parts::startPipelines(const SurfaceModel& model, ShaderConstants constants) {
    const auto regularCount = std::size_t(std::ranges::count(model.patchIsRegular, true));
    const bool hasRegular = regularCount > 0 && !model.isTriangles();
    const bool hasOthers = !hasRegular || regularCount < model.patchIsRegular.size();
    const auto start = [&](const char* file, bool isCommon) {
        constants.isCommon = isCommon;
        stages.start(file, model, constants);
    };
    if (hasRegular) start("dice_insides.comp", true);
    if (hasOthers) start("dice_insides.comp", false);
    if (hasRegular && device.traits().readsTablesAs == TableAccess::texelBuffers) start("dice_edges.comp", true);
    start("dice_edges.comp", false); // corners at least
    const DiceTable& table = tableOf(model);
    if (table.firstSmoothRun < table.runs.size()) start("dice_smooth_edges.comp", false);
    for (const bool isCommon : {true, false}) start("dice_triangles.comp", isCommon);
}

/// The tiles of all pieces, and what rates need.
DiceTables Dicer::Parts::makeTables(const SurfaceModel& model, const EdgeRates& rates, const DiceWork& work) {
    std::vector<std::uint32_t> tiles;
    appendRecords<kInsideTileTexels>(tiles, work.insides);
    const FirstDiceTiles first{.rings = appendRecords<kTriangleTileTexels>(tiles, work.rings),
                               .cells = appendRecords<kTriangleTileTexels>(tiles, work.cells),
                               .pieces = appendRecords<kEdgePieceTexels>(tiles, work.edgePieces),
                               .otherVertices = std::uint32_t(tiles.size() / 4)};
    tiles.insert(tiles.end(), work.otherVertices.begin(), work.otherVertices.end());
    tiles.resize((tiles.size() + 3) / 4 * 4, 0);
    return {.rates = uploadRates(device, model, rates),
            .tiles = uploadTexels(device, {.name = "dice tiles"}, VK_FORMAT_R32G32B32A32_UINT,
                                  std::as_bytes(std::span(tiles))),
            .firsts = uploadWords(device, "dice firsts", work.runFirsts),
            .first = first};
}

DicedMesh Dicer::Parts::dice(const SurfaceModel& model, const EdgeRates& rates, const DiceOptions& options) {
    // What there is to do, and whether the memory allowed holds it.
    const DiceTable& table = tableOf(model);
    const DiceWork work = planDicing(model, table, rates, device.traits().readsTablesAs == TableAccess::texelBuffers,
                                     options.pieceTriangles.value_or(~std::uint64_t(0)));
    checkMemory(device, byteCountOf(model, work, options), work, options.memory);
    DicedMesh mesh = allocateMesh(device, model, work, options);
    RELIEF_CHECK((work.pieces.size() == 1 || !options.wantsFaces));
    if (options.wantsFaces) mesh.faces = facePushes(table, model, rates, work.runFirsts, work.firstInsides);

    // What the shaders read.
    auto pieces = std::make_shared<DicedPieces>();
    pieces->tables = makeTables(model, rates, work);
    PassInputs& inputs = pieces->inputs;
    PassBindings bindings = resources.bindings();
    describe(model, inputs, bindings);
    describeRates(model, rates, pieces->tables.rates, inputs, bindings);
    bindings[kBindDiceTable] = table.texels.binding();
    bindings[kBindDiceTiles] = pieces->tables.tiles.binding();
    bindings[kBindDiceFirsts] = pieces->tables.firsts.binding();
    inputs.model.firstFaceRuns = table.firstFaceRuns;
    inputs.model.cornerRunCount = table.cornerRunCount;
    inputs.model.runCount = std::uint32_t(table.runs.size());

    // What they write.
    inputs.targets.dicedVertices = mesh.vertices.buffer.address;
    inputs.targets.dicedTexCoords = mesh.texCoords.buffer.address;
    inputs.targets.dicedTexGradients = mesh.texGradients.buffer.address;
    inputs.targets.dicedIndices = mesh.indices.buffer.address;

    // Their dispatches, piece after piece.
    ShaderConstants constants = constantsFor(model, options);
    constants.hasMips = rates.hasMips();
    constants.readsNodes = readsNodes(model, rates);
    std::vector<DicePasses> passes;
    for (std::size_t i = 0; i < work.pieces.size(); ++i) {
        passes.push_back(passesOf(work, i, table, pieces->tables.first));
        findPipelines(passes[i].vertices, model, constants);
        findPipelines(passes[i].triangles, model, constants);
        pieces->passes.push_back(passes[i].all());
        pieces->sizes.push_back({std::uint32_t(work.runVertexCount + work.pieces[i].insideVertexCount),
                                 std::uint32_t(work.pieces[i].triangleCount)});
    }
    pieces->set = makeBindingSet(device, *passes.front().triangles.back().pipeline, passLayout(device), bindings);
    if (work.pieces.size() > 1) {
        mesh.pieces = std::move(pieces);
        return mesh;
    }

    // Vertices and triangles do not wait for each other, unless their times are asked for apart.
    if (options.timesVertices) {
        mesh.vertexMilliseconds = runPasses(passes.front().vertices, pieces->set, inputs);
        mesh.milliseconds = mesh.vertexMilliseconds + runPasses(passes.front().triangles, pieces->set, inputs);
    } else {
        mesh.milliseconds = runPasses(pieces->passes.front(), pieces->set, inputs);
    }
    return mesh;
}

void Dicer::Parts::record(VkCommandBuffer commands, std::span<const DicePass> passes, const BindingSet& set) {
    for (const DicePass& pass : passes) {
        if (pass.groups == 0) continue;
        bind(commands, *pass.pipeline, set);
        for (std::uint64_t first = 0; first < pass.groups; first += kGroupsAtOnce) {
            DicePush part = pass.push;
            part.first += std::uint32_t(first);
            pushConstants(commands, *pass.pipeline, part);
            vkCmdDispatch(commands, std::uint32_t(std::min<std::uint64_t>(kGroupsAtOnce, pass.groups - first)), 1, 1);
        }
    }
    barrier(commands);
}

double Dicer::Parts::runPasses(std::span<const DicePass> passes, const BindingSet& set, const PassInputs& inputs) {
    const double start = secondsNow();
    device.submitAndWait([&](VkCommandBuffer commands) {
        timer.reset(commands);
        resources.write(commands, inputs);
        timer.stamp(commands);
        record(commands, passes, set);
        timer.stamp(commands);
    });
    // Mesa's CPU driver stamps both times when it rasterizes, after all dispatches: the clock of the host serves
    // instead.
    const std::vector<double> times = timer.intervals();
    if (device.traits().isCpu) return 1e3 * (secondsNow() - start);
    return times.empty() ? 0 : times[0];
}

std::vector<Dicer::PieceSize> Dicer::piecesOf(const DicedMesh& mesh) { return mesh.pieces->sizes; }

void Dicer::recordPiece(VkCommandBuffer commands, const DicedMesh& mesh, std::size_t number) const {
    const DicedPieces& pieces = *mesh.pieces;
    parts_->resources.write(commands, pieces.inputs);
    Parts::record(commands, pieces.passes[number], pieces.set);
}

void Dicer::startPipelines(const SurfaceModel& model, const DiceOptions& options, bool hasMips) {
    ShaderConstants constants = parts_->constantsFor(model, options);
    constants.hasMips = hasMips;
    parts_->startPipelines(model, constants);
}

DicedMesh Dicer::dice(const SurfaceModel& model, const EdgeRates& rates, const DiceOptions& options) {
    return parts_->dice(model, rates, options);
}

DenseMesh readBack(Device& device, const DicedMesh& diced) {
    DenseMesh mesh;
    std::vector<vec4> texels(2 * std::size_t(diced.vertexCount));
    downloadBytes(device, diced.vertices.buffer, std::as_writable_bytes(std::span(texels)));
    mesh.positions.reserve(diced.vertexCount);
    mesh.normals.reserve(diced.vertexCount);
    for (std::size_t i = 0; i < texels.size(); i += 2) {
        mesh.positions.emplace_back(texels[i]);
        mesh.normals.emplace_back(texels[i + 1]);
    }
    mesh.indices.resize(3 * std::size_t(diced.triangleCount));
    downloadBytes(device, diced.indices.buffer, std::as_writable_bytes(std::span(mesh.indices)));
    if (!diced.hasTexCoords) return mesh;
    mesh.texCoords.resize(diced.vertexCount);
    downloadBytes(device, diced.texCoords.buffer, std::as_writable_bytes(std::span(mesh.texCoords)));
    return mesh;
}

DenseMesh Dicer::diceToHost(const SurfaceModel& model, const EdgeRates& rates, const DiceOptions& options) {
    return readBack(parts_->device, dice(model, rates, options));
}

} // namespace relief
