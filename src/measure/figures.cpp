// Which numbers a report draws, and how.
#include <algorithm>

#include "measure/goals.h"
#include "measure/page.h"
#include "measure/parts.h"

namespace relief {
namespace {

/// Colors are families, dashes and marks their members.
LineStyle styleOf(const std::string& contestant) {
    static const std::map<std::string, LineStyle> styles{
        {"cage + float map", {0, 0}},
        {"cage + half map", {0, 1}},
        {"cage + unorm16 map", {0, 2}},
        {"cage + unorm8 map", {0, 3}},
        {"cage + bc4 map", {0, 4}},
        {"dense mesh, raw", {1, 0}},
        {"dense mesh, quantised", {1, 1}},
        {"Draco, dense mesh", {1, 2}},
        {"simplified mesh, raw", {2, 0}},
        {"simplified mesh, quantised", {2, 1}},
        {"Draco, simplified mesh", {2, 2}},
        {"tessellation", {0, 0}},
        {"grid", {3, 1}},
        {"dicing", {4, 2}},
        {"posed cage", {0, 0}},
    };
    const auto found = styles.find(contestant);
    return found != styles.end() ? found->second : LineStyle{5, 0};
}

using Number = std::function<double(const Row&)>;

/// One line a contestant, in order of appearance; points without a positive number are left out.
std::vector<PlotLine> linesOf(std::span<const Row* const> rows, const Number& x, const Number& y,
                              const Number& upper = {}) {
    std::vector<PlotLine> lines;
    for (const Row* row : rows) {
        auto line = std::ranges::find(lines, row->contestant, &PlotLine::name);
        if (line == lines.end()) line = lines.insert(lines.end(), {row->contestant, styleOf(row->contestant), {}, {}});
        if (!(x(*row) > 0) || !(y(*row) > 0)) continue;
        line->points.emplace_back(x(*row), y(*row));
        if (upper) line->upper.emplace_back(x(*row), upper(*row));
    }
    return lines;
}

Number value(const char* name) {
    return [name](const Row& row) { return row.get(name); };
}

std::vector<const Row*> inScene(const std::vector<const Row*>& rows, const std::string& scene) {
    std::vector<const Row*> some;
    std::ranges::copy_if(rows, std::back_inserter(some), [&](const Row* row) { return row->scene == scene; });
    return some;
}

/// How many times as much a dense mesh takes as each other contestant at the same place of the axis.
std::vector<PlotLine> quotients(std::span<const Row* const> rows, const std::string& opponent, const char* value) {
    std::vector<const Row*> ours;
    std::map<double, double> theirs;
    for (const Row* row : rows) {
        if (row->contestant == opponent)
            theirs[row->at] = row->get(value);
        else
            ours.push_back(row);
    }
    return linesOf(
        ours, [](const Row& row) { return row.at; },
        [&](const Row& row) {
            const auto found = theirs.find(row.at);
            return found == theirs.end() || !(row.get(value) > 0) ? 0 : found->second / row.get(value);
        });
}

/// Each opponent's bytes to the fewest of any cage and map, by the triangles of the dense mesh of that error.
std::string equalErrorFigure(std::span<const Row* const> rows, const char* title, const char* value,
                             const std::vector<std::string>& opponents) {
    std::map<double, double> ours, triangles; // by tolerance
    for (const Row* row : rows) {
        if (row->contestant == "dense mesh, raw") triangles[row->at] = row->get("triangles");
        if (!row->contestant.starts_with("cage + ")) continue;
        const auto [found, isFirst] = ours.emplace(row->at, row->get(value));
        if (!isFirst) found->second = std::min(found->second, row->get(value));
    }
    std::vector<const Row*> theirs;
    std::ranges::copy_if(rows, std::back_inserter(theirs), [&](const Row* row) {
        return std::ranges::find(opponents, row->contestant) != opponents.end() && ours.contains(row->at);
    });
    return figureOf({.title = title,
                     .xLabel = "triangles of the dense mesh",
                     .yLabel = "opponent to the smallest cage and map",
                     .yScale = Scale::ratio,
                     .lines = linesOf(
                         theirs, [&](const Row& row) { return triangles[row.at]; },
                         [&](const Row& row) { return row.get(value) / ours.at(row.at); }),
                     .rule = 1,
                     .belowRule = "displacement loses",
                     .aboveRule = "displacement saves"});
}

} // namespace

std::string bandwidthFigures(const Results& results) {
    const std::vector<const Row*> all = rowsOf(results, "bandwidth", "tolerance");
    std::string html;
    for (const std::string& scene : scenesOf(results, "bandwidth")) {
        const std::vector<const Row*> rows = inScene(all, scene);
        const std::string error = "RMS distance to the reference, share of the diagonal";
        html += "<h3>" + escaped(scene) + "</h3><div class=\"figures\">";
        html += figureOf({.title = "Bytes on the device against error",
                          .xLabel = error,
                          .yLabel = "resident",
                          .caption = "Left and down is better. What is only for the disk is missing here.",
                          .xScale = Scale::percent,
                          .lines = linesOf(rows, value("rms"), value("resident"))});
        html += figureOf({.title = "Bytes on disk against error",
                          .xLabel = error,
                          .yLabel = "files",
                          .caption = "Quantised meshes run through meshoptimizer's encoders; maps in their smallest "
                                     "lossless file.",
                          .xScale = Scale::percent,
                          .lines = linesOf(rows, value("rms"), value("disk"))});
        html += figureOf({.title = "What it looks like against bytes",
                          .xLabel = "resident bytes",
                          .yLabel = "PSNR of two views, object only",
                          .caption = "Up and left is better: equal distances do not look equal.",
                          .xScale = Scale::bytes,
                          .yScale = Scale::decibels,
                          .isYLog = false,
                          .lines = linesOf(rows, value("resident"), value("picture psnr"))});
        html += equalErrorFigure(
            rows, "Break-even at equal error, on the device", "resident",
            {"dense mesh, raw", "dense mesh, quantised", "simplified mesh, raw", "simplified mesh, quantised"});
        html += equalErrorFigure(
            rows, "Break-even at equal error, on disk", "disk",
            {"dense mesh, quantised", "Draco, dense mesh", "simplified mesh, quantised", "Draco, simplified mesh"});
        html += "</div>";
    }
    return html;
}

std::string scalingFigures(const Results& results) {
    const std::vector<const Row*> rows = rowsOf(results, "scaling", "triangles");
    const Number at = [](const Row& row) { return row.at; };
    std::string html = "<div class=\"figures\">";
    html += figureOf({.title = "Time of a frame against triangles",
                      .xLabel = "triangles",
                      .yLabel = "median, rates to pixels on the host",
                      .yScale = Scale::milliseconds,
                      .lines = linesOf(rows, at, value("frame"))});
    html +=
        figureOf({.title = "Bytes read a frame against triangles, between all caches and none",
                  .xLabel = "triangles",
                  .yLabel = "read a frame",
                  .caption = "The lower border reads every resident byte once, the upper one fetches for every call "
                             "anew; a device is between them.",
                  .lines = linesOf(rows, at, value("read a frame, least"), value("read a frame, cacheless"))});
    html += figureOf(
        {.title = "Cost of a further triangle, all of one size on screen",
         .xLabel = "triangles, one a pixel: the picture grows with them",
         .yLabel = "dicing and color pass, a triangle more",
         .yScale = Scale::nanoseconds,
         .lines = linesOf(rowsOf(results, "scaling", "triangles of a pixel"), at, value("a further triangle"))});
    html += figureOf({.title = "Preparing a cage",
                      .xLabel = "faces of the cage",
                      .yLabel = "OpenSubdiv's tables and upload",
                      .yScale = Scale::milliseconds,
                      .lines = linesOf(rowsOf(results, "scaling", "faces"), at,
                                       [](const Row& row) { return row.get("tables") + row.get("upload"); })});
    return html + "</div>";
}

std::string breakEvenFigures(const Results& results) {
    const std::vector<const Row*> rows = rowsOf(results, "scaling", "triangles");
    const auto figure = [&](const char* title, const char* value, const char* caption) {
        return figureOf({.title = title,
                         .xLabel = "triangles",
                         .yLabel = "dense mesh to displaced surface",
                         .caption = caption,
                         .yScale = Scale::ratio,
                         .lines = quotients(rows, kDense, value),
                         .rule = 1,
                         .belowRule = "displacement loses",
                         .aboveRule = "displacement saves"});
    };
    std::string html = "<div class=\"figures\">";
    html += figure("Break-even of time", "frame",
                   "A static mesh costs nothing to prepare: on a processor that plays a "
                   "graphics card, evaluating the surface anew has to lose.");
    html += figure("Break-even of resident bytes", "resident",
                   "The map here is the scene's own, 32-bit floats in full size: see above for maps as small as the "
                   "error allows.");
    html += figure("Break-even of bytes read, with all caches", "read a frame, least", "");
    html += figure("Break-even of bytes read, without caches", "read a frame, cacheless",
                   "Sixteen control points for every vertex, each fetched from memory: the worst that can be.");
    return html + "</div>";
}

std::string animateFigures(const Results& results) {
    const std::vector<const Row*> rows = rowsOf(results, "animate", "triangles");
    const Number at = [](const Row& row) { return row.at; };
    std::string html = "<div class=\"figures\">";
    html += figureOf({.title = "Bytes uploaded for a pose",
                      .xLabel = "triangles",
                      .yLabel = "uploaded a frame",
                      .caption = "The cage's points do not know how fine they are drawn.",
                      .lines = linesOf(rows, at, value("uploaded a frame"))});
    html += figureOf({.title = "Time of a posed frame",
                      .xLabel = "triangles",
                      .yLabel = "median",
                      .yScale = Scale::milliseconds,
                      .lines = linesOf(rows, at, value("frame"))});
    return html + "</div>";
}

} // namespace relief
