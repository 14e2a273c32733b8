#include <algorithm>

#include "measure/page.h"

namespace relief {
namespace {

/// RFC 4648, section 4.
std::string toBase64(const std::string& bytes) {
    static constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t bits = 0;
        for (std::size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < bytes.size() ? std::uint8_t(bytes[i + k]) : 0u);
        for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : kLetters[bits >> (18 - 6 * k) & 63];
    }
    return text;
}

std::string makeCell(const Value& value) {
    const Spread spread = computeSpread(value.samples);
    const Unit unit = describe(value.metric).unit;
    std::string text;
    switch (unit) {
    case Unit::bytes: text = formatNumber(spread.median, Scale::bytes); break;
    case Unit::milliseconds: text = formatNumber(spread.median, Scale::milliseconds); break;
    case Unit::diagonal: text = fmt::format("{:.2g} %", 100 * spread.median); break;
    case Unit::decibels: text = fmt::format("{:.4g} dB", spread.median); break;
    default:
        text = spread.median >= 1e4 ? formatNumber(spread.median, Scale::count) : fmt::format("{:.4g}", spread.median);
    }
    if (value.samples.size() > 1 && unit == Unit::milliseconds)
        text += fmt::format(" <small>{:.3g}–{:.3g}</small>", spread.p5, spread.p95);
    return fmt::format("<td{}>{}</td>", value.origin == Origin::computed ? " class=\"computed\"" : "", text);
}

std::string makeGoalTable(const std::vector<GoalResult>& results) {
    if (results.empty()) return "";
    std::string html = "<h2>Figures to reach</h2><div class=\"scroll\"><table><tr><th class=\"words\">figure</th>"
                       "<th>wanted</th><th>found</th><th></th></tr>";
    for (const GoalResult& result : results) {
        const Goal& goal = result.goal;
        const bool hasReason = !result.isMet() && !goal.reason.empty();
        html += fmt::format("<tr><td class=\"words\">{}<br><small>{}{}{}</small></td><td>{} {}</td><td>{}</td>"
                            "<td class=\"{}\">{}</td></tr>",
                            escapeHtml(goal.name), escapeHtml(result.scene), hasReason ? "<br>" : "",
                            hasReason ? escapeHtml(goal.reason) : "", goal.isAtLeast ? "≥" : "≤",
                            formatGoal(goal, goal.value), formatGoal(goal, result.found),
                            result.isMet() ? "good" : "bad", result.isMet() ? "met" : "missed");
    }
    return html + "</table></div>";
}

/// The meaning of every metric that the results have.
std::string makeMetricList(const Results& results) {
    std::vector<const Row*> rows;
    for (const Row& row : results.rows) rows.push_back(&row);
    std::string html = "<ul class=\"words\">";
    for (const Metric metric : listMetrics(rows))
        html += fmt::format("<li><b>{}.</b> {}</li>", escapeHtml(describe(metric).name),
                            escapeHtml(describe(metric).meaning));
    return html + "</ul>";
}

std::string makeKeyTable(const Results& results) {
    std::string html = "<div class=\"scroll\"><table>";
    for (const auto& [name, part] : {std::pair("program", &results.program), std::pair("machine", &results.machine),
                                     std::pair("device", &results.device), std::pair("settings", &results.settings)})
        for (const auto& [key, value] : *part)
            html += fmt::format("<tr><td>{}: {}</td><td class=\"words\">{}</td></tr>", name, escapeHtml(key),
                                escapeHtml(value));
    return html + "</table></div>";
}

/// The tables of a suite, one per scene and axis, in order of appearance.
std::string makeTables(const Results& results, Suite suite) {
    std::vector<std::pair<std::string, Axis>> kinds;
    for (const Row& row : results.rows)
        if (row.suite == suite && std::ranges::find(kinds, std::pair(row.scene, row.axis)) == kinds.end())
            kinds.emplace_back(row.scene, row.axis);
    std::string html;
    for (const auto& [scene, axis] : kinds)
        html += "<p class=\"soft\">" + escapeHtml(scene) + "</p>" +
                makeHtmlTable(selectScene(selectRows(results, suite, axis), scene));
    return html;
}

/// The part of the report about one suite: texts in HTML.
struct Section {
    Suite suite;
    const char* title;
    const char* introduction;
    std::string figures;
};

/// Makes the section of a suite; empty where it did not run. Tables are folded away where there are figures.
std::string makeSection(const Results& results, const Section& section) {
    const std::string tables = makeTables(results, section.suite);
    if (tables.empty()) return "";
    const bool isFolded = !section.figures.empty();
    return fmt::format("<h2>{}</h2><p>{}</p>\n{}{}{}{}\n", section.title, section.introduction, section.figures,
                       isFolded ? "<details><summary>all numbers</summary>" : "", tables, isFolded ? "</details>" : "");
}

std::string makePictureStrip(const Results& results) {
    if (results.pictures.empty()) return "";
    std::string html =
        "<h2>Pictures at equal error</h2><p>The same view of two methods at the same RMS distance to the "
        "reference, and their difference times eight.</p>";
    const auto picture = [](const std::string& png, const std::string& caption) {
        return fmt::format("<div><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><p>{0}</p></div>",
                           escapeHtml(caption), toBase64(png));
    };
    for (const PicturePair& pair : results.pictures)
        html += fmt::format("<p class=\"soft\">{}, {}</p><div class=\"strip\">{}{}{}</div>\n", escapeHtml(pair.scene),
                            escapeHtml(pair.title), picture(pair.leftPng, pair.left),
                            picture(pair.rightPng, pair.right), picture(pair.differencePng, "difference × 8"));
    return html;
}

std::string makeNotes(const Results& results) {
    if (results.notes.empty()) return "";
    std::string html = "<h2>What is not here</h2><ul class=\"words\">";
    for (const std::string& note : results.notes) html += "<li>" + escapeHtml(note) + "</li>";
    return html + "</ul>";
}

std::string describeDevice(const Results& results, const char* key) {
    const auto found = results.device.find(key);
    return found == results.device.end() ? "" : escapeHtml(found->second);
}

} // namespace

