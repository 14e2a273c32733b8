#include "measure/plot.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

// In units of the viewBox.
constexpr double kWidth = 480, kHeight = 330, kLeft = 66, kRight = 12, kTop = 10, kBottom = 46;

constexpr const char* kDashes[] = {"", "7 4", "2 3", "10 3 2 3", "1 5"};

/// A mark of 6 units, its shape given by the dash; the legend and the plot use the same.
std::string drawMark(double x, double y, const LineStyle& style) {
    const std::string color = fmt::format("class=\"mark c{}\"", style.color);
    switch (style.dash) {
    case 0: return fmt::format("<circle {} cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.2\"/>", color, x, y);
    case 1: return fmt::format("<rect {} x=\"{:.1f}\" y=\"{:.1f}\" width=\"6\" height=\"6\"/>", color, x - 3, y - 3);
    case 2: return fmt::format("<path {} d=\"M{:.1f} {:.1f}l4 7h-8z\"/>", color, x, y - 4);
    case 3: return fmt::format("<path {} d=\"M{:.1f} {:.1f}l4 4l-4 4l-4 -4z\"/>", color, x, y - 4);
    default: return fmt::format("<path {} d=\"M{:.1f} {:.1f}l4 -7h-8z\"/>", color, x, y + 4);
    }
}

/// Maps the values between `low` and `high` to the coordinates between `from` and `to`, with some room at both ends.
class PlotAxis {
public:
    PlotAxis(double low, double high, bool isLog, double from, double to) : isLog_(isLog), from_(from), to_(to) {
        if (isLog_) {
            low_ = std::log10(low), high_ = std::log10(high);
            const double room = std::max(0.04 * (high_ - low_), 0.06);
            low_ -= room, high_ += room;
        } else {
            const double room = std::max(0.06 * (high - low), 1e-9);
            low_ = low - room, high_ = high + room;
        }
    }
    /// The coordinate of a value.
    [[nodiscard]] double at(double value) const {
        RELIEF_CHECK((!isLog_ || value > 0));
        const double x = isLog_ ? std::log10(value) : value;
        return from_ + (x - low_) / (high_ - low_) * (to_ - from_);
    }
    /// About seven values at most: whole decades, or steps of 1, 2 and 5 where there are few decades.
    [[nodiscard]] std::vector<double> ticks() const {
        std::vector<double> all;
        if (!isLog_) {
            const double step = niceStep((high_ - low_) / 5);
            for (int i = int(std::ceil(low_ / step)); i * step <= high_; ++i) all.push_back(i * step);
            return all;
        }
        // The fewer decades, the more digits of each have a tick.
        const double decades = high_ - low_;
        const int every = std::max(1, int(std::ceil(decades / 7)));
        const std::vector<double> digits = decades > 2.2   ? std::vector<double>{1}
                                           : decades > 0.9 ? std::vector<double>{1, 2, 5}
                                                           : std::vector<double>{1, 1.5, 2, 3, 4, 5, 7};
        for (int power = int(std::floor(low_)); power <= int(std::ceil(high_)); ++power)
            for (const double digit : digits) {
                const double x = power + std::log10(digit);
                if (power % every == 0 && x >= low_ && x <= high_) all.push_back(digit * std::pow(10, power));
            }
        return all;
    }

private:
    static double niceStep(double rough) {
        const double unit = std::pow(10, std::floor(std::log10(rough)));
        for (const double digit : {1.0, 2.0, 5.0})
            if (rough <= digit * unit) return digit * unit;
        return 10 * unit;
    }

    bool isLog_;
    double from_, to_, low_ = 0, high_ = 1;
};

struct AxisRange {
    double low = INFINITY, high = -INFINITY;
    void add(double x) { low = std::min(low, x), high = std::max(high, x); }
};

std::string tracePath(const std::vector<dvec2>& points, const PlotAxis& x, const PlotAxis& y) {
    std::string path;
    for (const dvec2& p : points)
        path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x.at(p.x), y.at(p.y));
    return path;
}

/// The band between a line and its upper border.
std::string drawBand(const PlotLine& line, const PlotAxis& x, const PlotAxis& y) {
    std::vector<dvec2> border = line.points;
    border.insert(border.end(), line.upper.rbegin(), line.upper.rend());
    return fmt::format("<path class=\"band f{}\" d=\"{}Z\"/>", line.style.color, tracePath(border, x, y));
}

std::string drawLine(const PlotLine& line, const PlotAxis& x, const PlotAxis& y) {
    const auto stroke = [&](const std::vector<dvec2>& points, const char* more) {
        return fmt::format("<path class=\"line c{}{}\" stroke-dasharray=\"{}\" d=\"{}\"/>", line.style.color, more,
                           kDashes[line.style.dash], tracePath(points, x, y));
    };
    std::string svg = stroke(line.points, "");
    if (!line.upper.empty()) svg += stroke(line.upper, " thin");
    for (const dvec2& p : line.points) svg += drawMark(x.at(p.x), y.at(p.y), line.style);
    return svg;
}

