// The compute rasterizer: which pictures it makes, and its dispatches. Its arithmetic is in shaders/raster*.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "frame/renderer_parts.h"

namespace relief {
namespace {

/// Below this area the compute rasterizer is faster than the fixed function, in pixels (src/README.md, "Devices").
constexpr double kMostPixelsPerTriangle = 10;

constexpr std::uint32_t kRasterGroup = kThinGroup;

/// Numbers of triangles that samples can hold: packId() of shaders/raster_samples.glsl.
constexpr std::uint64_t kMostIds = std::uint64_t(1) << 30;

constexpr const char* kLargeShader = "raster_large.comp";
constexpr const char* kThinShader = "raster_thin.comp";
constexpr const char* kLineShader = "raster_lines.comp";

/// Triangles per piece of a diced surface: vertices, their places on the screen and indices take some 40 MB per piece.
constexpr std::uint64_t kPieceTriangles = std::uint64_t(1) << 20;
/// The same number where samples name triangles. It is larger, because resolveMesh() passes over all samples once per
/// piece.
constexpr std::uint64_t kResolvedPieceTriangles = 4 * kPieceTriangles;

using MeshSize = Dicer::PieceSize;

/// Of buffers: the largest piece.
template <typename Drawn>
MeshSize meshSizeOf(const Drawn& drawn) {
    if (drawn.mesh != nullptr) return {drawn.mesh->vertexCount, drawn.mesh->triangleCount};
    return {drawn.diced.vertexCount, drawn.diced.triangleCount};
}

/// About how many pixels a box covers in the picture.
double coveredPixels(const Bounds& bounds, const mat4& toClip, uvec2 size) {
    dvec2 low(1), high(-1);
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 at((corner & 1) != 0 ? bounds.upper.x : bounds.lower.x,
                       (corner & 2) != 0 ? bounds.upper.y : bounds.lower.y,
                       (corner & 4) != 0 ? bounds.upper.z : bounds.lower.z);
        const glm::dvec4 clip = glm::dmat4(toClip) * glm::dvec4(at, 1);
        if (!(clip.w > 0)) return double(size.x) * size.y;
        low = glm::min(low, dvec2(clip) / clip.w), high = glm::max(high, dvec2(clip) / clip.w);
    }
    const dvec2 sides = glm::max(glm::min(high, dvec2(1)) - glm::max(low, dvec2(-1)), dvec2(0));
    return 0.25 * sides.x * sides.y * size.x * size.y;
}

std::uint32_t groupsOf(std::uint32_t count) { return (count + kRasterGroup - 1) / kRasterGroup; }

} // namespace

// --- choice ----------------------------------------------------------------------------------------------

/// Why the compute rasterizer cannot make this picture, whatever its meshes are; empty where it can.
std::string Renderer::Parts::obstacleToPicture(const Frame& frame) const {
    if (!device.traits().hasLongAtomics) return fmt::format("{} has no 64-bit atomics", device.traits().name);
    if (std::uint64_t(desc.width) * std::uint64_t(desc.height) * kSampleBytes > largestTable(device, 16))
        return fmt::format("{} reads no table of all samples of {} x {} pixels", device.traits().name, desc.width,
                           desc.height);
    for (const Drawn& drawn : frame.drawn)
        if (drawn.surface != nullptr && frame.path != Path::dice) return "it takes meshes: --path dice";
    return "";
}

std::string Renderer::Parts::obstacleToRaster(const Frame& frame) const {
    std::string obstacle = obstacleToPicture(frame);
    if (!obstacle.empty()) return obstacle;
    const bool hasIds = needsIds(frame) || !frame.options.layers.empty();
    if (hasIds && frame.stats.triangleCount >= kMostIds)
        return fmt::format("{} triangles are more than samples can number", frame.stats.triangleCount);
    for (const Drawn& drawn : frame.drawn)
        if (drawn.bindings[kBindMeshIndices].isEmpty()) return "the mesh is too large for it";
    return "";
}

