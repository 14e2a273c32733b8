// {"schema": "relief-bench", "version": 2,
//  "program": {"name", "commit", "time"}, "machine": {...}, "device": {...}, "settings": {...}, "notes": [...],
//  "rows": [{"suite", "scene", "method", "axis", "at",
//            "values": {METRIC: {"unit", "origin": "measured" or "computed", "median", "p5", "p95", "samples":
//            [...]}}}]}
// Names of suites, methods, axes, metrics and units are those of words.cpp. The percentiles are for other readers: they
// follow from the samples.
#include <nlohmann/json.hpp>

#include "measure/words.h"

namespace relief {
namespace {

using json = nlohmann::ordered_json; // values keep their order

constexpr const char* kSchema = "relief-bench";
constexpr int kVersion = 2;

json writeValue(const Value& value) {
    const Spread spread = computeSpread(value.samples);
    return {{"unit", toWord(describe(value.metric).unit)},
            {"origin", toWord(value.origin)},
            {"median", spread.median},
            {"p5", spread.p5},
            {"p95", spread.p95},
            {"samples", value.samples}};
}

json writeRow(const Row& row) {
    json values = json::object();
    for (const Value& value : row.values) values[describe(value.metric).name] = writeValue(value);
    return {{"suite", toWord(row.suite)}, {"scene", row.scene}, {"method", toWord(row.method)},
            {"axis", toWord(row.axis)},   {"at", row.at},       {"values", values}};
}

template <typename Enum>
Enum readWord(const json& from, const char* key) {
    Enum value{};
    parseWord(from.at(key).get<std::string>(), value);
    return value;
}

Value readValue(const std::string& name, const json& from) {
    Value value{};
    parseWord(name, value.metric);
    value.origin = readWord<Origin>(from, "origin");
    value.samples = from.at("samples").get<std::vector<double>>();
    const std::string unit = from.at("unit"), known = toWord(describe(value.metric).unit);
    if (unit != known) throw std::invalid_argument(fmt::format("{} is in \"{}\", not in \"{}\"", name, unit, known));
    if (value.samples.empty()) throw std::invalid_argument(fmt::format("{} has no samples", name));
    return value;
}

Row readRow(const json& from) {
    Row row{readWord<Suite>(from, "suite"), from.at("scene"), readWord<Method>(from, "method"),
            readWord<Axis>(from, "axis"),   from.at("at"),    {}};
    for (const auto& [name, value] : from.at("values").items()) row.values.push_back(readValue(name, value));
    return row;
}

void checkVersion(const json& all, const std::string& name) {
    if (!all.is_object() || all.value("schema", json()) != kSchema)
        fail(Failure::input, "{}: these are no results of relief bench (\"schema\" is not \"{}\")", name, kSchema);
    const json& version = all.at("version");
    if (version != kVersion)
        fail(Failure::input, "{}: version {} of the results is not read; this relief reads {}: measure again{}", name,
             version.dump(), kVersion, version == 1 ? ", or use the relief that wrote it" : "");
}

/// A cell of CSV (RFC 4180): quoted where it holds what would end it.
std::string quoteCell(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
    return quoted + '"';
}

} // namespace

std::string toJson(const Results& results) {
    json rows = json::array();
    for (const Row& row : results.rows) rows.push_back(writeRow(row));
    const json all{{"schema", kSchema},          {"version", kVersion},
                   {"program", results.program}, {"machine", results.machine},
                   {"device", results.device},   {"settings", results.settings},
                   {"notes", results.notes},     {"rows", rows}};
    // A cage's name comes from its file's, which need not be UTF-8.
    return all.dump(1, ' ', false, json::error_handler_t::replace) + '\n';
}

Results parseResults(const std::string& text, const std::string& name) {
    try {
        const json all = json::parse(text);
        checkVersion(all, name);
        Results results{
            all.at("program"), all.at("machine"), all.at("device"), all.at("settings"), {}, all.at("notes"), {}};
        for (const json& row : all.at("rows")) results.rows.push_back(readRow(row));
        return results;
    } catch (const json::exception& error) {
        fail(Failure::input, "{}: not as relief bench writes it: {}", name, error.what());
    } catch (const std::invalid_argument& error) {
        fail(Failure::input, "{}: not as relief bench writes it: {}", name, error.what());
    }
}

std::string toCsv(const Results& results) {
    std::string csv = "suite,scene,method,axis,at,metric,unit,origin,samples,median,p5,p95\n";
    for (const Row& row : results.rows)
        for (const Value& value : row.values) {
            const MetricInfo& metric = describe(value.metric);
            const Spread spread = computeSpread(value.samples);
            csv += fmt::format("{},{},{},{},{:.10g},{},{},{},{},{:.10g},{:.10g},{:.10g}\n", toWord(row.suite),
                               quoteCell(row.scene), quoteCell(toWord(row.method)), toWord(row.axis), row.at,
                               quoteCell(metric.name), toWord(metric.unit), toWord(value.origin), value.samples.size(),
                               spread.median, spread.p5, spread.p95);
        }
    return csv;
}

} // namespace relief