std::string drawAxes(const Plot& plot, const PlotAxis& x, const PlotAxis& y) {
    std::string svg;
    for (const double tick : x.ticks())
        svg +=
            fmt::format("<path class=\"grid\" d=\"M{0:.1f} {1}V{2}\"/><text x=\"{0:.1f}\" y=\"{3}\" "
                        "text-anchor=\"middle\">{4}</text>",
                        x.at(tick), kTop, kHeight - kBottom, kHeight - kBottom + 16, formatNumber(tick, plot.xScale));
    for (const double tick : y.ticks())
        svg +=
            fmt::format("<path class=\"grid\" d=\"M{1} {0:.1f}H{2}\"/><text x=\"{3}\" y=\"{4:.1f}\" "
                        "text-anchor=\"end\">{5}</text>",
                        y.at(tick), kLeft, kWidth - kRight, kLeft - 6, y.at(tick) + 4, formatNumber(tick, plot.yScale));
    svg += fmt::format("<path class=\"axis\" d=\"M{} {}V{}H{}\"/>", kLeft, kTop, kHeight - kBottom, kWidth - kRight);
    svg += fmt::format("<text class=\"label\" x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>",
                       (kLeft + kWidth - kRight) / 2, kHeight - 8, escapeHtml(plot.xLabel));
    return svg;
}

std::string drawRule(const Plot& plot, const PlotAxis& y) {
    if (!plot.rule) return "";
    const double at = y.at(*plot.rule);
    const auto drawNote = [&](const std::string& text, double dy) {
        return text.empty() ? ""
                            : fmt::format("<text class=\"note\" x=\"{}\" y=\"{:.1f}\" text-anchor=\"end\">{}</text>",
                                          kWidth - kRight - 4, at + dy, escapeHtml(text));
    };
    return fmt::format("<rect class=\"loss\" x=\"{0}\" y=\"{1:.1f}\" width=\"{2}\" height=\"{3:.1f}\"/>"
                       "<path class=\"rule\" d=\"M{0} {1:.1f}h{2}\"/>",
                       kLeft, at, kWidth - kLeft - kRight, std::max(0.0, kHeight - kBottom - at)) +
           drawNote(plot.aboveRule, -6) + drawNote(plot.belowRule, 15);
}

std::string drawLegend(const Plot& plot) {
    std::string html = "<ul class=\"legend\">";
    for (const PlotLine& line : plot.lines)
        if (!line.points.empty())
            html += fmt::format("<li><svg viewBox=\"0 0 34 12\" aria-hidden=\"true\"><path class=\"line c{}\" "
                                "stroke-dasharray=\"{}\" d=\"M1 6H33\"/>{}</svg>{}</li>",
                                line.style.color, kDashes[line.style.dash], drawMark(17, 6, line.style),
                                escapeHtml(line.name));
    return html + "</ul>";
}

std::string formatShort(double value) { return fmt::format("{:.3g}", value); }

std::string scaleNumber(double value, std::initializer_list<std::pair<double, const char*>> units) {
    for (const auto& [unit, name] : units)
        if (std::abs(value) >= 0.9999 * unit) return formatShort(value / unit) + name;
    return formatShort(value);
}

} // namespace

std::string escapeHtml(const std::string& text) {
    std::string html;
    for (const char letter : text) {
        switch (letter) {
        case '&': html += "&amp;"; break;
        case '<': html += "&lt;"; break;
        case '>': html += "&gt;"; break;
        case '"': html += "&quot;"; break;
        default: html += letter;
        }
    }
    return html;
}

std::string formatNumber(double value, Scale scale) {
    switch (scale) {
    case Scale::bytes: return scaleNumber(value, {{1e9, " GB"}, {1e6, " MB"}, {1e3, " kB"}, {1, " B"}});
    case Scale::milliseconds: return scaleNumber(value, {{1e3, " s"}, {1, " ms"}, {1e-3, " µs"}});
    case Scale::nanoseconds: return scaleNumber(value, {{1e6, " ms"}, {1e3, " µs"}, {1, " ns"}});
    case Scale::percent: return fmt::format("{:.6g} %", 100 * value);
    case Scale::count: return scaleNumber(value, {{1e6, " M"}, {1e3, " k"}});
    case Scale::ratio: return formatShort(value) + " ×";
    case Scale::decibels: return formatShort(value) + " dB";
    }
    return "";
}

std::string drawFigure(const Plot& plot) {
    // The axes span all points of all lines.
    AxisRange xs, ys;
    for (const PlotLine& line : plot.lines)
        for (const auto* points : {&line.points, &line.upper})
            for (const dvec2& p : *points) xs.add(p.x), ys.add(p.y);
    if (!(xs.low <= xs.high)) return "";
    if (plot.rule) ys.add(*plot.rule * 0.8), ys.add(*plot.rule * 1.25); // room for the notes beside it
    const PlotAxis x(xs.low, xs.high, true, kLeft, kWidth - kRight);
    const PlotAxis y(ys.low, ys.high, plot.isYLog, kHeight - kBottom, kTop);
    // Later parts cover earlier ones: bands lie below all lines.
    std::string svg = drawRule(plot, y) + drawAxes(plot, x, y);
    for (const PlotLine& line : plot.lines)
        if (!line.points.empty() && !line.upper.empty()) svg += drawBand(line, x, y);
    for (const PlotLine& line : plot.lines)
        if (!line.points.empty()) svg += drawLine(line, x, y);
    return fmt::format(
        "<figure><figcaption><b>{}</b><span class=\"y\">{}</span></figcaption>"
        "<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">{}</svg>{}{}</figure>\n",
        escapeHtml(plot.title), escapeHtml(plot.yLabel), kWidth, kHeight, escapeHtml(plot.title + ": " + plot.yLabel),
        svg, drawLegend(plot), plot.caption.empty() ? "" : "<p class=\"caption\">" + escapeHtml(plot.caption) + "</p>");
}

} // namespace relief