std::string makeHtmlTable(std::span<const Row* const> rows) {
    const std::vector<Metric> columns = listMetrics(rows);
    const Axis axis = rows.front()->axis;
    std::string html = "<div class=\"scroll\"><table><tr><th class=\"words\">method</th>";
    if (axis != Axis::none) html += fmt::format("<th>{}</th>", toWord(axis));
    for (const Metric metric : columns)
        html += fmt::format("<th title=\"{}\">{}</th>", escapeHtml(describe(metric).meaning),
                            escapeHtml(describe(metric).name));
    html += "</tr>";
    for (const Row* row : rows) {
        html += fmt::format("<tr><td>{}</td>", escapeHtml(toWord(row->method)));
        if (axis != Axis::none)
            html += fmt::format("<td>{}</td>",
                                formatNumber(row->at, axis == Axis::tolerance ? Scale::percent : Scale::count));
        for (const Metric metric : columns)
            html += row->find(metric) != nullptr ? makeCell(*row->find(metric)) : "<td></td>";
        html += "</tr>";
    }
    return html + "</table></div>\n";
}

std::string makeReport(const Results& results, std::span<const Goal> goals) {
    // Head and introduction.
    std::string html = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
                       "<link rel=\"icon\" href=\"data:,\"><title>relief bench</title><style>" +
                       styleSheet() + "</style></head><body>\n<h1>What displacement saves, and where it loses</h1>\n";
    html += fmt::format("<p class=\"soft\">A cage and a height map compared with dense meshes of the same error, on {} "
                        "({}). Numbers marked ∗ are computed from measured ones; all others were measured.</p>\n",
                        describeDevice(results, "name"), describeDevice(results, "driver"));
    if (const auto quick = results.settings.find("quick"); quick != results.settings.end() && quick->second == "yes")
        html += "<p class=\"bad\">A quick run: small meshes and few rounds. Good for a first look, not for figures to "
                "quote.</p>";
    html += makeGoalTable(evaluateGoals(goals, results));

    // The suites, the most telling first.
    html += makeSection(results, {Suite::bandwidth, "Bytes at equal error",
                                  "Each method is made as small as it can be within a tolerance of the reference.",
                                  drawBandwidthFigures(results)});
    html += makePictureStrip(results);
    html += makeSection(
        results,
        {Suite::scaling, "Break-even",
         "Above the line the displaced surface takes less than the dense mesh of the same triangles, below it more.",
         drawBreakEvenFigures(results) + "<h2>Against the number of triangles</h2>" + drawScalingFigures(results)});
    html +=
        makeSection(results, {Suite::frame, "A frame of a million triangles", "Passes as the device timed them.", ""});
    html += makeSection(
        results, {Suite::animate, "Animation", "What a new pose sends to the device.", drawAnimateFigures(results)});
    html += makeSection(results, {Suite::detail, "Displacement, bump, and both",
                                  "What heights cost as geometry and as bent normals, and how near each comes to "
                                  "displacement with segments of a quarter of a pixel.",
                                  drawDetailFigures(results)});
    html += makeSection(results, {Suite::light, "Light", "One picture in several lights and shadings.", ""});
    html += makeSection(
        results,
        {Suite::memory, "Memory",
         "The buffers of one frame of ten million triangles, and the peak memory of the process that draws it, "
         "beside the same process with one segment per edge. A driver on the processor has its memory there, "
         "too: lavapipe keeps the triangles that it has binned and not yet drawn.",
         ""});
    html += makeSection(results, {Suite::startup, "Starting up", "A whole relief render in a process of its own.", ""});

    // How to read the numbers, and where they come from.
    html += "<h2>Metrics</h2>" + makeMetricList(results);
    html += "<h2>What the numbers assume</h2>" + describeAssumptions() + makeNotes(results);
    html += "<h2>This run</h2>" + makeKeyTable(results) + "</body></html>\n";
    return html;
}

} // namespace relief
