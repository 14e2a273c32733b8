#include "app/heatmap.h"

#include <algorithm>
#include <cmath>

#include "scene/scene.h"
#include "triangles/stages.h"

namespace relief::app {
namespace {

constexpr int kHeatmapSide = 1024;

double foldHeat(double factor) { return std::isfinite(factor) ? std::clamp(1 - 2 * factor, 0.0, 1.0) : 0; }

/// Samples of a face lie in rows; returns how many the first row of the first face has.
std::uint32_t countSideSamples(const SurfaceSamples& samples) {
    std::uint32_t count = 0;
    while (count < samples.queries.size() && samples.queries[count].face == samples.queries[0].face &&
           samples.queries[count].uv.y == 0)
        ++count;
    return count;
}

/// Triangles between the samples of one triangular face, whose rows become shorter.
std::vector<std::uint32_t> shortRowIndices(std::uint32_t n) {
    std::vector<std::uint32_t> indices = triangleGridIndices(n);
    for (std::uint32_t& index : indices) {
        const std::uint32_t i = index % (n + 1), j = index / (n + 1);
        index = j * (n + 1) - j * (j - 1) / 2 + i;
    }
    return indices;
}

bool isFinite(const vec3& p) { return std::isfinite(p.x + p.y + p.z); }

} // namespace

void checkHeatmapPath(const std::string& path) {
    if (!isPicturePath(path)) fail(Failure::usage, "{}: heat maps are written as .png or .exr", path);
}

std::vector<float> heatValues(const Heat& heat) {
    std::vector<float> values;
    for (std::size_t i = 0; i < heat.results.size(); ++i) {
        const double error = errorHeat(heat.errors[i]);
        const double fold = heat.samples.hasCurvature[i]
                                ? foldHeat(heat.errors[i].foldFactor.value_or(foldFactor(heat.results[i])))
                                : 0;
        values.push_back(float(fold > 0 ? -fold : error));
    }
    return values;
}

DenseMesh heatMesh(const Heat& heat, int sideCount) {
    const std::uint32_t side = countSideSamples(heat.samples);
    const std::vector<std::uint32_t> face =
        sideCount == 3 ? shortRowIndices(side - 1) : gridIndices(side - 1, side - 1);
    const std::uint32_t pointsPerFace = sideCount == 3 ? side * (side + 1) / 2 : side * side;
    DenseMesh mesh;
    for (const SampleResult& result : heat.results) {
        mesh.positions.push_back(result.q);
        mesh.normals.push_back(result.m);
    }
    for (std::uint32_t first = 0; first < heat.results.size(); first += pointsPerFace)
        for (const std::uint32_t index : face) mesh.indices.push_back(first + index);
    mesh.heights = heatValues(heat);
    return mesh;
}

Picture drawHeatmap(Device& device, const DenseMesh& mesh) {
    std::vector<dvec3> points;
    for (const vec3& p : mesh.positions)
        if (isFinite(p)) points.emplace_back(p);
    RenderOptions options;
    options.path = Path::grid;
    options.show = Show::height;
    options.camera = frameCamera(points, {}, 1);
    options.lighting.castsShadows = false;
    options.bounds = computeBounds(points);
    const MeshModel model(device, {.mesh = &mesh});
    Renderer renderer(device, {.width = kHeatmapSide, .height = kHeatmapSide, .shadowSide = 1});
    return renderer.render(model, options);
}

} // namespace relief::app