/// Pieces are forgotten once they are samples with their normals and colours. What belongs to faces, or is asked for
/// once more afterwards, needs the whole mesh.
std::optional<std::uint64_t> Renderer::Parts::pieceTrianglesOf(const Frame& frame) const {
    const bool mayRaster = frame.options.raster == Raster::compute ||
                           (frame.options.raster == Raster::automatic && device.traits().rastersFasterInCompute);
    const bool needsWhole = frame.technique.wantsFaces || rowOf(frame.technique.pass).namesPoints ||
                            frame.shading == kShadingVertexTable || !frame.options.layers.empty();
    if (!mayRaster || needsWhole || !obstacleToPicture(frame).empty()) return {};
    return frame.options.pieceTriangles.value_or(needsIds(frame) ? kResolvedPieceTriangles : kPieceTriangles);
}

/// The picture and its shadow map each by what suits the size of that many triangles in them.
void Renderer::Parts::chooseRasters(Frame& frame, std::uint64_t triangleCount) const {
    const std::string obstacle = obstacleToRaster(frame);
    const Raster asked = frame.options.raster;
    if (asked == Raster::compute && !obstacle.empty())
        fail(Failure::usage, "the compute rasterizer cannot draw this picture: {}", obstacle);
    if (frame.isDicedInPieces() && !obstacle.empty())
        fail(Failure::device, "a surface of {} triangles does not fit into memory as a whole, and not in pieces: {}",
             frame.stats.triangleCount, obstacle);
    const bool drawsLines = frame.technique.hasLines && !device.traits().hasWireframe;
    const auto choose = [&](const mat4& toClip, uvec2 size) {
        if (asked != Raster::automatic) return asked;
        if (!obstacle.empty()) return Raster::hardware;
        if (drawsLines || frame.isDicedInPieces()) return Raster::compute; // nothing else can draw it
        if (!device.traits().rastersFasterInCompute) return Raster::hardware;
        const double pixels = coveredPixels(frame.options.bounds, toClip, size);
        const bool areSmall = pixels < kMostPixelsPerTriangle * 0.5 * double(triangleCount);
        return areSmall ? Raster::compute : Raster::hardware;
    };
    frame.raster = frame.stats.raster = choose(frame.inputs.view.toClip, size());
    if (drawsLines && frame.raster == Raster::hardware)
        fail(Failure::usage, "{} cannot draw lines of triangles; --show wireframe needs it, or --raster compute",
             device.traits().name);
    if (frame.castsShadows()) frame.shadowRaster = choose(frame.inputs.light.toShadow, uvec2(desc.shadowSide));
    frame.writesIds = frame.raster == Raster::compute && needsIds(frame);
}

// --- dispatches ------------------------------------------------------------------------------------------

/// Samples hold the normal itself where all else is the same for all of them: the material alone decides their colour.
bool Renderer::Parts::needsIds(const Frame& frame) const {
    const Show show = frame.technique.show;
    if (frame.hasInstances() || (show != Show::shaded && show != Show::normal)) return true;
    if (frame.shading == kShadingVertexTable) return true;
    const ModelPictures& pictures = frame.drawn.front().pictures();
    return (pictures.albedo && frame.technique.wantsAlbedo) || pictures.slopes || pictures.normalMap ||
           frame.drawn.front().isBentByFunction();
}

/// The buffers that hold samples, made when first needed.
void Renderer::Parts::useBuffers(Frame& frame) {
    if (!buffers) buffers = makeSampleBuffers(device, desc);
    // Colors and instances of samples take memory only once a picture needs them.
    makeMeshBuffers(frame);

    // What the passes write, and light.comp reads.
    std::uint32_t firstId = 0;
    for (Drawn& drawn : frame.drawn) {
        drawn.firstId = firstId;
        firstId += drawn.mesh != nullptr ? drawn.mesh->triangleCount : std::uint32_t(drawn.diced.allTriangles);
        drawn.bindings[kBindScreen] = buffers->screen.binding();
        drawn.bindings[kBindSamples] = buffers->samples.binding();
        drawn.inputs.targets.screen = buffers->screen.buffer.address;
        drawn.inputs.targets.samples = buffers->samples.buffer.address;
        drawn.inputs.targets.shadow = buffers->shadow.buffer.address;
        drawn.inputs.targets.listedTriangles = buffers->listed.address;
    }
    frame.bindings[kBindSamples] = buffers->samples.binding();
    frame.bindings[kBindShadowCodes] = buffers->shadow.binding();
    useSampleTables(frame, frame.writesIds);
    if (frame.writesIds) frame.bindings[kBindSampleColors] = buffers->colors.binding();
    if (frame.raster == Raster::compute && frame.technique.pass == DrawPass::errors)
        for (Drawn& drawn : frame.drawn) useDicedFaces(drawn);
    if (frame.hasInstances()) frame.bindings[kBindSampleInstances] = buffers->instances.binding();
}

