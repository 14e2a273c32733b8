// Statistics, JSON against its schema, CSV, comparisons, goals, plots and the report.
#include <set>
#include <tuple>

#include <nlohmann/json.hpp>

#include "measure/measure.h"
#include "measure/plot.h"
#include "support.h"

namespace relief::test {
namespace {

using nlohmann::json;

/// Two suites with times and bytes.
Results makeResults(double milliseconds = 10) {
    Results results;
    results.program = {{"name", "relief"}, {"commit", "abc"}};
    results.machine = {{"threads", "2"}};
    results.device = {{"name", "a device"}, {"driver", "a driver"}};
    results.settings = {{"quick", "yes"}};
    Row frame{.suite = Suite::frame, .scene = "ball, \"blue\"", .method = Method::grid};
    frame.addMeasured(Metric::frameTime, {milliseconds, milliseconds + 1, milliseconds + 2});
    frame.addMeasured(Metric::triangles, 1e6);
    Row small{Suite::scaling, "ball", Method::grid, Axis::triangles, 1e4, {}};
    small.addComputed(Metric::residentBytes, 4096);
    results.rows = {frame, small};
    results.notes = {"something is missing"};
    return results;
}

TEST(Spread, isLinearBetweenSamples) {
    EXPECT_EQ(computeSpread({5}).median, 5);
    EXPECT_EQ(computeSpread({3, 1, 2}).median, 2);
    EXPECT_EQ(computeSpread({4, 1, 2, 3}).median, 2.5);
    std::vector<double> many;
    for (int i = 100; i >= 0; --i) many.push_back(i);
    EXPECT_DOUBLE_EQ(computeSpread(many).p5, 5);
    EXPECT_DOUBLE_EQ(computeSpread(many).p95, 95);
    EXPECT_EQ(computeSpread({}).median, 0);
}

/// What readers of the files rely on.
void expectSchema(const json& all) {
    EXPECT_EQ(all.at("schema"), "relief-bench");
    EXPECT_EQ(all.at("version"), 2);
    for (const char* part : {"program", "machine", "device", "settings"})
        for (const auto& [key, value] : all.at(part).items()) EXPECT_TRUE(value.is_string()) << part << '.' << key;
    for (const json& note : all.at("notes")) EXPECT_TRUE(note.is_string());
    for (const json& row : all.at("rows")) {
        for (const char* word : {"suite", "scene", "method", "axis"}) EXPECT_TRUE(row.at(word).is_string());
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
    const Results results = makeResults();
    const std::string text = toJson(results);
    expectSchema(json::parse(text));
    const Results back = parseResults(text, "r.json");
    EXPECT_EQ(toJson(back), text);
    ASSERT_EQ(back.rows.size(), 2u);
    EXPECT_EQ(back.rows[0].find(Metric::frameTime)->samples, (std::vector<double>{10, 11, 12}));
    EXPECT_EQ(back.rows[1].find(Metric::residentBytes)->origin, Origin::computed);
    EXPECT_EQ(back.notes, results.notes);
}

TEST(Json, replacesBytesThatAreNotUtf8) {
    Results results = makeResults();
    results.rows[0].scene = "c\xe4ge";
    const Results read = parseResults(toJson(results), "a.json");
    EXPECT_EQ(read.rows[0].scene, "c\xEF\xBF\xBDge"); // U+FFFD
}

TEST(Json, ofAnotherShapeIsRefusedWithTheFilesName) {
    const std::string good = toJson(makeResults());
    const auto refused = [&](const std::string& text, const std::string& word) {
        expectFailure(Failure::input, {"r.json", word}, [&] { parseResults(text, "r.json"); });
    };
    refused("", "parse error");
    refused("[1]", "relief-bench");
    refused(R"({"schema": "else"})", "relief-bench");
    json other = json::parse(good);
    for (const int version : {1, 3}) {
        other["version"] = version;
        refused(other.dump(), "measure again");
    }
    other = json::parse(good);
    other["rows"][0].erase("suite");
    refused(other.dump(), "suite");
    other = json::parse(good);
    other["rows"][0]["values"]["frame time"]["samples"] = "many";
    refused(other.dump(), "array");
    other = json::parse(good);
    // Words that no table has, a unit of another metric, no samples.
    const auto refusedWith = [&](const char* pointer, const json& value, const std::string& word) {
        json changed = json::parse(good);
        changed[json::json_pointer(pointer)] = value;
        refused(changed.dump(), word);
    };
    refusedWith("/rows/0/values/frame time/origin", "guessed", "guessed");
    refusedWith("/rows/0/values/frame time/unit", "s", "\"ms\"");
    refusedWith("/rows/0/values/frame time/samples", json::array(), "no samples");
    refusedWith("/rows/0/suite", "frames", "\"frames\" is no suite");
    refusedWith("/rows/0/method", "magic", "\"magic\" is no method");
    refusedWith("/rows/0/axis", "time", "\"time\" is no axis");
    refusedWith("/rows/0/values/speed", json::object(), "\"speed\" is no metric");
}

TEST(Csv, hasALinePerValueAndQuotesCells) {
    const std::string csv = toCsv(makeResults());
    EXPECT_EQ(std::ranges::count(csv, '\n'), 4);
    EXPECT_NE(csv.find("frame,\"ball, \"\"blue\"\"\",grid,,0,frame time,ms,measured,3,11,10.1,11.9\n"),
              std::string::npos)
        << csv;
    EXPECT_NE(csv.find("scaling,ball,grid,triangles,10000,resident bytes,bytes,computed,1,4096,4096,4096\n"),
              std::string::npos);
}

// --- comparisons

const Change* findChange(const Comparison& comparison, Metric metric) {
    const auto found = std::ranges::find(comparison.changes, metric, &Change::metric);
    return found == comparison.changes.end() ? nullptr : &*found;
}

TEST(Comparison, hasRatiosOfTimesAndBytesWithTheirSpread) {
    const Comparison comparison = compareResults(makeResults(10), makeResults(21), 0.1);
    ASSERT_EQ(comparison.changes.size(), 2u); // triangles are no cost
    const Change& frame = *findChange(comparison, Metric::frameTime);
    EXPECT_DOUBLE_EQ(frame.ratio, 2);
    EXPECT_DOUBLE_EQ(frame.low, 21.1 / 11.9);
    EXPECT_DOUBLE_EQ(frame.high, 22.9 / 10.1);
    EXPECT_TRUE(frame.isRegression);
    EXPECT_FALSE(findChange(comparison, Metric::residentBytes)->isRegression);
    EXPECT_TRUE(comparison.hasRegression());
    EXPECT_FALSE(compareResults(makeResults(10), makeResults(21), 1.5).hasRegression()); // within the tolerance
    EXPECT_FALSE(compareResults(makeResults(21), makeResults(10), 0.1).hasRegression()); // faster
    EXPECT_TRUE(comparison.warnings.empty());
}

TEST(Comparison, findsNoRegressionThatTheSpreadExplains) {
    Results after = makeResults();
    after.rows[0].values[0].samples = {11, 13, 30}; // a slow moment of the machine
    const Comparison comparison = compareResults(makeResults(), after, 0.1);
    EXPECT_GT(findChange(comparison, Metric::frameTime)->ratio, 1.1);
    EXPECT_FALSE(comparison.hasRegression());
}

TEST(Comparison, namesRowsWithoutPartnerAndDifferentMachines) {
    Results after = makeResults();
    after.rows[1].at = 2e4;
    after.device["name"] = "another device";
    const Comparison comparison = compareResults(makeResults(), after, 0.1);
    EXPECT_EQ(comparison.onlyInOne.size(), 2u);
    ASSERT_EQ(comparison.warnings.size(), 1u);
    EXPECT_NE(comparison.warnings[0].find("another device"), std::string::npos);
}

// --- the report

TEST(Plot, hasTicksWithUnitsAndOnlyFiniteNumbers) {
    const std::string svg =
        drawFigure({.title = "A <b> & c",
                    .xLabel = "triangles",
                    .yLabel = "bytes",
                    .lines = {{"one", {0, 0}, {{1e3, 1e4}, {1e6, 1e7}}, {}}, {"none", {1, 1}, {}, {}}}});
    EXPECT_NE(svg.find("A &lt;b&gt; &amp; c"), std::string::npos);
    for (const char* label : {">1 k<", ">1 M<", ">10 kB<", ">10 MB<"})
        EXPECT_NE(svg.find(label), std::string::npos) << label;
    EXPECT_EQ(svg.find("none"), std::string::npos); // a line without points is not in the legend
    EXPECT_EQ(svg.find("nan"), std::string::npos);
    EXPECT_EQ(drawFigure({.title = "empty"}), "");
    EXPECT_NE(drawFigure({.title = "one point", .lines = {{"p", {}, {{5, 5}}, {}}}}).find("circle"), std::string::npos);
}

TEST(Plot, formatsNumbersWithTheirUnit) {
    EXPECT_EQ(formatNumber(1e4, Scale::bytes), "10 kB");
    EXPECT_EQ(formatNumber(2.5e6, Scale::bytes), "2.5 MB");
    EXPECT_EQ(formatNumber(3e-5, Scale::percent), "0.003 %");
    EXPECT_EQ(formatNumber(1500, Scale::milliseconds), "1.5 s");
    EXPECT_EQ(formatNumber(0.5, Scale::ratio), "0.5 ×");
    EXPECT_EQ(formatNumber(12, Scale::nanoseconds), "12 ns");
}

Row makeBandwidthRow(Method method, double tolerance, double residentBytes, double diskBytes) {
    Row row{Suite::bandwidth, "ball", method, Axis::tolerance, tolerance, {}};
    row.addComputed(Metric::residentBytes, residentBytes);
    row.addMeasured(Metric::diskBytes, diskBytes);
    return row;
}

// The goals of the project: what parseGoals() accepts, and names that the tables have.
std::vector<Goal> readProjectGoals() {
    const std::string path = std::string(std::getenv("RELIEF_SOURCE")) + "/bench/goals.json";
    return parseGoals(readFile(path), path);
}

TEST(Goals, ofTheProjectDivideTheDenseMeshByTheSmallestCageAndMapAtTheTightestTolerance) {
    Results results;
    results.rows = {makeBandwidthRow(Method::cageFloatMap, 1e-5, 4e6, 5e5),
                    makeBandwidthRow(Method::cageBc4Map, 1e-5, 1e6, 8e5),
                    makeBandwidthRow(Method::denseRaw, 1e-5, 30e6, 30e6),
                    makeBandwidthRow(Method::denseQuantised, 1e-5, 5e6, 2e6),
                    makeBandwidthRow(Method::denseDraco, 1e-5, 0, 1e6),
                    makeBandwidthRow(Method::denseRaw, 1e-4, 1, 1)};
    const std::vector<GoalResult> found = evaluateGoals(readProjectGoals(), results);
    ASSERT_EQ(found.size(), 3u);
    EXPECT_DOUBLE_EQ(found[0].found, 30);
    EXPECT_TRUE(found[0].isMet());
    EXPECT_DOUBLE_EQ(found[1].found, 5);
    EXPECT_FALSE(found[1].isMet());
    EXPECT_DOUBLE_EQ(found[2].found, 2);
    EXPECT_EQ(found[2].scene, "ball");
}

TEST(Goals, ofTheProjectMeasureTheDeviationOfCostsFromTheMiddleOfTheirRange) {
    Results results;
    for (const auto& [triangles, cost] : {std::pair(3e3, 900.0), {1e5, 90.0}, {1e6, 100.0}, {1e7, 110.0}}) {
        Row row{Suite::scaling, "ball", Method::dicing, Axis::pixelTriangles, triangles, {}};
        row.addComputed(Metric::costPerAdditionalTriangle, cost);
        results.rows.push_back(row);
    }
    const std::vector<GoalResult> found = evaluateGoals(readProjectGoals(), results);
    ASSERT_EQ(found.size(), 1u); // of dicing: the other paths have no rows
    EXPECT_DOUBLE_EQ(found[0].found, 0.1);
    EXPECT_TRUE(found[0].isMet());
    EXPECT_NE(toTable(results, readProjectGoals())
                  .find("goal met: 10 %, wanted at most 15 %: dicing: cost per additional triangle"),
              std::string::npos);
    results.rows.resize(2); // one value deviates from nothing
    EXPECT_TRUE(evaluateGoals(readProjectGoals(), results).empty());
}

TEST(Goals, takeTheLargestPointWithinTheirBounds) {
    Results results;
    for (const auto& [method, triangles, bytes] : {std::tuple(Method::posedCage, 1e6, 10.0),
                                                   {Method::denseRaw, 1e5, 700.0},
                                                   {Method::denseRaw, 1e6, 7000.0},
                                                   {Method::posedCage, 1e7, 10.0},
                                                   {Method::denseRaw, 1e7, 70000.0}}) {
        Row row{Suite::animate, "ball", method, Axis::triangles, triangles, {}};
        row.addComputed(Metric::uploadedBytes, bytes);
        results.rows.push_back(row);
    }
    const std::vector<GoalResult> found = evaluateGoals(readProjectGoals(), results);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_DOUBLE_EQ(found[0].found, 700); // at 1e6: the goal ends at 1.3e6
}

TEST(Goals, ofAnotherShapeAreRefusedWithTheirNumber) {
    const std::string source = std::getenv("RELIEF_SOURCE");
    const json good = json::parse(readFile(source + "/bench/goals.json"));
    const auto refusedWith = [&](const char* pointer, const json& value, const std::vector<std::string>& parts) {
        json changed = good;
        changed[json::json_pointer(pointer)] = value;
        expectFailure(Failure::input, parts, [&] { parseGoals(changed.dump(), "g.json"); });
    };
    refusedWith("/schema", "relief-bench", {"g.json", "relief-goals"});
    refusedWith("/version", 2, {"g.json", "version 2"});
    refusedWith("/goals/1/metric", "speed", {"g.json: goal 1", "\"speed\" is no metric"});
    refusedWith("/goals/1/comparison", "above", {"goal 1", "above"});
    refusedWith("/goals/1/value", "many", {"goal 1", "number"});
    refusedWith("/goals/2/subject/statistic", "mean", {"goal 2", "mean"});
    refusedWith("/goals/2/subject/methods", json::array(), {"goal 2", "names no method"});
    refusedWith("/goals/2/subject/metods", json::array(), {"goal 2", "unknown key \"metods\""});
    refusedWith("/goals/2/wanted", 3, {"goal 2", "unknown key \"wanted\""});
    expectFailure(Failure::input, {"g.json", "parse error"}, [] { parseGoals("", "g.json"); });
}

TEST(Words, areDifferentForEveryMetricAndMethod) {
    std::set<std::string> metrics, methods;
    for (int i = 0; i <= int(Metric::coldRunPerFrame); ++i) metrics.insert(describe(Metric(i)).name);
    for (int i = 0; i <= int(Method::reliefRender); ++i) methods.insert(toWord(Method(i)));
    EXPECT_EQ(metrics.size(), std::size_t(Metric::coldRunPerFrame) + 1);
    EXPECT_EQ(methods.size(), std::size_t(Method::reliefRender) + 1);
    for (const Suite suite : allSuites()) EXPECT_EQ(parseSuite(toWord(suite)), suite);
    expectFailure(Failure::input, {"\"sweep\" is no suite"}, [] { parseSuite("sweep"); });
}

TEST(Row, refusesASecondValueOfAMetric) {
    Row row;
    row.addMeasured(Metric::frameTime, 1);
    expectFailure(Failure::internal, {"find(metric) == nullptr"}, [&] { row.addMeasured(Metric::frameTime, 2); });
}

TEST(Suites, areRefusedWithoutAScene) {
    const std::vector<TestScene> none;
    const std::vector<Suite> suites{Suite::startup};
    expectFailure(Failure::input, {"no scene"}, [&] { runSuites(suites, none, {}); });
}

TEST(Report, isOnePageThatLoadsNothingElse) {
    Results results = makeResults();
    results.pictures.push_back({"ball", "a title", "left", "right", "\x89PNG", "\x89PNG1", "\x89PNG12"});
    const std::string html = makeReport(results);
    EXPECT_EQ(html.find("Figures to reach"), std::string::npos); // there are no goals
    EXPECT_NE(html.find(describe(Metric::frameTime).meaning), std::string::npos);
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
