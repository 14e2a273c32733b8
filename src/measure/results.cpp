#include "measure/results.h"

#include <algorithm>
#include <cmath>

namespace relief {
namespace {

/// A percentile, interpolated between neighbours of sorted samples (Hyndman and Fan 1996, definition 7).
double interpolateQuantile(const std::vector<double>& sorted, double fraction) {
    RELIEF_CHECK(!sorted.empty());
    const double rank = fraction * double(sorted.size() - 1);
    const auto lower = std::size_t(rank);
    const std::size_t upper = std::min(lower + 1, sorted.size() - 1);
    return std::lerp(sorted[lower], sorted[upper], rank - double(lower));
}

} // namespace

Spread computeSpread(std::vector<double> samples) {
    if (samples.empty()) return {};
    std::ranges::sort(samples);
    return {.median = interpolateQuantile(samples, 0.5),
            .p5 = interpolateQuantile(samples, 0.05),
            .p95 = interpolateQuantile(samples, 0.95)};
}

const Value* Row::find(Metric metric) const {
    const auto found = std::ranges::find(values, metric, &Value::metric);
    return found == values.end() ? nullptr : &*found;
}

double Row::get(Metric metric, double otherwise) const {
    const Value* value = find(metric);
    return value != nullptr ? value->median() : otherwise;
}

void Row::addMeasured(Metric metric, double sample) { addMeasured(metric, std::vector{sample}); }

void Row::addMeasured(Metric metric, std::vector<double> samples) {
    RELIEF_CHECK(find(metric) == nullptr); // of two values only the first would be found
    RELIEF_CHECK(!samples.empty());
    values.push_back({metric, Origin::measured, std::move(samples)});
}

void Row::addComputed(Metric metric, double sample) {
    RELIEF_CHECK(find(metric) == nullptr);
    values.push_back({metric, Origin::computed, {sample}});
}

namespace {

/// Identifies a row within its results: rows of two results with equal keys are compared.
std::string makeKey(const Row& row) {
    return fmt::format("{} / {} / {}{}", toWord(row.suite), row.scene, toWord(row.method),
                       row.axis == Axis::none ? "" : fmt::format(" / {} {:g}", toWord(row.axis), row.at));
}

/// Times of frames and bytes: what should not grow.
bool isCost(Metric metric) {
    const Unit unit = describe(metric).unit;
    return unit == Unit::milliseconds || unit == Unit::bytes;
}

double divide(double a, double b) { return b > 0 ? a / b : a > 0 ? INFINITY : 1; }

Change makeChange(const Row& row, const Value& before, const Value& after, double tolerance) {
    const Spread a = computeSpread(before.samples), b = computeSpread(after.samples);
    Change change{row.suite, row.scene, row.method, row.axis, before.metric, row.at, a.median, b.median};
    change.ratio = divide(b.median, a.median);
    change.low = divide(b.p5, a.p95);
    change.high = divide(b.p95, a.p5);
    change.isRegression = change.ratio > 1 + tolerance && change.low > 1;
    return change;
}

void warnOfDifferences(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b,
                       const char* what, std::vector<std::string>& warnings) {
    for (const auto& [key, value] : a)
        if (const auto found = b.find(key); found != b.end() && found->second != value)
            warnings.push_back(fmt::format("{} {}: {} before, {} after", what, key, value, found->second));
}

} // namespace

bool Comparison::hasRegression() const { return std::ranges::any_of(changes, &Change::isRegression); }

Comparison compareResults(const Results& before, const Results& after, double tolerance) {
    Comparison comparison;
    // Differences of machine and settings explain changes: they are no changes of their own.
    warnOfDifferences(before.machine, after.machine, "machine", comparison.warnings);
    warnOfDifferences(before.device, after.device, "device", comparison.warnings);
    warnOfDifferences(before.settings, after.settings, "settings", comparison.warnings);

    // Each row of `before` takes its partner out of `after`: what is left there has none.
    std::map<std::string, const Row*> partners;
    for (const Row& row : after.rows) partners[makeKey(row)] = &row;
    for (const Row& row : before.rows) {
        const auto found = partners.find(makeKey(row));
        if (found == partners.end()) {
            comparison.onlyInOne.push_back(makeKey(row));
            continue;
        }
        for (const Value& value : row.values)
            if (const Value* other = found->second->find(value.metric); other != nullptr && isCost(value.metric))
                comparison.changes.push_back(makeChange(row, value, *other, tolerance));
        partners.erase(found);
    }
    for (const auto& [key, row] : partners) comparison.onlyInOne.push_back(key);
    return comparison;
}

} // namespace relief
