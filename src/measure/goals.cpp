// {"schema": "relief-goals", "version": 1,
//  "goals": [{"name", "metric",
//             "subject": {"suite", "axis", "from", "to", "methods": [...], "divided by": [...], "statistic"},
//             "comparison": "at least" or "at most", "value", "reason"}]}
// "axis", "from", "to", "divided by" and "reason" may be missing. "statistic": "at smallest", "at largest",
// "deviation".
#include <algorithm>
#include <cmath>
#include <set>

#include <nlohmann/json.hpp>

#include "measure/page.h"
#include "measure/words.h"

namespace relief {
namespace {

using GoalJson = nlohmann::json;

constexpr const char* kGoalSchema = "relief-goals";
constexpr int kGoalVersion = 1;

/// A misspelt key would be a goal that nobody checks.
void checkKeys(const GoalJson& object, const std::set<std::string>& known) {
    if (!object.is_object()) throw std::invalid_argument(fmt::format("{} is no object", object.dump()));
    for (const auto& [key, value] : object.items())
        if (!known.contains(key)) throw std::invalid_argument(fmt::format("unknown key \"{}\"", key));
}

std::vector<Method> readMethods(const GoalJson& subject, const char* key) {
    std::vector<Method> methods;
    for (const GoalJson& word : subject.value(key, GoalJson::array()))
        parseWord(word.get<std::string>(), methods.emplace_back());
    return methods;
}

Statistic readStatistic(const std::string& word) {
    if (word == "at smallest") return Statistic::atSmallest;
    if (word == "at largest") return Statistic::atLargest;
    if (word == "deviation") return Statistic::deviation;
    throw std::invalid_argument(fmt::format("\"{}\" is no statistic: at smallest, at largest, deviation", word));
}

GoalSubject readSubject(const GoalJson& from) {
    checkKeys(from, {"suite", "axis", "from", "to", "methods", "divided by", "statistic"});
    GoalSubject subject;
    parseWord(from.at("suite").get<std::string>(), subject.suite);
    parseWord(from.value("axis", std::string()), subject.axis);
    subject.from = from.value("from", subject.from);
    subject.to = from.value("to", subject.to);
    subject.methods = readMethods(from, "methods");
    subject.dividedBy = readMethods(from, "divided by");
    subject.statistic = readStatistic(from.at("statistic"));
    if (subject.methods.empty()) throw std::invalid_argument("\"methods\" names no method");
    if (subject.statistic == Statistic::deviation && !subject.dividedBy.empty())
        throw std::invalid_argument("a deviation is not divided by another method's");
    return subject;
}

Goal readGoal(const GoalJson& from) {
    checkKeys(from, {"name", "metric", "subject", "comparison", "value", "reason"});
    Goal goal;
    goal.name = from.at("name");
    parseWord(from.at("metric").get<std::string>(), goal.metric);
    goal.subject = readSubject(from.at("subject"));
    const std::string comparison = from.at("comparison");
    if (comparison != "at least" && comparison != "at most")
        throw std::invalid_argument(
            fmt::format("comparison \"{}\" is neither \"at least\" nor \"at most\"", comparison));
    goal.isAtLeast = comparison == "at least";
    goal.value = from.at("value");
    goal.reason = from.value("reason", std::string());
    return goal;
}

// --- evaluation

bool contains(const std::vector<Method>& methods, Method method) {
    return std::ranges::find(methods, method) != methods.end();
}

/// The smallest value of a metric among methods, at the smallest or largest point where any of the rows has the metric.
std::optional<double> findValue(std::span<const Row* const> rows, const std::vector<Method>& methods,
                                const Goal& goal) {
    const bool isSmallest = goal.subject.statistic == Statistic::atSmallest;
    // The smallest point is that of all methods: a method that does not reach the tightest tolerance has no value.
    std::optional<double> at;
    for (const Row* row : rows)
        if (row->find(goal.metric) != nullptr && (isSmallest || contains(methods, row->method)))
            at = !at ? row->at : isSmallest ? std::min(*at, row->at) : std::max(*at, row->at);
    std::optional<double> least;
    for (const Row* row : rows)
        if (row->at == at && contains(methods, row->method) && row->find(goal.metric) != nullptr)
            least = least ? std::min(*least, row->get(goal.metric)) : row->get(goal.metric);
    return least;
}

std::optional<double> findDeviation(std::span<const Row* const> rows, const Goal& goal) {
    std::vector<double> values;
    for (const Row* row : rows)
        if (contains(goal.subject.methods, row->method) && row->find(goal.metric) != nullptr)
            values.push_back(row->get(goal.metric));
    if (values.size() < 2) return std::nullopt;
    const auto [low, high] = std::ranges::minmax(values);
    return (high - low) / (high + low);
}

std::optional<double> evaluate(const Goal& goal, std::vector<const Row*> rows) {
    std::erase_if(rows, [&](const Row* row) { return row->at < goal.subject.from || row->at > goal.subject.to; });
    if (goal.subject.statistic == Statistic::deviation) return findDeviation(rows, goal);
    const std::optional<double> value = findValue(rows, goal.subject.methods, goal);
    if (goal.subject.dividedBy.empty() || !value) return value;
    const std::optional<double> divisor = findValue(rows, goal.subject.dividedBy, goal);
    if (!divisor || !(*divisor > 0)) return std::nullopt;
    return *value / *divisor;
}

} // namespace

std::vector<Goal> parseGoals(const std::string& text, const std::string& name) {
    std::string place; // of an error: the goal being read
    try {
        const GoalJson all = GoalJson::parse(text);
        if (!all.is_object() || all.value("schema", GoalJson()) != kGoalSchema)
            fail(Failure::input, "{}: these are no goals (\"schema\" is not \"{}\")", name, kGoalSchema);
        if (all.at("version") != kGoalVersion)
            fail(Failure::input, "{}: version {} of the goals is not read; this relief reads {}", name,
                 all.at("version").dump(), kGoalVersion);
        checkKeys(all, {"schema", "version", "goals"});
        // Errors from here on name the goal by its number.
        std::vector<Goal> goals;
        for (const GoalJson& goal : all.at("goals")) {
            place = fmt::format("goal {}: ", goals.size());
            goals.push_back(readGoal(goal));
        }
        return goals;
    } catch (const GoalJson::exception& error) {
        fail(Failure::input, "{}: {}{}", name, place, error.what());
    } catch (const std::invalid_argument& error) {
        fail(Failure::input, "{}: {}{}", name, place, error.what());
    }
}

std::vector<GoalResult> evaluateGoals(std::span<const Goal> goals, const Results& results) {
    std::vector<GoalResult> all;
    for (const Goal& goal : goals)
        for (const std::string& scene : listScenes(results, goal.subject.suite)) {
            const auto rows = selectScene(selectRows(results, goal.subject.suite, goal.subject.axis), scene);
            if (const std::optional<double> found = evaluate(goal, rows)) all.push_back({goal, scene, *found});
        }
    return all;
}

std::string formatGoal(const Goal& goal, double figure) {
    if (goal.subject.statistic == Statistic::deviation) return fmt::format("{:.3g} %", 100 * figure);
    const Unit unit = describe(goal.metric).unit;
    if (!goal.subject.dividedBy.empty() || unit == Unit::ratio) return formatNumber(figure, Scale::ratio);
    if (unit == Unit::bytes) return formatNumber(figure, Scale::bytes);
    const std::string word = toWord(unit);
    return fmt::format("{:.3g}{}{}", figure, word.empty() ? "" : " ", word);
}

std::vector<const Row*> selectRows(const Results& results, Suite suite, Axis axis) {
    std::vector<const Row*> rows;
    for (const Row& row : results.rows)
        if (row.suite == suite && row.axis == axis) rows.push_back(&row);
    return rows;
}

std::vector<const Row*> selectScene(std::vector<const Row*> rows, const std::string& scene) {
    std::erase_if(rows, [&](const Row* row) { return row->scene != scene; });
    return rows;
}

std::vector<std::string> listScenes(const Results& results, Suite suite) {
    std::vector<std::string> scenes;
    for (const Row& row : results.rows)
        if (row.suite == suite && std::ranges::find(scenes, row.scene) == scenes.end()) scenes.push_back(row.scene);
    return scenes;
}

std::vector<Metric> listMetrics(std::span<const Row* const> rows) {
    std::vector<Metric> metrics;
    for (const Row* row : rows)
        for (const Value& value : row->values)
            if (std::ranges::find(metrics, value.metric) == metrics.end()) metrics.push_back(value.metric);
    return metrics;
}

} // namespace relief
