#include <algorithm>
#include <chrono>
#include <cmath>

#include "measure/parts.h"

namespace relief {
namespace {

std::vector<dvec3> outlineOf(const Subject& subject) {
    const ReferenceSurface coarse(subject.cage, {.scheme = subject.surface.scheme, .isolation = 2});
    return outline(coarse, &subject.height);
}

} // namespace

double diagonalOf(const Cage& cage) {
    Bounds bounds;
    for (const vec3& p : cage.positions) bounds.add(dvec3(p));
    return bounds.diagonal();
}

double millisecondsOf(const std::function<void()>& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

std::vector<Camera> cameraPath(std::span<const dvec3> points) {
    std::vector<Camera> views;
    for (const double azimuth : {30.0, 120.0, 210.0, 300.0})
        views.push_back(frameCamera(points, {.azimuth = azimuth}, 1));
    return views;
}

OnDevice::OnDevice(Device& device, const Subject& subject)
    : surface(buildSurface(subject.cage, subject.surface)), model(device, {.surface = &surface,
                                                                           .cagePositions = subject.cage.positions,
                                                                           .height = &subject.height,
                                                                           .encoding = &subject.heightEncoding}) {
    const std::vector<dvec3> points = outlineOf(subject);
    views = cameraPath(points);
    for (const dvec3& p : points) bounds.add(p);
}

int OnDevice::rateFor(double triangles) const {
    const double perFace = model.isTriangles() ? 1 : 2;
    return std::max(1, int(std::lround(std::sqrt(triangles / (perFace * double(surface.faces.size()))))));
}

RenderOptions OnDevice::renderOptions(int rate) const {
    RenderOptions options;
    options.rate = rate;
    options.camera = views.front();
    options.bounds = bounds;
    options.lighting.castsShadows = false;
    return options;
}

EdgeRates exactRates(const SurfaceModel& model, int rate) { return {.rates = uniformRates(model, float(rate))}; }

DenseMesh denseMeshOf(Device& device, const SurfaceModel& model, int rate) {
    return Dicer(device).diceToHost(model, exactRates(model, rate), {.wantsTexCoords = model.hasTexCoords});
}

std::unique_ptr<MeshModel> denseModel(Device& device, const DenseMesh& mesh) {
    return std::make_unique<MeshModel>(device, MeshModelDesc{.mesh = &mesh});
}

void Drawn::tell(Row& row) const {
    row.add("frame", "ms", wall);
    row.add("triangle passes", "ms", [&] {
        std::vector<double> both;
        for (std::size_t i = 0; i < color.size(); ++i) both.push_back(dice[i] + color[i]);
        return both;
    }());
    row.add("rates pass", "ms", rates);
    if (options.path == Path::dice && instance.surface != nullptr) row.add("dice pass", "ms", dice);
    row.add("color pass", "ms", color);
    row.add("light pass", "ms", light);
    row.add("triangles", "triangles", Origin::measured, double(last.triangleCount));
    row.add("distinct vertices", "vertices", Origin::measured, double(last.vertexCount));
    const PipelineCounts& counts = last.pipeline;
    const bool hasCounts = counts.primitives > 0;
    if (hasCounts) {
        row.add("vertex calls", "calls", Origin::measured, double(counts.vertexCalls));
        row.add("tessellation calls", "calls", Origin::measured, double(counts.tessellationCalls));
        row.add("primitives", "primitives", Origin::measured, double(counts.primitives));
        row.add("primitives drawn", "primitives", Origin::measured, double(counts.drawnPrimitives));
        row.add("fragment calls", "calls", Origin::measured, double(counts.fragmentCalls));
    }
    const MeshCounts mesh{last.vertexCount, last.triangleCount};
    Traffic traffic;
    if (instance.mesh != nullptr) {
        row.add("resident", "bytes", Origin::computed, double(residentBytes(kRawLayout, mesh)));
        traffic = denseTraffic(kRawLayout, mesh, hasCounts ? counts.vertexCalls : 3 * mesh.triangles);
    } else {
        row.add("resident", "bytes", Origin::measured, double(instance.surface->byteCount));
        const bool isDiced = options.path == Path::dice;
        const std::uint64_t calls = options.path == Path::tessellation ? counts.tessellationCalls : counts.vertexCalls;
        traffic = surfaceTraffic({.residentBytes = instance.surface->byteCount,
                                  .calls = hasCounts && !isDiced ? calls : mesh.vertices,
                                  .evaluation = {instance.surface->hasTexCoords, instance.surface->hasWideIndices,
                                                 instance.surface->mapFormat()},
                                  .diced = isDiced ? mesh : MeshCounts{}});
    }
    row.add("read a frame, least", "bytes", Origin::computed, double(traffic.least));
    row.add("read a frame, cacheless", "bytes", Origin::computed, double(traffic.cacheless));
}

void drawRounds(Renderer& renderer, std::span<const Camera> views, int roundCount, std::span<Drawn> all) {
    for (int round = -1; round < roundCount; ++round)
        for (Drawn& drawn : all) {
            RenderOptions options = drawn.options;
            options.camera = views[std::size_t(std::max(round, 0)) % views.size()];
            options.countsPipeline = round < 0; // the round that compiles shaders, not measured
            const double poseMs = millisecondsOf([&] { drawn.pose(round); });
            const FrameStats stats = renderer.render(drawn.instance, options).stats;
            if (round < 0) drawn.last = stats;
            if (round < 0 && roundCount > 0) continue;
            drawn.wall.push_back(poseMs + stats.wallMs);
            drawn.poses.push_back(poseMs);
            drawn.rates.push_back(stats.rateMs);
            drawn.dice.push_back(stats.diceMs);
            drawn.color.push_back(stats.colorMs);
            drawn.light.push_back(stats.lightMs);
        }
}

} // namespace relief
