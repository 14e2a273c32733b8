// relief bench as a user runs it: files, comparisons and their exit code, the report in a browser.
#include "measure/measure.h"
#include "program.h"

namespace relief::test {
namespace {

Results resultsOf(double milliseconds) {
    Results results;
    Row row{"scaling", "ball", "grid", "triangles", 1e4, {}};
    row.add("frame", "ms", {milliseconds, milliseconds, milliseconds});
    row.add("resident", "bytes", Origin::measured, 4096);
    results.rows = {row};
    return results;
}

/// Two files of results, the second slower.
struct TwoRuns {
    TemporaryFolder folder;
    std::string before = folder / "before.json", after = folder / "after.json";

    TwoRuns() {
        putFile(before, jsonOf(resultsOf(10)));
        putFile(after, jsonOf(resultsOf(12)));
    }
};

TEST(Bench, compareEndsWithSixOnARegressionPastTheTolerance) {
    const TwoRuns runs;
    const Outcome worse = relief({"bench", "--compare", runs.before, runs.after});
    EXPECT_EQ(worse.exitCode, int(Failure::check)) << worse.err;
    EXPECT_TRUE(contains(worse.out, "1.200 x")) << worse.out;
    EXPECT_TRUE(contains(worse.out, "REGRESSION")) << worse.out;
    EXPECT_TRUE(contains(worse.out, "2 times and sizes, 1 past a tolerance of 0.1")) << worse.out;
    EXPECT_EQ(relief({"bench", "--compare", runs.before, runs.after, "--tolerance", "0.25"}).exitCode, 0);
    EXPECT_EQ(relief({"bench", "--compare", runs.after, runs.before}).exitCode, 0);
}

TEST(Bench, whatMakesNoSenseIsRefused) {
    const TwoRuns runs;
    expectRefused(relief({"bench", "--compare", runs.before, runs.folder / "no.json"}), Failure::file, {"no.json"});
    putFile(runs.after, "{}");
    expectRefused(relief({"bench", "--compare", runs.before, runs.after}), Failure::input,
                  {"after.json", "relief-bench"});
    expectRefused(relief({"bench", "bandwith"}), Failure::usage, {"bandwith"});
    expectRefused(relief({"bench", "--height", "map.exr"}), Failure::usage, {"--cage", "--height"});
    expectRefused(relief({"bench", "frame", "--json", runs.folder / "no/r.json"}), Failure::file, {"no/r.json"});
    expectRefused(relief({"bench", "frame", "--from", runs.before}), Failure::usage, {"--from"});
}

TEST(Bench, fromTellsResultsInAnotherForm) {
    const TwoRuns runs;
    const Outcome table = relief({"bench", "--from", runs.before});
    EXPECT_EQ(table.exitCode, 0) << table.err;
    EXPECT_TRUE(contains(table.out, "scaling: ball")) << table.out;
    expectDone(relief({"bench", "--from", runs.before, "--csv", runs.folder / "r.csv"}));
    EXPECT_TRUE(
        contains(readFile(runs.folder / "r.csv"), "scaling,ball,grid,triangles,10000,frame,ms,measured,3,10,10,10"));
}

/// What a headless browser prints of a page, and what it complains of.
struct Seen {
    std::string page, complaints;
};
Seen inBrowser(const std::string& path, const TemporaryFolder& folder) {
    const std::string command = fmt::format(
        "chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
        "--disable-component-update --disable-sync --enable-logging=stderr --user-data-dir={0}/profile "
        "--window-size=400,900 "
        "--dump-dom file://{1} >{0}/page 2>{0}/complaints",
        folder.path.string(), path);
    EXPECT_EQ(std::system(command.c_str()), 0) << readFile(folder / "complaints");
    return {readFile(folder / "page"), readFile(folder / "complaints")};
}

/// Everything that a quick run writes; nothing is judged by how long it took.
TEST(Bench, quickRunsEverySuiteAndItsReportOpensInABrowser) {
    unsetenv("RELIEF_DATA"); // the project's own cage
    const TemporaryFolder folder;
    const std::string json = folder / "r.json", csv = folder / "r.csv", report = folder / "r.html";
    expectDone(relief({"bench", "--quick", "-q", "--json", json, "--csv", csv, "--report", report}));
    const Results results = parseResults(readFile(json), json);
    for (const std::string& suite : suiteNames()) {
        EXPECT_TRUE(std::ranges::any_of(results.rows, [&](const Row& row) { return row.suite == suite; })) << suite;
    }
    for (const Row& row : results.rows) {
        if (row.suite != "bandwidth") continue;
        EXPECT_LE(row.get("rms", 1), 1.02 * row.at) << row.contestant;
    }
    EXPECT_GT(std::ranges::count(readFile(csv), '\n'), 100);

    if (std::system("chromium --version >/dev/null 2>&1") != 0)
        GTEST_SKIP() << "chromium is not here to open the report";
    const Seen seen = inBrowser(report, folder);
    EXPECT_FALSE(contains(seen.complaints, "CONSOLE")) << seen.complaints;
    for (const char* part : {"<h2>Bytes at equal error</h2>", "<h2>Break-even</h2>", "Both sides, and what differs"})
        EXPECT_TRUE(contains(seen.page, part)) << part;
    std::size_t plots = 0;
    for (std::size_t at = 0; (at = seen.page.find("class=\"plot\"", at)) != std::string::npos; ++at) ++plots;
    EXPECT_GE(plots, 12u);
}

} // namespace
} // namespace relief::test
