#include <algorithm>
#include <cmath>

#include "measure/measure.h"

namespace relief {
namespace {

/// Between neighbours of sorted samples (Hyndman and Fan 1996, definition 7).
double quantile(const std::vector<double>& sorted, double share) {
    const double place = share * double(sorted.size() - 1);
    const auto lower = std::size_t(place);
    const std::size_t upper = std::min(lower + 1, sorted.size() - 1);
    return std::lerp(sorted[lower], sorted[upper], place - double(lower));
}

} // namespace

Spread spreadOf(std::vector<double> samples) {
    if (samples.empty()) return {};
    std::ranges::sort(samples);
    return {.median = quantile(samples, 0.5), .p5 = quantile(samples, 0.05), .p95 = quantile(samples, 0.95)};
}

const Value* Row::find(const std::string& name) const {
    const auto found = std::ranges::find(values, name, &Value::name);
    return found == values.end() ? nullptr : &*found;
}

double Row::get(const std::string& name, double otherwise) const {
    const Value* value = find(name);
    return value != nullptr ? value->median() : otherwise;
}

void Row::add(const std::string& name, const std::string& unit, Origin origin, double sample) {
    values.push_back({name, unit, origin, {sample}});
}

void Row::add(const std::string& name, const std::string& unit, std::vector<double> samples) {
    values.push_back({name, unit, Origin::measured, std::move(samples)});
}

namespace {

std::string keyOf(const Row& row) {
    return fmt::format("{} / {} / {}{}", row.suite, row.scene, row.contestant,
                       row.axis.empty() ? "" : fmt::format(" / {} {:g}", row.axis, row.at));
}

/// Times and bytes: what should not grow.
bool isCost(const Value& value) { return value.unit == "ms" || value.unit == "bytes"; }

double quotient(double a, double b) { return b > 0 ? a / b : a > 0 ? INFINITY : 1; }

Change changeOf(const Row& row, const Value& before, const Value& after, double tolerance) {
    const Spread a = spreadOf(before.samples), b = spreadOf(after.samples);
    Change change{row.suite, row.scene, row.contestant, row.axis, before.name, before.unit, row.at, a.median, b.median};
    change.ratio = quotient(b.median, a.median);
    change.low = quotient(b.p5, a.p95);
    change.high = quotient(b.p95, a.p5);
    change.isRegression = change.ratio > 1 + tolerance && change.low > 1;
    return change;
}

void warnOfDifferences(const std::map<std::string, std::string>& a, const std::map<std::string, std::string>& b,
                       const char* what, std::vector<std::string>& warnings) {
    for (const auto& [key, value] : a)
        if (const auto found = b.find(key); found != b.end() && found->second != value)
            warnings.push_back(fmt::format("{} {}: {} against {}", what, key, value, found->second));
}

} // namespace

bool Comparison::hasRegression() const { return std::ranges::any_of(changes, &Change::isRegression); }

Comparison compareResults(const Results& before, const Results& after, double tolerance) {
    Comparison comparison;
    warnOfDifferences(before.machine, after.machine, "machine", comparison.warnings);
    warnOfDifferences(before.device, after.device, "device", comparison.warnings);
    warnOfDifferences(before.settings, after.settings, "settings", comparison.warnings);
    std::map<std::string, const Row*> partners;
    for (const Row& row : after.rows) partners[keyOf(row)] = &row;
    for (const Row& row : before.rows) {
        const auto found = partners.find(keyOf(row));
        if (found == partners.end()) {
            comparison.onlyInOne.push_back(keyOf(row));
            continue;
        }
        for (const Value& value : row.values)
            if (const Value* other = found->second->find(value.name); other != nullptr && isCost(value))
                comparison.changes.push_back(changeOf(row, value, *other, tolerance));
        partners.erase(found);
    }
    for (const auto& [key, row] : partners) comparison.onlyInOne.push_back(key);
    return comparison;
}

} // namespace relief
