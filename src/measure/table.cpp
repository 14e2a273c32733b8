#include <algorithm>

#include "measure/parts.h"

namespace relief {
namespace {

std::string wordsOf(const Value& value) {
    const Spread spread = spreadOf(value.samples);
    if (value.unit == "bytes") return humanBytes(std::uint64_t(spread.median));
    if (value.unit == "ms")
        return value.samples.size() > 1 ? fmt::format("{:.1f} ({:.1f}-{:.1f})", spread.median, spread.p5, spread.p95)
                                        : fmt::format("{:.1f}", spread.median);
    if (spread.median >= 1e4) return fmt::format("{:.0f}", spread.median);
    return fmt::format("{:.4g}", spread.median);
}

/// Names of the values of rows that stand below each other, in order of appearance.
std::vector<std::string> columnsOf(std::span<const Row> rows) {
    std::vector<std::string> names;
    for (const Row& row : rows)
        for (const Value& value : row.values)
            if (std::ranges::find(names, value.name) == names.end()) names.push_back(value.name);
    return names;
}

/// Columns as wide as their widest cell.
std::string aligned(const std::vector<std::vector<std::string>>& lines) {
    std::vector<std::size_t> widths;
    for (const auto& line : lines) {
        widths.resize(std::max(widths.size(), line.size()));
        for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
    }
    std::string text;
    for (const auto& line : lines) {
        std::string row;
        for (std::size_t i = 0; i < line.size(); ++i)
            row += i == 0 ? fmt::format("{:{}}", line[i], widths[i]) : fmt::format("  {:>{}}", line[i], widths[i]);
        text += row.substr(0, row.find_last_not_of(' ') + 1) + '\n';
    }
    return text;
}

std::string tableOfRows(std::span<const Row> rows) {
    const std::vector<std::string> columns = columnsOf(rows);
    std::vector<std::vector<std::string>> lines{{rows.front().axis, "contestant"}};
    for (const std::string& name : columns) {
        const auto row = std::ranges::find_if(rows, [&](const Row& r) { return r.find(name) != nullptr; });
        const std::string& unit = row->find(name)->unit;
        const bool isTime = unit == "ms" || unit == "ns" || unit == "us";
        lines[0].push_back(isTime ? fmt::format("{}, {}", name, unit) : name);
    }
    for (const Row& row : rows) {
        std::vector<std::string> line{row.axis.empty() ? "" : fmt::format("{:g}", row.at), row.contestant};
        for (const std::string& name : columns)
            line.push_back(row.find(name) != nullptr ? wordsOf(*row.find(name)) : "");
        lines.push_back(line);
    }
    return aligned(lines);
}

} // namespace

std::string tableOf(const Results& results) {
    std::string text;
    for (const auto* part : {&results.program, &results.machine, &results.device, &results.settings})
        for (const auto& [key, value] : *part) text += fmt::format("{:28} {}\n", key, value);
    for (std::size_t first = 0, end = 0; first < results.rows.size(); first = end) {
        const Row& like = results.rows[first];
        while (end < results.rows.size() && results.rows[end].suite == like.suite &&
               results.rows[end].scene == like.scene && results.rows[end].axis == like.axis)
            ++end;
        text += fmt::format("\n{}: {}\n", like.suite, like.scene);
        text += tableOfRows(std::span(results.rows).subspan(first, end - first));
    }
    if (!results.notes.empty()) text += '\n';
    for (const std::string& note : results.notes) text += "note: " + note + '\n';
    return text;
}

} // namespace relief
