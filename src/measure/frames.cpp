// The suites `frame` and `scaling`: what frames of many triangles cost, and the preparation of cages.
#include <algorithm>
#include <cmath>

#include <malloc.h>

#include "measure/suite.h"

namespace relief {
namespace {

/// The paths by which the device can draw a scene at a rate.
std::vector<TimedDrawing> listPaths(const SceneOnDevice& on, const DeviceTraits& traits, int rate) {
    std::vector<TimedDrawing> all;
    const auto add = [&](Method method, Path path, Raster raster = Raster::hardware) {
        all.push_back({.method = method, .instance = on.model, .options = on.renderOptions(rate)});
        all.back().options.path = path;
        all.back().options.raster = raster;
    };
    if (traits.hasTessellation && std::uint32_t(rate) <= traits.maxTessellationLevel)
        add(Method::tessellation, Path::tessellation);
    add(Method::grid, Path::grid);
    add(Method::dicing, Path::dice);
    if (traits.hasLongAtomics) add(Method::dicingInCompute, Path::dice, Raster::compute);
    return all;
}

Renderer makeRenderer(SuiteContext& context, int side) {
    return Renderer(context.device, {.width = side, .height = side, .shadowSide = 1});
}

/// Times every path and rasterizer, and the dense mesh of the same triangles. Adds a row like `row` for each.
void timeAllMethods(SuiteContext& context, const SceneOnDevice& on, Renderer& renderer, int rate, int roundCount,
                    Row row) {
    std::vector<TimedDrawing> drawings = listPaths(on, context.device.traits(), rate);
    const MeshModel dense = uploadDenseMesh(context.device, makeDenseMesh(context.device, on.model, rate));
    const auto addDense = [&](Method method, Raster raster) {
        drawings.push_back({.method = method, .instance = dense, .options = on.renderOptions(rate)});
        drawings.back().options.raster = raster;
    };
    addDense(Method::denseRaw, Raster::hardware);
    if (context.device.traits().hasLongAtomics) addDense(Method::denseInCompute, Raster::compute);
    timeDrawings(renderer, on.views, roundCount, drawings);
    for (const TimedDrawing& drawing : drawings) {
        Row filled = row;
        filled.method = drawing.method;
        if (row.axis == Axis::triangles) filled.at = double(drawing.stats.triangleCount);
        drawing.addTo(filled);
        context.results.rows.push_back(filled);
    }
}

/// Copies of a cage, a diagonal apart: a cage of many faces with creases, seams and whatever else the cage has.
Cage repeatCage(const Cage& cage, int count) {
    Cage all;
    const auto offset = float(computeDiagonal(cage));
    const auto pointCount = std::uint32_t(cage.positions.size()), texCount = std::uint32_t(cage.texCoords.size());
    for (int copy = 0; copy < count; ++copy) {
        const auto firstPoint = std::uint32_t(copy) * pointCount, firstTex = std::uint32_t(copy) * texCount;
        // Points, faces and texture coordinates.
        for (const vec3& p : cage.positions) all.positions.push_back(p + vec3(float(copy) * offset, 0, 0));
        all.faceSizes.insert(all.faceSizes.end(), cage.faceSizes.begin(), cage.faceSizes.end());
        for (const std::uint32_t corner : cage.corners) all.corners.push_back(firstPoint + corner);
        all.texCoords.insert(all.texCoords.end(), cage.texCoords.begin(), cage.texCoords.end());
        for (const std::uint32_t corner : cage.texCorners) all.texCorners.push_back(firstTex + corner);
        // Creases and sharp vertices.
        for (const std::uint32_t point : cage.creaseEdges) all.creaseEdges.push_back(firstPoint + point);
        all.creaseSharpness.insert(all.creaseSharpness.end(), cage.creaseSharpness.begin(), cage.creaseSharpness.end());
        for (const std::uint32_t point : cage.sharpVertices) all.sharpVertices.push_back(firstPoint + point);
        all.vertexSharpness.insert(all.vertexSharpness.end(), cage.vertexSharpness.begin(), cage.vertexSharpness.end());
    }
    all.boundaryRule = cage.boundaryRule;
    all.texBoundaryRule = cage.texBoundaryRule;
    all.creaseMethod = cage.creaseMethod;
    return all;
}

/// Times the preparation of cages of more and more faces.
void measurePreparation(SuiteContext& context, const TestScene& scene) {
    int previous = 0;
    for (const double faces : {0.0, 6e3, 2.4e4, 1e5}) {
        const int copies = std::max(1, int(std::lround(faces / double(scene.cage.faceCount()))));
        if (copies == previous || faces > (context.options.isQuick ? 6e3 : 1e5)) continue;
        previous = copies;
        const Cage cage = repeatCage(scene.cage, copies);

        // A program prepares once, in fresh memory: small cages must not find it warm from the round before.
        std::vector<double> tables, upload;
        for (int round = 0; round < (faces < 2e4 && !context.options.isQuick ? 3 : 1); ++round) {
            malloc_trim(0);
            Surface surface;
            tables.push_back(measureMilliseconds([&] { surface = buildSurface(cage, scene.surface); }));
            upload.push_back(measureMilliseconds([&] {
                const SurfaceModel model(context.device, {.surface = &surface, .cagePositions = cage.positions});
            }));
        }

        Row row{Suite::scaling, scene.name, Method::preparation, Axis::faces, double(cage.faceCount()), {}};
        row.addMeasured(Metric::tableTime, tables);
        row.addMeasured(Metric::uploadTime, upload);
        row.addMeasured(Metric::preparationPerFace,
                        1e3 * (computeSpread(tables).median + computeSpread(upload).median) / double(cage.faceCount()));
        context.results.rows.push_back(row);
    }
}

/// Large frames vary less and take longer.
int chooseRoundCount(double triangles) { return triangles > 2e6 ? 0 : triangles > 5e5 ? 1 : 3; }

/// Time of the triangle passes where a method has the fewest triangles.
struct Fewest {
    double triangles = 0, milliseconds = 0;
};

/// Adds the cost per triangle, and per triangle more than the fewest: faces and draws cost the same with the fewest.
void addCosts(Row& row, std::map<Method, Fewest>& fewest) {
    const double passes = row.get(Metric::trianglePassTime);
    row.addComputed(Metric::costPerTriangle, 1e6 * passes / row.at);
    const auto [found, isFewest] = fewest.try_emplace(row.method, Fewest{row.at, passes});
    if (isFewest) return;
    RELIEF_CHECK(row.at > found->second.triangles);
    row.addComputed(Metric::costPerAdditionalTriangle,
                    1e6 * (passes - found->second.milliseconds) / (row.at - found->second.triangles));
}

/// Measures what a triangle costs that keeps its size on screen: the picture grows with the triangles. In a picture of
/// one size few triangles are large, and most of their cost is that of their pixels.
void measureTriangles(SuiteContext& context, const SceneOnDevice& on, const std::string& scene) {
    constexpr double kPixels = 1024 * 1024 / 1e6; // per triangle
    const std::vector<double> counts =
        context.options.isQuick ? std::vector<double>{3e3, 3e4} : std::vector<double>{3e3, 1e5, 1e6, 1e7};
    std::map<Method, Fewest> fewest;
    for (const double count : counts) {
        Renderer renderer = makeRenderer(context, int(std::lround(std::sqrt(kPixels * count))));
        const auto listDrawings = [&](int rate) {
            std::vector<TimedDrawing> all = listPaths(on, context.device.traits(), rate);
            for (TimedDrawing& drawing : all) drawing.options.filtersHeights = false; // same cost at every rate
            if (count > 5e6)
                std::erase_if(all, [](const TimedDrawing& d) { return d.options.path == Path::tessellation; });
            return all;
        };
        // One view, so that counts of different numbers of rounds see the same.
        const auto view = std::span(on.views).first(1);
        if (chooseRoundCount(count) == 0) { // no warm-up round: shaders are compiled by a small frame
            std::vector<TimedDrawing> small = listDrawings(1);
            timeDrawings(renderer, view, 0, small);
        }
        std::vector<TimedDrawing> drawings = listDrawings(on.chooseRate(count));
        timeDrawings(renderer, view, chooseRoundCount(count), drawings);
        for (const TimedDrawing& drawing : drawings) {
            Row row{
                Suite::scaling, scene, drawing.method, Axis::pixelTriangles, double(drawing.stats.triangleCount), {}};
            drawing.addTo(row);
            addCosts(row, fewest);
            context.results.rows.push_back(row);
        }
        context.progress.advance();
    }
}

} // namespace

void measureFrame(SuiteContext& context, const TestScene& scene) {
    const SceneOnDevice on(context.device, scene);
    Renderer renderer = makeRenderer(context, context.pictureSide());
    timeAllMethods(context, on, renderer, on.chooseRate(context.options.isQuick ? 6e4 : 1e6), context.roundCount(),
                   {.suite = Suite::frame, .scene = scene.name});
    context.progress.advance();
}

void measureScaling(SuiteContext& context, const TestScene& scene) {
    const SceneOnDevice on(context.device, scene);
    Renderer renderer = makeRenderer(context, context.pictureSide());
    int previous = 0;
    for (const double triangles : {3e3, 1e4, 3e4, 1e5, 3e5, 1e6, 3e6}) {
        context.progress.advance();
        const int rate = on.chooseRate(triangles);
        if (rate == previous || triangles > (context.options.isQuick ? 3e4 : 1e7)) continue;
        previous = rate;
        timeAllMethods(context, on, renderer, rate, chooseRoundCount(triangles),
                       {.suite = Suite::scaling, .scene = scene.name, .axis = Axis::triangles});
    }
    measureTriangles(context, on, scene.name);
    measurePreparation(context, scene);
}

} // namespace relief
