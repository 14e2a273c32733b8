// Statistics, JSON against its schema, CSV, comparisons, and what the report is made of.
#include <nlohmann/json.hpp>

#include "measure/goals.h"
#include "measure/plot.h"
#include "support.h"

namespace relief::test {
namespace {

using nlohmann::json;

/// Two suites with times and bytes.
Results sample(double milliseconds = 10) {
    Results results;
    results.program = {{"name", "relief"}, {"commit", "abc"}};
    results.machine = {{"threads", "2"}};
    results.device = {{"name", "a device"}, {"driver", "a driver"}};
    results.settings = {{"quick", "yes"}};
    Row frame{.suite = "frame", .scene = "ball, \"blue\"", .contestant = "grid"};
    frame.add("frame", "ms", {milliseconds, milliseconds + 1, milliseconds + 2});
    frame.add("triangles", "triangles", Origin::measured, 1e6);
    Row small{"scaling", "ball", "grid", "triangles", 1e4, {}};
    small.add("resident", "bytes", Origin::computed, 4096);
    results.rows = {frame, small};
    results.notes = {"something is missing"};
    return results;
}

TEST(Spread, isLinearBetweenSamples) {
    EXPECT_EQ(spreadOf({5}).median, 5);
    EXPECT_EQ(spreadOf({3, 1, 2}).median, 2);
    EXPECT_EQ(spreadOf({4, 1, 2, 3}).median, 2.5);
    std::vector<double> many;
    for (int i = 100; i >= 0; --i) many.push_back(i);
    EXPECT_DOUBLE_EQ(spreadOf(many).p5, 5);
    EXPECT_DOUBLE_EQ(spreadOf(many).p95, 95);
    EXPECT_EQ(spreadOf({}).median, 0);
}

/// What readers of the files rely on.
void expectSchema(const json& all) {
    EXPECT_EQ(all.at("schema"), "relief-bench");
    EXPECT_EQ(all.at("version"), 1);
    for (const char* part : {"program", "machine", "device", "settings"})
        for (const auto& [key, value] : all.at(part).items()) EXPECT_TRUE(value.is_string()) << part << '.' << key;
    for (const json& note : all.at("notes")) EXPECT_TRUE(note.is_string());
    for (const json& row : all.at("rows")) {
        for (const char* word : {"suite", "scene", "contestant", "axis"}) EXPECT_TRUE(row.at(word).is_string());
        EXPECT_TRUE(row.at("at").is_number());
        for (const auto& [name, value] : row.at("values").items()) {
            EXPECT_TRUE(value.at("unit").is_string()) << name;
            EXPECT_TRUE(value.at("origin") == "measured" || value.at("origin") == "computed") << name;
            for (const char* number : {"median", "p5", "p95"}) EXPECT_TRUE(value.at(number).is_number()) << name;
            ASSERT_TRUE(value.at("samples").is_array() && !value.at("samples").empty()) << name;
            for (const json& s : value.at("samples")) EXPECT_TRUE(s.is_number()) << name;
            EXPECT_LE(value.at("p5").get<double>(), value.at("median").get<double>()) << name;
            EXPECT_LE(value.at("median").get<double>(), value.at("p95").get<double>()) << name;
        }
    }
}

TEST(Json, hasTheShapeOfItsSchemaAndReadsBack) {
    const Results results = sample();
    const std::string text = jsonOf(results);
    expectSchema(json::parse(text));
    const Results back = parseResults(text, "r.json");
    EXPECT_EQ(jsonOf(back), text);
    ASSERT_EQ(back.rows.size(), 2u);
    EXPECT_EQ(back.rows[0].find("frame")->samples, (std::vector<double>{10, 11, 12}));
    EXPECT_EQ(back.rows[1].find("resident")->origin, Origin::computed);
    EXPECT_EQ(back.notes, results.notes);
}

TEST(Json, bearsNamesThatAreNotUtf8) {
    Results results = sample();
    results.rows[0].scene = "c\xe4ge";
    const Results read = parseResults(jsonOf(results), "a.json");
    EXPECT_EQ(read.rows[0].scene, "c\xEF\xBF\xBDge"); // U+FFFD
}

TEST(Json, ofAnotherShapeIsRefusedWithTheFilesName) {
    const std::string good = jsonOf(sample());
    const auto refused = [&](const std::string& text, const std::string& word) {
        expectFailure(Failure::input, {"r.json", word}, [&] { parseResults(text, "r.json"); });
    };
    refused("", "parse error");
    refused("[1]", "relief-bench");
    refused(R"({"schema": "else"})", "relief-bench");
    json other = json::parse(good);
    other["version"] = 2;
    refused(other.dump(), "version 2");
    other = json::parse(good);
    other["rows"][0].erase("suite");
    refused(other.dump(), "suite");
    other = json::parse(good);
    other["rows"][0]["values"]["frame"]["samples"] = "many";
    refused(other.dump(), "array");
    other = json::parse(good);
    other["rows"][0]["values"]["frame"]["origin"] = "guessed";
    refused(other.dump(), "guessed");
}

TEST(Csv, hasALineAValueAndQuotesWhatNeedsIt) {
    const std::string csv = csvOf(sample());
    EXPECT_EQ(std::ranges::count(csv, '\n'), 4);
    EXPECT_NE(csv.find("frame,\"ball, \"\"blue\"\"\",grid,,0,frame,ms,measured,3,11,10.1,11.9\n"), std::string::npos)
        << csv;
    EXPECT_NE(csv.find("scaling,ball,grid,triangles,10000,resident,bytes,computed,1,4096,4096,4096\n"),
              std::string::npos);
}

// --- comparisons

const Change* changeOf(const Comparison& comparison, const std::string& name) {
    const auto found = std::ranges::find(comparison.changes, name, &Change::name);
    return found == comparison.changes.end() ? nullptr : &*found;
}

TEST(Comparison, tellsRatiosOfTimesAndBytesWithTheirSpread) {
    const Comparison comparison = compareResults(sample(10), sample(21), 0.1);
    ASSERT_EQ(comparison.changes.size(), 2u); // triangles are no cost
    const Change& frame = *changeOf(comparison, "frame");
    EXPECT_DOUBLE_EQ(frame.ratio, 2);
    EXPECT_DOUBLE_EQ(frame.low, 21.1 / 11.9);
    EXPECT_DOUBLE_EQ(frame.high, 22.9 / 10.1);
    EXPECT_TRUE(frame.isRegression);
    EXPECT_FALSE(changeOf(comparison, "resident")->isRegression);
    EXPECT_TRUE(comparison.hasRegression());
    EXPECT_FALSE(compareResults(sample(10), sample(21), 1.5).hasRegression()); // within the tolerance
    EXPECT_FALSE(compareResults(sample(21), sample(10), 0.1).hasRegression()); // faster
    EXPECT_TRUE(comparison.warnings.empty());
}

TEST(Comparison, countsNothingThatTheSpreadExplains) {
    Results after = sample();
    after.rows[0].values[0].samples = {11, 13, 30}; // a slow spell
    const Comparison comparison = compareResults(sample(), after, 0.1);
    EXPECT_GT(changeOf(comparison, "frame")->ratio, 1.1);
    EXPECT_FALSE(comparison.hasRegression());
}

TEST(Comparison, namesWhatHasNoPartnerAndOtherMachines) {
    Results after = sample();
    after.rows[1].at = 2e4;
    after.device["name"] = "another device";
    const Comparison comparison = compareResults(sample(), after, 0.1);
    EXPECT_EQ(comparison.onlyInOne.size(), 2u);
    ASSERT_EQ(comparison.warnings.size(), 1u);
    EXPECT_NE(comparison.warnings[0].find("another device"), std::string::npos);
}

// --- the report

TEST(Plot, ticksAxesAndLinesStayInside) {
    const std::string svg =
        figureOf({.title = "A <b> & c",
                  .xLabel = "triangles",
                  .yLabel = "bytes",
                  .lines = {{"one", {0, 0}, {{1e3, 1e4}, {1e6, 1e7}}, {}}, {"none", {1, 1}, {}, {}}}});
    EXPECT_NE(svg.find("A &lt;b&gt; &amp; c"), std::string::npos);
    for (const char* label : {">1 k<", ">1 M<", ">10 kB<", ">10 MB<"})
        EXPECT_NE(svg.find(label), std::string::npos) << label;
    EXPECT_EQ(svg.find("none"), std::string::npos); // a line without points has no place in the legend
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(figureOf({.title = "empty"}), "");
    EXPECT_NE(figureOf({.title = "one point", .lines = {{"p", {}, {{5, 5}}, {}}}}).find("circle"), std::string::npos);
}

TEST(Plot, wordsHaveUnits) {
    EXPECT_EQ(wordOf(1e4, Scale::bytes), "10 kB");
    EXPECT_EQ(wordOf(2.5e6, Scale::bytes), "2.5 MB");
    EXPECT_EQ(wordOf(3e-5, Scale::percent), "0.003 %");
    EXPECT_EQ(wordOf(1500, Scale::milliseconds), "1.5 s");
    EXPECT_EQ(wordOf(0.5, Scale::ratio), "0.5 ×");
    EXPECT_EQ(wordOf(12, Scale::nanoseconds), "12 ns");
}

Row bandwidthRow(const std::string& contestant, double tolerance, double resident, double disk) {
    Row row{"bandwidth", "ball", contestant, "tolerance", tolerance, {}};
    row.add("resident", "bytes", Origin::computed, resident);
    row.add("disk", "bytes", Origin::measured, disk);
    return row;
}

TEST(Goals, compareTheSmallestOfOursWithEachOpponentAtTheTightestTolerance) {
    Results results;
    results.rows = {
        bandwidthRow("cage + float map", 1e-5, 4e6, 5e5),  bandwidthRow("cage + bc4 map", 1e-5, 1e6, 8e5),
        bandwidthRow("dense mesh, raw", 1e-5, 30e6, 30e6), bandwidthRow("dense mesh, quantised", 1e-5, 5e6, 2e6),
        bandwidthRow("Draco, dense mesh", 1e-5, 0, 1e6),   bandwidthRow("dense mesh, raw", 1e-4, 1, 1)};
    const std::vector<Goal> goals = goalsOf(results);
    ASSERT_EQ(goals.size(), 3u);
    EXPECT_DOUBLE_EQ(goals[0].found, 30);
    EXPECT_TRUE(goals[0].isMet());
    EXPECT_DOUBLE_EQ(goals[1].found, 5);
    EXPECT_FALSE(goals[1].isMet());
    EXPECT_DOUBLE_EQ(goals[2].found, 2);
}

TEST(Report, isOnePageThatAsksForNothing) {
    Results results = sample();
    results.pictures.push_back({"ball", "a title", "left", "right", "\x89PNG", "\x89PNG1", "\x89PNG12"});
    const std::string html = reportOf(results);
    EXPECT_TRUE(html.starts_with("<!doctype html>"));
    EXPECT_TRUE(html.ends_with("</html>\n"));
    for (const char* part : {"<h2>Break-even</h2>", "prefers-color-scheme: dark", "ball, &quot;blue&quot;",
                             "something is missing", "base64,iVBORw==", "base64,iVBORzE=", "base64,iVBORzEy"})
        EXPECT_NE(html.find(part), std::string::npos) << part;
    for (const char* part : {"http:", "https:", "<script", "src=\"/", "@import"})
        EXPECT_EQ(html.find(part), std::string::npos) << part;
}

} // namespace
} // namespace relief::test