/// Where vertices lie in their faces, for shaders that go from triangles to points of the surface.
void Renderer::Parts::useDicedFaces(Drawn& drawn) {
    if (drawn.surface == nullptr) return;
    const std::vector<DicedFacePush>& faces = drawn.diced.faces;
    RELIEF_CHECK(faces.size() == drawn.diced.faceRates.size());
    drawn.dicedFaces =
        uploadTexels(device, {.name = "diced faces"}, VK_FORMAT_R32_UINT, std::as_bytes(std::span(faces)));
    drawn.bindings[kBindDiceTable] = drawn.dicedFaces.binding();
}

/// What samples hold besides depths and normals, made when first needed.
void Renderer::Parts::useSampleTables(Frame& frame, bool writesColors) {
    if (writesColors && buffers->colors.buffer.bytes == 0)
        buffers->colors = makeSampleTable(device, desc, "colors of samples", 32);
    if (frame.hasInstances() && buffers->instances.buffer.bytes == 0)
        buffers->instances = makeSampleTable(device, desc, "instances of samples", 16);
    for (Drawn& drawn : frame.drawn) {
        drawn.inputs.targets.sampleColors = buffers->colors.buffer.address;
        drawn.inputs.targets.sampleInstances = buffers->instances.buffer.address;
    }
}

/// Vertices on the screen and the lists of triangles that are not small: for one instance after another, so that the
/// largest decides.
void Renderer::Parts::makeMeshBuffers(const Frame& frame) {
    MeshSize largest{0, 0};
    for (const Drawn& drawn : frame.drawn) {
        const MeshSize mesh = meshSizeOf(drawn);
        largest.vertexCount = std::max(largest.vertexCount, mesh.vertexCount);
        largest.triangleCount = std::max(largest.triangleCount, mesh.triangleCount);
    }
    const std::uint64_t screenBytes = std::uint64_t(largest.vertexCount) * 16;
    const std::uint64_t listedBytes = (std::uint64_t(largest.triangleCount) + kListFirst) * 4;
    if (buffers->screen.buffer.bytes < screenBytes)
        buffers->screen =
            makeTexels(device, {.name = "vertices on the screen", .bytes = screenBytes}, VK_FORMAT_R32G32B32A32_UINT);
    if (buffers->listed.bytes < listedBytes)
        buffers->listed =
            makeBuffer(device, {.name = "listed triangles",
                                .bytes = listedBytes,
                                .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
                                         VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT});
}

const PendingPipeline& Renderer::Parts::rasterPipeline(const char* file, const Frame& frame, const Drawn& drawn,
                                                       DrawPass pass) {
    const DrawPassRow& row = rowOf(pass);
    // Few large triangles: on CPU drivers invocations beyond the lanes would only repeat the cuts.
    const bool isLarge = std::string_view(file) == kLargeShader;
    ShaderConstants constants{.groupSize = isLarge ? device.traits().smallGroup : kRasterGroup, .pass = row.constant};
    if (pass == DrawPass::layers) {
        constants.writesIds = true;
    } else if (row.hasNormals) {
        constants.writesIds = frame.writesIds;
        constants.show = frame.technique.constant;
        constants.isPlaced = drawn.inputs.view.normalToWorld != mat3(1);
    }
    return computes.start(file, constants);
}

