// relief bench as a user runs it: files, comparisons and their exit code, the report in a browser.
#include "measure/measure.h"
#include "program.h"

namespace relief::test {
namespace {

Results makeResults(double milliseconds) {
    Results results;
    Row row{Suite::scaling, "ball", Method::grid, Axis::triangles, 1e4, {}};
    row.addMeasured(Metric::frameTime, {milliseconds, milliseconds, milliseconds});
    row.addMeasured(Metric::residentBytes, 4096);
    results.rows = {row};
    return results;
}

/// Two files of results, the second slower.
struct TwoRuns {
    TemporaryFolder folder;
    std::string before = folder / "before.json", after = folder / "after.json";

    TwoRuns() {
        putFile(before, toJson(makeResults(10)));
        putFile(after, toJson(makeResults(12)));
    }
};

TEST(Bench, compareEndsWithSixOnARegressionAboveTheTolerance) {
    const TwoRuns runs;
    const Outcome worse = relief({"bench", "--compare", runs.before, runs.after});
    EXPECT_EQ(worse.exitCode, int(Failure::check)) << worse.err;
    EXPECT_TRUE(contains(worse.out, "1.200 x")) << worse.out;
    EXPECT_TRUE(contains(worse.out, "REGRESSION")) << worse.out;
    EXPECT_TRUE(contains(worse.out, "2 times and sizes, 1 above the tolerance of 0.1")) << worse.out;
    EXPECT_EQ(relief({"bench", "--compare", runs.before, runs.after, "--tolerance", "0.25"}).exitCode, 0);
    EXPECT_EQ(relief({"bench", "--compare", runs.after, runs.before}).exitCode, 0);
}

TEST(Bench, refusesWordsAndFilesThatMakeNoSense) {
    const TwoRuns runs;
    expectRefused(relief({"bench", "--compare", runs.before, runs.folder / "no.json"}), Failure::file, {"no.json"});
    putFile(runs.after, "{}");
    expectRefused(relief({"bench", "--compare", runs.before, runs.after}), Failure::input,
                  {"after.json", "relief-bench"});
    expectRefused(relief({"bench", "bandwith"}), Failure::usage,
                  {"bandwith is not one of bandwidth, frame", "did you mean bandwidth?"});
    expectRefused(relief({"bench", "--height", "map.exr"}), Failure::usage, {"--cage", "--height"});
    expectRefused(relief({"bench", "frame", "--json", runs.folder / "no/r.json"}), Failure::file, {"no/r.json"});
    expectRefused(relief({"bench", "frame", "--from", runs.before}), Failure::usage, {"--from"});
    // Results of an older relief.
    std::string old = readFile(runs.before);
    const std::string version = "\"version\": 2";
    old.replace(old.find(version), version.size(), "\"version\": 1");
    putFile(runs.after, old);
    expectRefused(relief({"bench", "--from", runs.after}), Failure::input,
                  {"after.json", "version 1", "measure again"});
}

TEST(Bench, fromPrintsResultsInAnotherForm) {
    const TwoRuns runs;
    const Outcome table = relief({"bench", "--from", runs.before});
    EXPECT_EQ(table.exitCode, 0) << table.err;
    EXPECT_TRUE(contains(table.out, "scaling: ball")) << table.out;
    expectDone(relief({"bench", "--from", runs.before, "--csv", runs.folder / "r.csv"}));
    EXPECT_TRUE(contains(readFile(runs.folder / "r.csv"),
                         "scaling,ball,grid,triangles,10000,frame time,ms,measured,3,10,10,10"));
}

/// A goal of the frame time of the grid, in milliseconds.
std::string makeGoals(const std::string& metric, double value) {
    return fmt::format(R"({{"schema": "relief-goals", "version": 1, "goals": [{{"name": "grid: frame", "metric": "{}",
        "subject": {{"suite": "scaling", "axis": "triangles", "methods": ["grid"], "statistic": "at largest"}},
        "comparison": "at most", "value": {}, "reason": "<it is far>"}}]}})",
                       metric, value);
}

