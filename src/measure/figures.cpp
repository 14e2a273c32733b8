// Which metrics the report draws, and how.
#include <algorithm>

#include "measure/page.h"
#include "measure/words.h"

namespace relief {
namespace {

LineStyle chooseStyle(Method method) {
    switch (method) {
    case Method::cageFloatMap:
    case Method::tessellation:
    case Method::posedCage: return {0, 0};
    case Method::cageHalfMap: return {0, 1};
    case Method::cageUnorm16Map: return {0, 2};
    case Method::cageUnorm8Map: return {0, 3};
    case Method::cageBc4Map: return {0, 4};
    case Method::denseRaw: return {1, 0};
    case Method::denseQuantised: return {1, 1};
    case Method::denseDraco: return {1, 2};
    case Method::simplifiedRaw: return {2, 0};
    case Method::simplifiedQuantised: return {2, 1};
    case Method::simplifiedDraco: return {2, 2};
    case Method::geometryImage: return {3, 0};
    case Method::grid: return {3, 1};
    case Method::dicing: return {4, 2};
    case Method::dicingInCompute: return {4, 0};
    case Method::denseInCompute: return {1, 3};
    case Method::displacement: return {0, 0};
    case Method::displacementAndBump: return {1, 1};
    case Method::bump: return {2, 2};
    default: return {5, 0};
    }
}

using Number = std::function<double(const Row&)>;

Number take(Metric metric) {
    return [metric](const Row& row) { return row.get(metric); };
}
double takeAt(const Row& row) { return row.at; }

/// One line per method, in order of appearance. Points that are not positive are skipped: the axes are logarithmic.
std::vector<PlotLine> makeLines(std::span<const Row* const> rows, const Number& x, const Number& y,
                                const Number& upper = {}) {
    std::vector<PlotLine> lines;
    for (const Row* row : rows) {
        const char* name = toWord(row->method);
        auto line = std::ranges::find(lines, name, &PlotLine::name);
        if (line == lines.end()) line = lines.insert(lines.end(), {name, chooseStyle(row->method), {}, {}});
        if (!(x(*row) > 0) || !(y(*row) > 0)) continue;
        line->points.emplace_back(x(*row), y(*row));
        if (upper) line->upper.emplace_back(x(*row), upper(*row));
    }
    return lines;
}

/// A value of the raw dense mesh divided by that of each other method at the same point of the axis.
std::vector<PlotLine> makeRatioLines(std::span<const Row* const> rows, Metric metric) {
    std::vector<const Row*> others;
    std::map<double, double> dense;
    for (const Row* row : rows) {
        if (row->method == Method::denseRaw)
            dense[row->at] = row->get(metric);
        else
            others.push_back(row);
    }
    return makeLines(others, takeAt, [&](const Row& row) {
        const auto found = dense.find(row.at);
        return found == dense.end() || !(row.get(metric) > 0) ? 0 : found->second / row.get(metric);
    });
}

/// The bytes of each of `meshes` divided by the fewest of any cage and map of the same tolerance, drawn over the
/// triangles of the dense mesh that meets the tolerance.
std::string drawEqualErrorFigure(std::span<const Row* const> rows, const char* title, Metric metric,
                                 const std::vector<Method>& meshes) {
    // By tolerance: the smallest cage and map, and the triangles of the dense mesh.
    std::map<double, double> smallest, triangles;
    for (const Row* row : rows) {
        if (row->method == Method::denseRaw) triangles[row->at] = row->get(Metric::triangles);
        if (!isCageAndMap(row->method)) continue;
        const auto [found, isFirst] = smallest.emplace(row->at, row->get(metric));
        if (!isFirst) found->second = std::min(found->second, row->get(metric));
    }
    std::vector<const Row*> compared;
    std::ranges::copy_if(rows, std::back_inserter(compared), [&](const Row* row) {
        return std::ranges::find(meshes, row->method) != meshes.end() && smallest.contains(row->at);
    });
    return drawFigure({.title = title,
                       .xLabel = "triangles of the dense mesh",
                       .yLabel = "mesh / smallest cage and map",
                       .yScale = Scale::ratio,
                       .lines = makeLines(
                           compared, [&](const Row& row) { return triangles[row.at]; },
                           [&](const Row& row) { return row.get(metric) / smallest.at(row.at); }),
                       .rule = 1,
                       .belowRule = "displacement loses",
                       .aboveRule = "displacement saves"});
}

std::string drawSceneFigures(const std::vector<const Row*>& rows) {
    const std::string error = "RMS distance to the reference, fraction of the diagonal";
    // What each method takes, against its error.
    std::string html = drawFigure({.title = "Bytes on the device against error",
                                   .xLabel = error,
                                   .yLabel = "resident",
                                   .caption = "Left and down is better. Forms that are only for the disk are missing.",
                                   .xScale = Scale::percent,
                                   .lines = makeLines(rows, take(Metric::rmsError), take(Metric::residentBytes))});
    html += drawFigure({.title = "Bytes on disk against error",
                        .xLabel = error,
                        .yLabel = "files",
                        .caption = "Quantised meshes in meshoptimizer's coding; maps in their smallest lossless file.",
                        .xScale = Scale::percent,
                        .lines = makeLines(rows, take(Metric::rmsError), take(Metric::diskBytes))});
    html += drawFigure({.title = "Similarity of pictures against bytes",
                        .xLabel = "resident bytes",
                        .yLabel = "PSNR of two views, object only",
                        .caption = "Up and left is better: equal distances do not look equal.",
                        .xScale = Scale::bytes,
                        .yScale = Scale::decibels,
                        .isYLog = false,
                        .lines = makeLines(rows, take(Metric::residentBytes), take(Metric::picturePsnr))});
    // What meshes take, divided by what cage and map take.
    html += drawEqualErrorFigure(
        rows, "Break-even at equal error, on the device", Metric::residentBytes,
        {Method::denseRaw, Method::denseQuantised, Method::simplifiedRaw, Method::simplifiedQuantised});
    return html + drawEqualErrorFigure(rows, "Break-even at equal error, on disk", Metric::diskBytes,
                                       {Method::denseQuantised, Method::denseDraco, Method::simplifiedQuantised,
                                        Method::simplifiedDraco});
}

} // namespace

std::string drawBandwidthFigures(const Results& results) {
    std::string html;
    for (const std::string& scene : listScenes(results, Suite::bandwidth))
        html += "<h3>" + escapeHtml(scene) + "</h3><div class=\"figures\">" +
                drawSceneFigures(selectScene(selectRows(results, Suite::bandwidth, Axis::tolerance), scene)) + "</div>";
    return html;
}

std::string drawScalingFigures(const Results& results) {
    const std::vector<const Row*> rows = selectRows(results, Suite::scaling, Axis::triangles);
    std::string html = "<div class=\"figures\">";
    // In a picture of one size.
    html += drawFigure({.title = "Frame time against triangles",
                        .xLabel = "triangles",
                        .yLabel = "median, rates to pixels on the host",
                        .yScale = Scale::milliseconds,
                        .lines = makeLines(rows, takeAt, take(Metric::frameTime))});
    html += drawFigure(
        {.title = "Bytes read per frame against triangles, between all caches and none",
         .xLabel = "triangles",
         .yLabel = "bytes read per frame",
         .caption = "The lower border reads every resident byte once, the upper one fetches for every shader "
                    "invocation; a device is between them.",
         .lines = makeLines(rows, takeAt, take(Metric::bytesReadCached), take(Metric::bytesReadUncached))});
    // In pictures that grow with the triangles, and of cages that grow.
    html += drawFigure({.title = "Cost per additional triangle of constant size on screen",
                        .xLabel = "triangles, one per pixel: the picture grows with them",
                        .yLabel = "dice pass and color pass",
                        .yScale = Scale::nanoseconds,
                        .lines = makeLines(selectRows(results, Suite::scaling, Axis::pixelTriangles), takeAt,
                                           take(Metric::costPerAdditionalTriangle))});
    html +=
        drawFigure({.title = "Preparing a cage",
                    .xLabel = "faces of the cage",
                    .yLabel = "building and uploading OpenSubdiv's tables",
                    .yScale = Scale::milliseconds,
                    .lines = makeLines(selectRows(results, Suite::scaling, Axis::faces), takeAt, [](const Row& row) {
                        return row.get(Metric::tableTime) + row.get(Metric::uploadTime);
                    })});
    return html + "</div>";
}

std::string drawBreakEvenFigures(const Results& results) {
    // All figures have the same axes and the same rule at 1.
    const std::vector<const Row*> rows = selectRows(results, Suite::scaling, Axis::triangles);
    const auto figure = [&](const char* title, Metric metric, const char* caption) {
        return drawFigure({.title = title,
                           .xLabel = "triangles",
                           .yLabel = "dense mesh / displaced surface",
                           .caption = caption,
                           .yScale = Scale::ratio,
                           .lines = makeRatioLines(rows, metric),
                           .rule = 1,
                           .belowRule = "displacement loses",
                           .aboveRule = "displacement saves"});
    };
    return "<div class=\"figures\">" +
           figure("Break-even of time", Metric::frameTime,
                  "A static mesh costs nothing to prepare: where the processor does the work of a graphics card, "
                  "evaluating the surface in each frame has to lose.") +
           figure("Break-even of resident bytes", Metric::residentBytes,
                  "The map is the scene's own, 32-bit floats in full size: see above for maps as small as the error "
                  "allows.") +
           figure("Break-even of bytes read, with all caches", Metric::bytesReadCached, "") +
           figure("Break-even of bytes read, without caches", Metric::bytesReadUncached,
                  "Sixteen control points per vertex, each fetched from memory: the worst case.") +
           "</div>";
}

std::string drawAnimateFigures(const Results& results) {
    const std::vector<const Row*> rows = selectRows(results, Suite::animate, Axis::triangles);
    return "<div class=\"figures\">" +
           drawFigure({.title = "Bytes uploaded per pose",
                       .xLabel = "triangles",
                       .yLabel = "bytes uploaded per pose",
                       .caption = "The points of the cage do not depend on the triangles that are drawn.",
                       .lines = makeLines(rows, takeAt, take(Metric::uploadedBytes))}) +
           drawFigure({.title = "Time of a posed frame",
                       .xLabel = "triangles",
                       .yLabel = "median",
                       .yScale = Scale::milliseconds,
                       .lines = makeLines(rows, takeAt, take(Metric::frameTime))}) +
           "</div>";
}

std::string drawDetailFigures(const Results& results) {
    std::string html;
    for (const std::string& scene : listScenes(results, Suite::detail)) {
        std::vector<const Row*> rows = selectScene(selectRows(results, Suite::detail, Axis::segmentPixels), scene);
        std::erase_if(rows, [](const Row* row) { return row->method == Method::undisplaced; });
        html += "<div class=\"figures\">" +
                drawFigure({.title = scene + ": picture error against time",
                            .xLabel = "time of a frame",
                            .yLabel = "RMSE of two views, object only",
                            .caption = "Segments of 8 to 0.5 pixels; the reference is displacement with segments of a "
                                       "quarter of a pixel. Left and down is better.",
                            .xScale = Scale::milliseconds,
                            .lines = makeLines(rows, take(Metric::frameTime), take(Metric::pictureRmse))}) +
                drawFigure({.title = scene + ": picture error against the length of segments",
                            .xLabel = "pixels per segment",
                            .yLabel = "RMSE of two views, object only",
                            .lines = makeLines(rows, takeAt, take(Metric::pictureRmse))}) +
                "</div>";
    }
    return html;
}

} // namespace relief