void Renderer::Parts::rasterizeMesh(VkCommandBuffer commands, const Frame& frame, const Drawn& drawn,
                                    const Dicer::PieceSize& mesh, std::uint32_t firstId, const RasterTarget& target) {
    const Camera& camera = frame.options.camera;
    RasterPush block{.size = ivec2(target.size),
                     .depthAtInfinity = float(-camera.nearDistance / (camera.farDistance - camera.nearDistance)),
                     .firstId = firstId};
    const auto dispatch = [&](const char* file, std::uint32_t count) {
        const Pipeline& pipeline = rasterPipeline(file, frame, drawn, target.pass).get();
        bind(commands, pipeline, drawn.set);
        block.count = count;
        for (std::uint32_t first = 0; first < groupsOf(count); first += kGroupsAtOnce) {
            block.first = first * kRasterGroup;
            pushConstants(commands, pipeline, block);
            vkCmdDispatch(commands, std::min(kGroupsAtOnce, groupsOf(count) - first), 1, 1);
        }
        barrier(commands);
    };
    // Nothing is listed yet. Large triangles have a workgroup per tile of the picture.
    const uvec2 tiles = (target.size + uvec2(kLargeTile - 1)) / uvec2(kLargeTile);
    const VkBuffer lists = buffers->listed.handle.get();
    const std::uint32_t noLarge[] = {0, tiles.x * tiles.y, 1, 0}, noThin[] = {0, 1, 1, 0};
    vkCmdUpdateBuffer(commands, lists, kLargeList * 4, sizeof(noLarge), noLarge);
    vkCmdUpdateBuffer(commands, lists, kThinList * 4, sizeof(noThin), noThin);
    dispatch("raster_vertices.comp", mesh.vertexCount);
    dispatch("raster_triangles.comp", mesh.triangleCount);
    if (target.pass == DrawPass::surface && frame.technique.hasLines) dispatch(kLineShader, mesh.triangleCount);
    const auto dispatchList = [&](const char* file, std::uint32_t list) {
        const Pipeline& pipeline = rasterPipeline(file, frame, drawn, target.pass).get();
        bind(commands, pipeline, drawn.set);
        pushConstants(commands, pipeline, block);
        vkCmdDispatchIndirect(commands, lists, list * 4);
        barrier(commands);
    };
    block.count = mesh.triangleCount;
    if (drawsListed.thin) dispatchList(kThinShader, kThinList);
    if (drawsListed.large) dispatchList(kLargeShader, kLargeList);
}

void Renderer::Parts::rasterize(VkCommandBuffer commands, const Frame& frame, std::span<const RasterTarget> targets,
                                Timer* times) {
    const auto stamp = [&] {
        if (times != nullptr) times->stamp(commands);
    };
    for (const RasterTarget& target : targets)
        vkCmdFillBuffer(commands, target.buffer.handle.get(), 0, VK_WHOLE_SIZE, 0); // nothing, farthest depth
    stamp();
    for (const Drawn& drawn : frame.drawn) {
        if (!drawn.diced.pieces) {
            stamp();
            for (const RasterTarget& target : targets) {
                rasterizeMesh(commands, frame, drawn, meshSizeOf(drawn), drawn.firstId, target);
                stamp();
            }
            continue;
        }
        const std::vector<MeshSize> pieces = Dicer::piecesOf(drawn.diced);
        std::uint32_t firstId = drawn.firstId;
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            dicer.recordPiece(commands, drawn.diced, i);
            stamp();
            for (const RasterTarget& target : targets) {
                rasterizeMesh(commands, frame, drawn, pieces[i], firstId, target);
                // What later pieces hide is written over: of each sample the last one to write is the nearest one.
                if (target.pass == DrawPass::surface && frame.writesIds)
                    resolveMesh(commands, frame, drawn, pieces[i], firstId);
                stamp();
            }
            firstId += pieces[i].triangleCount;
        }
    }
}

/// Makes a timer that has room for all stamps of rasterize().
void Renderer::Parts::makePieceTimer(VkCommandBuffer commands, const Frame& frame, std::size_t targetCount) {
    std::size_t meshes = 0;
    for (const Drawn& drawn : frame.drawn) meshes += drawn.diced.pieces ? Dicer::piecesOf(drawn.diced).size() : 1;
    pieceTimer.emplace(device, std::uint32_t(1 + meshes * (1 + targetCount)));
    pieceTimer->reset(commands);
}

/// Adds up the times of all pieces. surfacePass() has timed dicing and shadows as color.
void Renderer::Parts::readPieceTimes(Frame& frame) const {
    const std::size_t perMesh = frame.castsShadows() ? 3 : 2;
    const std::vector<double> times = pieceTimer->intervals();
    double sums[3] = {};
    for (std::size_t i = 0; i < times.size(); ++i) sums[i % perMesh] += times[i];
    frame.stats.diceMs += sums[0];
    frame.stats.shadowMs += sums[2];
    frame.stats.colorMs = std::max(frame.stats.colorMs - sums[0] - sums[2], 0.0);
}

