#include <algorithm>

#include "measure/page.h"

namespace relief {
namespace {

bool isTime(Unit unit) { return unit == Unit::milliseconds || unit == Unit::microseconds || unit == Unit::nanoseconds; }

std::string formatCell(const Value& value) {
    const Spread spread = computeSpread(value.samples);
    const Unit unit = describe(value.metric).unit;
    if (unit == Unit::bytes) return humanBytes(std::uint64_t(spread.median));
    if (unit == Unit::milliseconds)
        return value.samples.size() > 1 ? fmt::format("{:.1f} ({:.1f}-{:.1f})", spread.median, spread.p5, spread.p95)
                                        : fmt::format("{:.1f}", spread.median);
    if (spread.median >= 1e4) return fmt::format("{:.0f}", spread.median);
    return fmt::format("{:.4g}", spread.median);
}

/// Lays lines out in columns as wide as their widest cell; all but the first are flush right.
std::string alignColumns(const std::vector<std::vector<std::string>>& lines) {
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

std::string makeTextTable(std::span<const Row* const> rows) {
    const std::vector<Metric> columns = listMetrics(rows);
    std::vector<std::vector<std::string>> lines{{toWord(rows.front()->axis), "method"}};
    for (const Metric metric : columns) {
        const MetricInfo& info = describe(metric);
        lines[0].push_back(isTime(info.unit) ? fmt::format("{}, {}", info.name, toWord(info.unit)) : info.name);
    }
    for (const Row* row : rows) {
        std::vector<std::string> line{row->axis == Axis::none ? "" : fmt::format("{:g}", row->at), toWord(row->method)};
        for (const Metric metric : columns)
            line.push_back(row->find(metric) != nullptr ? formatCell(*row->find(metric)) : "");
        lines.push_back(line);
    }
    return alignColumns(lines);
}

} // namespace

std::string toTable(const Results& results, std::span<const Goal> goals) {
    std::string text;
    for (const auto* part : {&results.program, &results.machine, &results.device, &results.settings})
        for (const auto& [key, value] : *part) text += fmt::format("{:28} {}\n", key, value);

    // Neighbouring rows of one suite, scene and axis share a table.
    std::vector<const Row*> rows;
    for (std::size_t i = 0; i < results.rows.size(); ++i) {
        const Row &row = results.rows[i], &next = results.rows[std::min(i + 1, results.rows.size() - 1)];
        rows.push_back(&row);
        const bool isLast =
            &row == &next || next.suite != row.suite || next.scene != row.scene || next.axis != row.axis;
        if (!isLast) continue;
        text += fmt::format("\n{}: {}\n{}", toWord(row.suite), row.scene, makeTextTable(rows));
        rows.clear();
    }

    // Notes and goals, a line each.
    if (!results.notes.empty()) text += '\n';
    for (const std::string& note : results.notes) text += "note: " + note + '\n';
    const std::vector<GoalResult> evaluated = evaluateGoals(goals, results);
    if (!evaluated.empty()) text += '\n';
    for (const GoalResult& result : evaluated)
        text += fmt::format("goal {}: {}, wanted {} {}: {} ({})\n", result.isMet() ? "met" : "missed",
                            formatGoal(result.goal, result.found), result.goal.isAtLeast ? "at least" : "at most",
                            formatGoal(result.goal, result.goal.value), result.goal.name, result.scene);
    return text;
}

} // namespace relief
