// Internal: plots as SVG that takes its colors from the page's style sheet.
#pragma once

#include <optional>

#include "measure/measure.h"

namespace relief {

enum class Scale { bytes, milliseconds, nanoseconds, percent, count, ratio, decibels };

/// How a line looks: one color a family, one dash and mark a member, so that no two rest on color alone.
struct LineStyle {
    int color = 0; ///< 0..5
    int dash = 0;  ///< 0..4
};

struct PlotLine {
    std::string name;
    LineStyle style;
    std::vector<dvec2> points;
    std::vector<dvec2> upper; ///< the other border of a band above the line, or none
};

struct Plot {
    std::string title, xLabel, yLabel, caption;
    Scale xScale = Scale::count, yScale = Scale::bytes;
    bool isYLog = true; ///< x always is
    std::vector<PlotLine> lines;
    std::optional<double> rule;       ///< a horizontal line, such as break-even
    std::string belowRule, aboveRule; ///< words beside it
};

/// A <figure> with its title, plot, legend and caption; empty when no line has points.
std::string figureOf(const Plot& plot);
std::string escaped(const std::string& text); ///< for HTML
/// "2.5 MB", "0.003 %", "12 ms": as axes print it.
std::string wordOf(double value, Scale scale);

} // namespace relief