TEST(Bench, reportsGoalsAsMetOrMissed) {
    const TwoRuns runs;
    const std::string goals = runs.folder / "goals.json", report = runs.folder / "r.html";
    putFile(goals, makeGoals("frame time", 11));
    const Outcome met = relief({"bench", "--from", runs.before, "--goals", goals});
    EXPECT_EQ(met.exitCode, 0) << met.err;
    EXPECT_TRUE(contains(met.out, "goal met: 10 ms, wanted at most 11 ms: grid: frame (ball)")) << met.out;
    EXPECT_TRUE(contains(relief({"bench", "--from", runs.after, "--goals", goals}).out, "goal missed: 12 ms"));
    expectDone(relief({"bench", "--from", runs.after, "--goals", goals, "--report", report}));
    EXPECT_TRUE(contains(readFile(report), "Figures to reach"));
    EXPECT_TRUE(contains(readFile(report), "&lt;it is far&gt;"));
    // Without a file of goals there are none.
    EXPECT_FALSE(contains(relief({"bench", "--from", runs.before}).out, "goal"));
}

TEST(Bench, refusesGoalsThatItDoesNotUnderstandBeforeItMeasures) {
    const TwoRuns runs;
    const std::string goals = runs.folder / "goals.json";
    expectRefused(relief({"bench", "frame", "--goals", goals}), Failure::file, {"goals.json"});
    putFile(goals, makeGoals("speed", 1));
    expectRefused(relief({"bench", "frame", "--goals", goals}), Failure::input,
                  {"goals.json", "goal 0", "\"speed\" is no metric"});
    expectRefused(relief({"bench", "--compare", runs.before, runs.after, "--goals", goals}), Failure::usage,
                  {"--goals"});
}

/// The page as a headless browser sees it, and the messages of its console.
struct Seen {
    std::string page, messages;
};
Seen openInBrowser(const std::string& path, const TemporaryFolder& folder) {
    const std::string command = fmt::format(
        "chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
        "--disable-component-update --disable-sync --enable-logging=stderr --user-data-dir={0}/profile "
        "--window-size=400,900 "
        "--dump-dom file://{1} >{0}/page 2>{0}/messages",
        folder.path.string(), path);
    EXPECT_EQ(std::system(command.c_str()), 0) << readFile(folder / "messages");
    return {readFile(folder / "page"), readFile(folder / "messages")};
}

/// Everything that a quick run writes. No time is tested.
TEST(Bench, quickRunsEverySuiteAndItsReportOpensInABrowser) {
    unsetenv("RELIEF_DATA"); // the project's own cage
    const TemporaryFolder folder;
    const std::string json = folder / "r.json", csv = folder / "r.csv", report = folder / "r.html";
    expectDone(relief({"bench", "--quick", "-q", "--goals", RELIEF_SOURCE "/bench/goals.json", "--json", json, "--csv",
                       csv, "--report", report}));
    const Results results = parseResults(readFile(json), json);
    for (const Suite suite : allSuites()) {
        EXPECT_TRUE(std::ranges::any_of(results.rows, [&](const Row& row) { return row.suite == suite; }))
            << toWord(suite);
    }
    for (const Row& row : results.rows) {
        if (row.suite != Suite::bandwidth) continue;
        EXPECT_LE(row.get(Metric::rmsError, 1), 1.02 * row.at) << toWord(row.method);
    }
    EXPECT_GT(std::ranges::count(readFile(csv), '\n'), 100);

    if (std::system("chromium --version >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "chromium is not installed: the report is not opened";
    const Seen seen = openInBrowser(report, folder);
    EXPECT_FALSE(contains(seen.messages, "CONSOLE")) << seen.messages;
    for (const char* part : {"<h2>Figures to reach</h2>", "<h2>Bytes at equal error</h2>", "<h2>Break-even</h2>",
                             "<h2>Pictures at equal error</h2>"})
        EXPECT_TRUE(contains(seen.page, part)) << part;
    std::size_t plots = 0;
    for (std::size_t at = 0; (at = seen.page.find("class=\"plot\"", at)) != std::string::npos; ++at) ++plots;
    EXPECT_GE(plots, 12u);
}

} // namespace
} // namespace relief::test
