// Internal: plots as SVG that takes its colors from the page's style sheet.
#pragma once

#include <optional>

#include "measure/results.h"

namespace relief {

enum class Scale { bytes, milliseconds, nanoseconds, percent, count, ratio, decibels };

/// How a line looks: a color per family of methods, a dash and mark per member, so that no two lines differ by color
/// alone.
struct LineStyle {
    int color = 0; ///< 0..5
    int dash = 0;  ///< 0..4
};

struct PlotLine {
    std::string name;
    LineStyle style;
    std::vector<dvec2> points; ///< positive where the axis is logarithmic
    std::vector<dvec2> upper;  ///< the upper border of a band whose lower border is the line; or none
};

struct Plot {
    std::string title, xLabel, yLabel, caption;
    Scale xScale = Scale::count, yScale = Scale::bytes;
    bool isYLog = true; ///< the x axis is always logarithmic
    std::vector<PlotLine> lines;
    std::optional<double> rule;       ///< a horizontal line, such as break-even
    std::string belowRule, aboveRule; ///< notes beside it
};

/// Returns a <figure> with title, plot, legend and caption; an empty string where no line has points.
std::string drawFigure(const Plot& plot);
std::string escapeHtml(const std::string& text);
/// Three digits and a unit, as axes print a value: "2.5 MB", "0.003 %", "12 ms". `percent` takes a fraction.
std::string formatNumber(double value, Scale scale);

} // namespace relief
