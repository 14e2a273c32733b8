// The suites `frame` and `scaling`: what frames of so many triangles cost, and getting ready for them.
#include <algorithm>
#include <cmath>

#include <malloc.h>

#include "measure/parts.h"

namespace relief {
namespace {

std::vector<Drawn> pathsOf(const OnDevice& on, const DeviceTraits& traits, int rate) {
    std::vector<Drawn> all;
    const auto add = [&](const char* name, Path path) {
        RenderOptions options = on.renderOptions(rate);
        options.path = path;
        all.push_back({.name = name, .instance = on.model, .options = options});
    };
    if (traits.hasTessellation && std::uint32_t(rate) <= traits.maxTessellationLevel)
        add("tessellation", Path::tessellation);
    add("grid", Path::grid);
    add("dicing", Path::dice);
    return all;
}

void addRows(Bench& bench, const Row& like, std::span<const Drawn> all) {
    for (const Drawn& drawn : all) {
        Row row = like;
        row.contestant = drawn.name;
        drawn.tell(row);
        bench.results.rows.push_back(row);
    }
}

/// Copies of a cage in a row: as many faces as one likes, with everything that makes a cage costly.
Cage repeated(const Cage& cage, int count) {
    Cage all;
    const auto pointCount = std::uint32_t(cage.positions.size()), texCount = std::uint32_t(cage.texCoords.size());
    for (int copy = 0; copy < count; ++copy) {
        const auto firstPoint = std::uint32_t(copy) * pointCount, firstTex = std::uint32_t(copy) * texCount;
        for (const vec3& p : cage.positions)
            all.positions.push_back(p + vec3(float(copy) * float(diagonalOf(cage)), 0, 0));
        all.faceSizes.insert(all.faceSizes.end(), cage.faceSizes.begin(), cage.faceSizes.end());
        for (const std::uint32_t corner : cage.corners) all.corners.push_back(firstPoint + corner);
        all.texCoords.insert(all.texCoords.end(), cage.texCoords.begin(), cage.texCoords.end());
        for (const std::uint32_t corner : cage.texCorners) all.texCorners.push_back(firstTex + corner);
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

/// Preparation against the faces of the cage.
void measurePreparation(Bench& bench, const Subject& subject) {
    int previous = 0;
    for (const double faces : {0.0, 6e3, 2.4e4, 1e5}) {
        const int copies = std::max(1, int(std::lround(faces / double(subject.cage.faceCount()))));
        if (copies == previous || faces > (bench.options.isQuick ? 6e3 : 1e5)) continue;
        previous = copies;
        const Cage cage = repeated(subject.cage, copies);
        std::vector<double> tables, upload;
        for (int round = 0; round < (faces < 2e4 && !bench.options.isQuick ? 3 : 1); ++round) {
            malloc_trim(0); // a program prepares once, in fresh memory: rounds of small cages must not find it warm
            Surface surface;
            tables.push_back(millisecondsOf([&] { surface = buildSurface(cage, subject.surface); }));
            upload.push_back(millisecondsOf([&] {
                const SurfaceModel model(bench.device, {.surface = &surface, .cagePositions = cage.positions});
            }));
        }
        Row row{"scaling", subject.name, "preparation", "faces", double(cage.faceCount()), {}};
        row.add("tables", "ms", tables);
        row.add("upload", "ms", upload);
        row.add("a face", "us", Origin::measured,
                1e3 * (spreadOf(tables).median + spreadOf(upload).median) / double(cage.faceCount()));
        bench.results.rows.push_back(row);
    }
}

} // namespace

void measureFrame(Bench& bench, const Subject& subject) {
    const OnDevice on(bench.device, subject);
    const int rate = on.rateFor(bench.options.isQuick ? 6e4 : 1e6);
    std::vector<Drawn> all = pathsOf(on, bench.device.traits(), rate);
    const std::unique_ptr<MeshModel> dense = denseModel(bench.device, denseMeshOf(bench.device, on.model, rate));
    all.push_back({.name = kDense, .instance = *dense, .options = on.renderOptions(rate)});
    Renderer renderer(bench.device, {.width = bench.pictureSide(), .height = bench.pictureSide(), .shadowSide = 1});
    drawRounds(renderer, on.views, bench.roundCount(), all);
    addRows(bench, {.suite = "frame", .scene = subject.name}, all);
    bench.progress.advance();
}

namespace {

/// Large frames vary less and take longer.
int scalingRounds(double triangles) { return triangles > 2e6 ? 0 : triangles > 5e5 ? 1 : 3; }

/// What a triangle costs that keeps its size on screen: the picture grows with the triangles. In a picture of one size
/// few triangles are large, and most of their cost is that of their pixels.
void measureTriangles(Bench& bench, const OnDevice& on, const std::string& scene) {
    constexpr double kPixels = 1024 * 1024 / 1e6; // a triangle
    const std::vector<double> counts =
        bench.options.isQuick ? std::vector<double>{3e3, 3e4} : std::vector<double>{3e3, 1e5, 1e6, 1e7};
    std::map<std::string, std::pair<double, double>> least; // triangles, and the time of their passes
    for (const double count : counts) {
        const int side = int(std::lround(std::sqrt(kPixels * count)));
        Renderer renderer(bench.device, {.width = side, .height = side, .shadowSide = 1});
        const auto paths = [&](int rate) {
            std::vector<Drawn> all = pathsOf(on, bench.device.traits(), rate);
            for (Drawn& drawn : all) drawn.options.filtersHeights = false; // heights cost the same at every rate
            if (count > 5e6)
                std::erase_if(all, [](const Drawn& drawn) { return drawn.options.path == Path::tessellation; });
            return all;
        };
        std::vector<Drawn> all = paths(on.rateFor(count));
        const auto view = std::span(on.views).first(1); // the same one, however few rounds there are
        if (scalingRounds(count) == 0) {                // shaders are compiled for less
            std::vector<Drawn> few = paths(1);
            drawRounds(renderer, view, 0, few);
        }
        drawRounds(renderer, view, scalingRounds(count), all);
        for (const Drawn& drawn : all) {
            Row row{"scaling", scene, drawn.name, "triangles of a pixel", double(drawn.last.triangleCount), {}};
            drawn.tell(row);
            const double passes = row.get("triangle passes");
            row.add("a triangle", "ns", Origin::computed, 1e6 * passes / row.at);
            // More than the fewest triangles of the same faces cost: what faces and draws cost themselves is not
            // theirs.
            const auto [fewest, isFewest] = least.try_emplace(drawn.name, row.at, passes);
            if (!isFewest)
                row.add("a further triangle", "ns", Origin::computed,
                        1e6 * (passes - fewest->second.second) / (row.at - fewest->second.first));
            bench.results.rows.push_back(row);
        }
        bench.progress.advance();
    }
}

} // namespace

void measureScaling(Bench& bench, const Subject& subject) {
    const OnDevice on(bench.device, subject);
    Renderer renderer(bench.device, {.width = bench.pictureSide(), .height = bench.pictureSide(), .shadowSide = 1});
    int previous = 0;
    for (const double triangles : {3e3, 1e4, 3e4, 1e5, 3e5, 1e6, 3e6}) {
        bench.progress.advance();
        const int rate = on.rateFor(triangles);
        if (rate == previous || triangles > (bench.options.isQuick ? 3e4 : 1e7)) continue;
        previous = rate;
        std::vector<Drawn> all = pathsOf(on, bench.device.traits(), rate);
        const std::unique_ptr<MeshModel> dense = denseModel(bench.device, denseMeshOf(bench.device, on.model, rate));
        all.push_back({.name = kDense, .instance = *dense, .options = on.renderOptions(rate)});
        drawRounds(renderer, on.views, scalingRounds(triangles), all);
        for (Drawn& drawn : all) {
            Row row{"scaling", subject.name, drawn.name, "triangles", double(drawn.last.triangleCount), {}};
            drawn.tell(row);
            bench.results.rows.push_back(row);
        }
    }
    measureTriangles(bench, on, subject.name);
    measurePreparation(bench, subject);
}

} // namespace relief
