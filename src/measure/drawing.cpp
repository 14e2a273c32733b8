#include <algorithm>
#include <cmath>

#include "measure/suite.h"

namespace relief {

double computeDiagonal(const Cage& cage) { return computeBounds(cage.positions).diagonal(); }

std::vector<Camera> makeCameraPath(std::span<const dvec3> points) {
    std::vector<Camera> views;
    for (const double azimuth : {30.0, 120.0, 210.0, 300.0})
        views.push_back(frameCamera(points, {.azimuth = azimuth}, 1));
    return views;
}

RenderOptions makeRenderOptions(const Bounds& bounds, const Camera& camera) {
    RenderOptions options;
    options.camera = camera;
    options.bounds = bounds;
    options.lighting.castsShadows = false;
    return options;
}

SceneOnDevice::SceneOnDevice(Device& device, const TestScene& scene)
    : surface(buildSurface(scene.cage, scene.surface)), model(device, {.surface = &surface,
                                                                       .cagePositions = scene.cage.positions,
                                                                       .height = &scene.height,
                                                                       .encoding = &scene.heightEncoding}) {
    const std::vector<dvec3> points = outline(makeCoarseSurface(scene.cage, scene.surface.scheme), &scene.height);
    views = makeCameraPath(points);
    bounds = computeBounds(points);
}

int SceneOnDevice::chooseRate(double triangleCount) const {
    const double trianglesOfRate1 = (model.isTriangles() ? 1 : 2) * double(surface.faces.size());
    return std::max(1, int(std::lround(std::sqrt(triangleCount / trianglesOfRate1))));
}

RenderOptions SceneOnDevice::renderOptions(int rate) const {
    RenderOptions options = makeRenderOptions(bounds, views.front());
    options.rate = rate;
    return options;
}

EdgeRates makeUniformRates(const SurfaceModel& model, int rate) { return {.rates = uniformRates(model, float(rate))}; }

DenseMesh makeDenseMesh(Device& device, const SurfaceModel& model, int rate) {
    return Dicer(device).diceToHost(model, makeUniformRates(model, rate), {.wantsTexCoords = model.hasTexCoords});
}

MeshModel uploadDenseMesh(Device& device, const DenseMesh& mesh) { return MeshModel(device, {.mesh = &mesh}); }

namespace {

void addTimes(Row& row, const TimedDrawing& drawing) {
    RELIEF_CHECK(drawing.diceTimes.size() == drawing.colorTimes.size());
    std::vector<double> both;
    for (std::size_t i = 0; i < drawing.colorTimes.size(); ++i)
        both.push_back(drawing.diceTimes[i] + drawing.colorTimes[i]);
    row.addMeasured(Metric::frameTime, drawing.frameTimes);
    row.addMeasured(Metric::trianglePassTime, both);
    row.addMeasured(Metric::ratePassTime, drawing.rateTimes);
    if (drawing.options.path == Path::dice && drawing.instance.surface != nullptr)
        row.addMeasured(Metric::dicePassTime, drawing.diceTimes);
    row.addMeasured(Metric::colorPassTime, drawing.colorTimes);
    row.addMeasured(Metric::lightPassTime, drawing.lightTimes);
}

void addCounts(Row& row, const FrameStats& stats) {
    row.addMeasured(Metric::triangles, double(stats.triangleCount));
    row.addMeasured(Metric::distinctVertices, double(stats.vertexCount));
    const PipelineCounts& counts = stats.pipeline;
    if (counts.primitives == 0) return; // the device does not count
    row.addMeasured(Metric::vertexInvocations, double(counts.vertexCalls));
    row.addMeasured(Metric::tessellationInvocations, double(counts.tessellationCalls));
    row.addMeasured(Metric::primitives, double(counts.primitives));
    row.addMeasured(Metric::clippedPrimitives, double(counts.drawnPrimitives));
    row.addMeasured(Metric::fragmentInvocations, double(counts.fragmentCalls));
}

Traffic computeSurfaceFrame(const TimedDrawing& drawing) {
    const PipelineCounts& counts = drawing.stats.pipeline;
    const MeshCounts mesh{drawing.stats.vertexCount, drawing.stats.triangleCount};
    const bool isDiced = drawing.options.path == Path::dice;
    // Dicing evaluates each distinct vertex once; so does the estimate where the device does not count.
    const std::uint64_t invocations =
        drawing.options.path == Path::tessellation ? counts.tessellationCalls : counts.vertexCalls;
    const SurfaceModel& model = *drawing.instance.surface;
    return computeSurfaceTraffic({.residentBytes = model.byteCount,
                                  .evaluationCount = counts.primitives > 0 && !isDiced ? invocations : mesh.vertices,
                                  .evaluation = {model.hasTexCoords, model.hasWideIndices, model.mapFormat()},
                                  .diced = isDiced ? mesh : MeshCounts{}});
}

} // namespace

void TimedDrawing::addTo(Row& row) const {
    addTimes(row, *this);
    addCounts(row, stats);
    Traffic traffic;
    if (instance.mesh != nullptr) {
        const MeshCounts mesh{stats.vertexCount, stats.triangleCount};
        row.addComputed(Metric::residentBytes, double(denseBytes(mesh.vertices, mesh.triangles)));
        traffic = computeDenseTraffic(kRawLayout, mesh,
                                      stats.pipeline.primitives > 0 ? stats.pipeline.vertexCalls : 3 * mesh.triangles);
    } else {
        row.addMeasured(Metric::residentBytes, double(instance.surface->byteCount));
        traffic = computeSurfaceFrame(*this);
    }
    row.addComputed(Metric::bytesReadCached, double(traffic.cached));
    row.addComputed(Metric::bytesReadUncached, double(traffic.uncached));
}

void timeDrawings(Renderer& renderer, std::span<const Camera> views, int roundCount, std::span<TimedDrawing> drawings) {
    RELIEF_CHECK(!views.empty());
    for (int round = -1; round < roundCount; ++round)
        for (TimedDrawing& drawing : drawings) {
            const bool isWarmUp = round < 0;
            RenderOptions options = drawing.options;
            options.camera = views[std::size_t(std::max(round, 0)) % views.size()];
            options.countsPipeline = isWarmUp; // counting takes time
            const double poseMs = measureMilliseconds([&] { drawing.updatePose(round); });
            const FrameStats stats = renderer.render(drawing.instance, options).stats;
            if (isWarmUp) drawing.stats = stats;
            if (isWarmUp && roundCount > 0) continue;
            // A pass that the device did not time is 0; a frame always took time.
            RELIEF_CHECK(stats.wallMs > 0);
            drawing.frameTimes.push_back(poseMs + stats.wallMs);
            drawing.poseTimes.push_back(poseMs);
            drawing.rateTimes.push_back(stats.rateMs);
            drawing.diceTimes.push_back(stats.diceMs);
            drawing.colorTimes.push_back(stats.colorMs);
            drawing.lightTimes.push_back(stats.lightMs);
            drawing.shadowTimes.push_back(stats.shadowMs);
            drawing.occlusionTimes.push_back(stats.occlusionMs);
            drawing.otherLightsTimes.push_back(stats.otherLightsMs);
        }
}

} // namespace relief
