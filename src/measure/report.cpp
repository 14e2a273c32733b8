#include <algorithm>

#include "measure/goals.h"
#include "measure/page.h"

namespace relief {
namespace {

/// RFC 4648, section 4.
std::string base64(const std::string& bytes) {
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

std::string cellOf(const Value& value) {
    const Spread spread = spreadOf(value.samples);
    std::string text;
    if (value.unit == "bytes")
        text = wordOf(spread.median, Scale::bytes);
    else if (value.unit == "ms")
        text = wordOf(spread.median, Scale::milliseconds);
    else if (value.unit == "of the diagonal")
        text = wordOf(spread.median, Scale::percent);
    else if (spread.median >= 1e4)
        text = wordOf(spread.median, Scale::count);
    else
        text = fmt::format("{:.4g}{}", spread.median, value.unit == "dB" ? " dB" : "");
    if (value.unit == "of the diagonal") text = fmt::format("{:.2g} %", 100 * spread.median);
    if (value.samples.size() > 1 && value.unit == "ms")
        text += fmt::format(" <small>{:.3g}–{:.3g}</small>", spread.p5, spread.p95);
    return fmt::format("<td{}>{}</td>", value.origin == Origin::computed ? " class=\"computed\"" : "", text);
}

std::string goalTable(const std::vector<Goal>& goals) {
    std::string html = "<div class=\"scroll\"><table><tr><th class=\"words\">figure to reach</th><th>wanted</th>"
                       "<th>found</th><th></th></tr>";
    for (const Goal& goal : goals) {
        const bool hasReason = !goal.isMet() && !goal.reason.empty();
        html += fmt::format("<tr><td class=\"words\">{}<br><small>{}{}{}</small></td><td>{} {:.4g}{}</td>"
                            "<td>{:.3g}{}</td><td class=\"{}\">{}</td></tr>",
                            escaped(goal.what), escaped(goal.scene), hasReason ? "<br>" : "",
                            hasReason ? escaped(goal.reason) : "", goal.isAtLeast ? "≥" : "≤", goal.wanted, goal.unit,
                            goal.found, goal.unit, goal.isMet() ? "good" : "bad", goal.isMet() ? "met" : "missed");
    }
    return html + "</table></div>";
}

std::string keyTable(const Results& results) {
    std::string html = "<div class=\"scroll\"><table>";
    for (const auto& [name, part] : {std::pair("program", &results.program), std::pair("machine", &results.machine),
                                     std::pair("device", &results.device), std::pair("settings", &results.settings)})
        for (const auto& [key, value] : *part)
            html +=
                fmt::format("<tr><td>{}: {}</td><td class=\"words\">{}</td></tr>", name, escaped(key), escaped(value));
    return html + "</table></div>";
}

/// Every table of a suite, a scene and an axis each.
std::string tablesOf(const Results& results, const std::string& suite) {
    std::string html;
    std::vector<std::pair<std::string, std::string>> kinds;
    for (const Row& row : results.rows)
        if (row.suite == suite && std::ranges::find(kinds, std::pair(row.scene, row.axis)) == kinds.end())
            kinds.emplace_back(row.scene, row.axis);
    for (const auto& [scene, axis] : kinds) {
        std::vector<const Row*> rows = rowsOf(results, suite, axis);
        std::erase_if(rows, [&, s = scene](const Row* row) { return row->scene != s; });
        html += "<p class=\"soft\">" + escaped(scene) + "</p>" + tableOfRows(rows);
    }
    return html;
}

std::string section(const Results& results, const char* suite, const char* title, const std::string& words,
                    const std::string& figures, bool isFolded) {
    const std::string tables = tablesOf(results, suite);
    if (tables.empty()) return "";
    return fmt::format("<h2>{}</h2><p>{}</p>\n{}{}{}{}\n", title, words, figures,
                       isFolded ? "<details><summary>all numbers</summary>" : "", tables, isFolded ? "</details>" : "");
}

std::string pictureStrip(const Results& results) {
    if (results.pictures.empty()) return "";
    std::string html = "<h2>Both sides, and what differs</h2><p>The same view of both at the same RMS distance to the "
                       "reference; the difference eight times as strong.</p>";
    const auto picture = [](const std::string& png, const std::string& words) {
        return fmt::format("<div><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><p>{0}</p></div>", escaped(words),
                           base64(png));
    };
    for (const PicturePair& pair : results.pictures)
        html += fmt::format("<p class=\"soft\">{}, {}</p><div class=\"strip\">{}{}{}</div>\n", escaped(pair.scene),
                            escaped(pair.title), picture(pair.leftPng, pair.left), picture(pair.rightPng, pair.right),
                            picture(pair.differencePng, "difference × 8"));
    return html;
}

std::string notesOf(const Results& results) {
    if (results.notes.empty()) return "";
    std::string html = "<h2>What is not here</h2><ul class=\"words\">";
    for (const std::string& note : results.notes) html += "<li>" + escaped(note) + "</li>";
    return html + "</ul>";
}

std::string wordOfDevice(const Results& results, const char* key) {
    const auto found = results.device.find(key);
    return found == results.device.end() ? "" : escaped(found->second);
}

} // namespace

std::string tableOfRows(std::span<const Row* const> rows) {
    std::vector<std::string> columns;
    for (const Row* row : rows)
        for (const Value& value : row->values)
            if (std::ranges::find(columns, value.name) == columns.end()) columns.push_back(value.name);
    const std::string& axis = rows.front()->axis;
    std::string html = "<div class=\"scroll\"><table><tr><th class=\"words\">contestant</th>";
    if (!axis.empty()) html += "<th>" + escaped(axis) + "</th>";
    for (const std::string& name : columns) html += "<th>" + escaped(name) + "</th>";
    html += "</tr>";
    for (const Row* row : rows) {
        html += "<tr><td>" + escaped(row->contestant) + "</td>";
        if (axis == "tolerance")
            html += fmt::format("<td>{}</td>", wordOf(row->at, Scale::percent));
        else if (!axis.empty())
            html += fmt::format("<td>{}</td>", wordOf(row->at, Scale::count));
        for (const std::string& name : columns)
            html += row->find(name) != nullptr ? cellOf(*row->find(name)) : "<td></td>";
        html += "</tr>";
    }
    return html + "</table></div>\n";
}

std::string reportOf(const Results& results) {
    const std::vector<Goal> goals = goalsOf(results);
    std::string html = "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                       "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">"
                       "<link rel=\"icon\" href=\"data:,\"><title>relief bench</title><style>" +
                       styleSheet() + "</style></head><body>\n<h1>What displacement saves, and where it loses</h1>\n";
    html += fmt::format("<p class=\"soft\">A cage and a height map against dense meshes of the same error, on {} ({}). "
                        "Numbers marked ∗ follow by arithmetic from what was measured; all others were measured.</p>\n",
                        wordOfDevice(results, "name"), wordOfDevice(results, "driver"));
    if (const auto quick = results.settings.find("quick"); quick != results.settings.end() && quick->second == "yes")
        html +=
            "<p class=\"bad\">A quick run: small meshes and few rounds. Good for a first look, not for figures.</p>";
    if (!goals.empty()) html += "<h2>Figures to reach</h2>" + goalTable(goals);
    html +=
        section(results, "bandwidth", "Bytes at equal error",
                "Every contestant is made as small as it can be while it stays within a tolerance of the reference.",
                bandwidthFigures(results), true);
    html += pictureStrip(results);
    html +=
        section(results, "scaling", "Break-even",
                "Above the line the displaced surface takes less than the dense mesh of the same triangles, below it "
                "more.",
                breakEvenFigures(results) + "<h2>Against the number of triangles</h2>" + scalingFigures(results), true);
    html += section(results, "frame", "A frame of a million triangles", "Passes as the device timed them.", "", false);
    html +=
        section(results, "animate", "Animation", "What a new pose sends to the device.", animateFigures(results), true);
    html += section(
        results, "memory", "Memory",
        "The buffers that one frame of ten million triangles lists, and the most resident memory of the process "
        "that draws it, beside the same process with one segment an edge. With a CPU driver that is the "
        "driver's memory, too: lavapipe keeps the triangles that it has binned and not yet drawn.",
        "", false);
    html += section(results, "startup", "Starting up", "A whole relief render of a process of its own.", "", false);
    html += "<h2>What the numbers assume</h2>" + assumptions() + notesOf(results);
    html += "<h2>This run</h2>" + keyTable(results) + "</body></html>\n";
    return html;
}

} // namespace relief