void Renderer::Parts::submit(Frame& frame) {
    const auto recordPicture = [&](VkCommandBuffer commands) { record(commands, frame); };
    if (frame.rastersInCompute())
        submitRastered(recordPicture);
    else
        device.submitAndWait(recordPicture);
}

/// Records and submits what the compute rasterizer draws. The shaders for listed triangles take long to compile and few
/// pictures need them: each is left out until a picture has some, which is then drawn again.
void Renderer::Parts::submitRastered(const std::function<void(VkCommandBuffer)>& record) {
    const Download heads(device, kListFirst * 4);
    for (;;) {
        device.submitAndWait([&](VkCommandBuffer commands) {
            for (const std::uint32_t list : {kThinList, kLargeList})
                vkCmdFillBuffer(commands, buffers->listed.handle.get(), (list + kListSeen) * 4, 4, 0);
            record(commands);
            heads.record(commands, buffers->listed);
        });
        std::uint32_t words[kListFirst];
        std::memcpy(words, heads.bytes().data(), sizeof(words));
        const ListedTriangles seen{.thin = words[kThinList + kListSeen] != 0,
                                   .large = words[kLargeList + kListSeen] != 0};
        if (drawsListed.thin >= seen.thin && drawsListed.large >= seen.large) return;
        drawsListed = {.thin = drawsListed.thin || seen.thin, .large = drawsListed.large || seen.large};
    }
}

/// A pass over all pixels for the triangles of one instance, or of a piece of it.
void Renderer::Parts::dispatchPixels(VkCommandBuffer commands, const Pipeline& pipeline, const Drawn& drawn,
                                     std::uint32_t triangleCount, std::uint32_t firstId) const {
    pushConstants(commands, pipeline,
                  RasterPush{.size = ivec2(size()),
                             .count = triangleCount,
                             .firstId = firstId,
                             .faceCount = std::uint32_t(drawn.diced.faceRates.size())});
    vkCmdDispatch(commands, std::uint32_t(desc.width + 7) / 8, std::uint32_t(desc.height + 7) / 8, 1);
    barrier(commands);
}

const PendingPipeline& Renderer::Parts::resolvePipeline(const Frame& frame, const Drawn& drawn) {
    const ShaderConstants constants = constantsOf(frame, drawn, frame.technique.pass);
    if (frame.technique.pass == DrawPass::errors)
        return computes.start("raster_errors.comp", constants,
                              {.function = drawn.function(), .isTriangles = drawn.isTriangles()});
    return computes.start("raster_resolve.comp", constants, {.function = drawn.bendingFunction()});
}

/// Normals and colours of the triangles of a mesh, or of a piece of one, that samples name.
void Renderer::Parts::resolveMesh(VkCommandBuffer commands, const Frame& frame, const Drawn& drawn,
                                  const Dicer::PieceSize& mesh, std::uint32_t firstId) {
    const Pipeline& pipeline = resolvePipeline(frame, drawn).get();
    bind(commands, pipeline, drawn.set);
    dispatchPixels(commands, pipeline, drawn, mesh.triangleCount, firstId);
}

/// Those of all meshes that are there as a whole.
void Renderer::Parts::resolve(VkCommandBuffer commands, const Frame& frame) {
    for (const Drawn& drawn : frame.drawn)
        if (!drawn.diced.pieces) resolveMesh(commands, frame, drawn, meshSizeOf(drawn), drawn.firstId);
}

/// What layers.comp reads, of the triangles that samples name.
void Renderer::Parts::resolveLayers(VkCommandBuffer commands, const Frame& frame) {
    for (const Drawn& drawn : frame.drawn) {
        const Pipeline& pipeline = computes
                                       .start("raster_layers.comp", constantsOf(frame, drawn, DrawPass::layers),
                                              {.function = drawn.bendingFunction(), .isTriangles = drawn.isTriangles()})
                                       .get();
        bind(commands, pipeline, drawn.set);
        dispatchPixels(commands, pipeline, drawn, meshSizeOf(drawn).triangleCount, drawn.firstId);
    }
}

} // namespace relief
