// {"schema": "relief-bench", "version": 1,
//  "program": {"version", "commit"}, "machine": {...}, "device": {...}, "settings": {...}, "notes": [...],
//  "rows": [{"suite", "scene", "contestant", "axis", "at",
//            "values": {NAME: {"unit", "origin": "measured" or "computed", "median", "p5", "p95", "samples": [...]}}}]}
#include <cmath>

#include <nlohmann/json.hpp>

#include "measure/measure.h"

namespace relief {
namespace {

using json = nlohmann::ordered_json; // values keep their order

constexpr const char* kSchema = "relief-bench";
constexpr int kVersion = 1;

const char* wordOf(Origin origin) { return origin == Origin::measured ? "measured" : "computed"; }

json ofValue(const Value& value) {
    const Spread spread = spreadOf(value.samples);
    return {{"unit", value.unit}, {"origin", wordOf(value.origin)}, {"median", spread.median}, {"p5", spread.p5},
            {"p95", spread.p95},  {"samples", value.samples}};
}

json ofRow(const Row& row) {
    json values = json::object();
    for (const Value& value : row.values) values[value.name] = ofValue(value);
    return {{"suite", row.suite}, {"scene", row.scene}, {"contestant", row.contestant},
            {"axis", row.axis},   {"at", row.at},       {"values", values}};
}

Value valueOf(const std::string& name, const json& from) {
    const std::string origin = from.at("origin");
    if (origin != "measured" && origin != "computed") throw std::invalid_argument("origin is \"" + origin + "\"");
    return {name, from.at("unit"), origin == "measured" ? Origin::measured : Origin::computed, from.at("samples")};
}

Row rowOf(const json& from) {
    Row row{from.at("suite"), from.at("scene"), from.at("contestant"), from.at("axis"), from.at("at"), {}};
    for (const auto& [name, value] : from.at("values").items()) row.values.push_back(valueOf(name, value));
    return row;
}

/// A cell of CSV (RFC 4180): quoted where it holds what would end it.
std::string cell(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string quoted = "\"";
    for (const char letter : text) quoted += letter == '"' ? std::string("\"\"") : std::string(1, letter);
    return quoted + '"';
}

} // namespace

std::string jsonOf(const Results& results) {
    json rows = json::array();
    for (const Row& row : results.rows) rows.push_back(ofRow(row));
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
        if (!all.is_object() || all.value("schema", json()) != kSchema)
            fail(Failure::input, "{}: these are no results of relief bench (\"schema\" is not \"{}\")", name, kSchema);
        if (all.at("version") != kVersion)
            fail(Failure::input, "{}: version {} of the results is not known here; {} is", name,
                 all.at("version").dump(), kVersion);
        Results results{
            all.at("program"), all.at("machine"), all.at("device"), all.at("settings"), {}, all.at("notes"), {}};
        for (const json& row : all.at("rows")) results.rows.push_back(rowOf(row));
        return results;
    } catch (const json::exception& error) {
        fail(Failure::input, "{}: not as relief bench writes it: {}", name, error.what());
    } catch (const std::invalid_argument& error) {
        fail(Failure::input, "{}: not as relief bench writes it: {}", name, error.what());
    }
}

std::string csvOf(const Results& results) {
    std::string csv = "suite,scene,contestant,axis,at,value,unit,origin,samples,median,p5,p95\n";
    for (const Row& row : results.rows)
        for (const Value& value : row.values) {
            const Spread spread = spreadOf(value.samples);
            csv += fmt::format("{},{},{},{},{:.10g},{},{},{},{},{:.10g},{:.10g},{:.10g}\n", cell(row.suite),
                               cell(row.scene), cell(row.contestant), cell(row.axis), row.at, cell(value.name),
                               cell(value.unit), wordOf(value.origin), value.samples.size(), spread.median, spread.p5,
                               spread.p95);
        }
    return csv;
}

} // namespace relief
