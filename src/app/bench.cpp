#include <algorithm>
#include <filesystem>
#include <iostream>

#include "app/commands.h"
#include "app/object_options.h"
#include "app/output.h"
#include "app/picture_options.h"
#include "measure/measure.h"

namespace relief::app {
namespace {

struct BenchArgs {
    std::vector<std::string> suites;
    ObjectDesc object; ///< the cage and map to measure instead of the built-in ones
    std::string json, csv, report, from, device;
    std::vector<std::string> compared;
    double tolerance = 0.1;
    bool isQuick = false, isQuiet = false;
    ShowProgress progress = ShowProgress::automatic;
};

Results readResults(const std::string& path) { return parseResults(readFile(path), path); }

// --- --compare

std::string lineOf(const Change& change) {
    const std::string place = change.axis.empty() ? "" : fmt::format(" at {} {:g}", change.axis, change.at);
    return fmt::format("{:6.3f} x ({:.3f} to {:.3f})  {}: {}, {}{}: {}, {}: {:.6g} to {:.6g}{}\n", change.ratio,
                       change.low, change.high, change.suite, change.scene, change.contestant, place, change.name,
                       change.unit, change.before, change.after, change.isRegression ? "  REGRESSION" : "");
}

/// The worst first; 6 when one is past the tolerance.
int compare(const BenchArgs& args) {
    Comparison comparison =
        compareResults(readResults(args.compared[0]), readResults(args.compared[1]), args.tolerance);
    if (comparison.changes.empty())
        fail(Failure::input, "{} and {} have no suite in common", args.compared[0], args.compared[1]);
    std::ranges::stable_sort(comparison.changes, std::ranges::greater(), &Change::ratio);
    for (const Change& change : comparison.changes) std::cout << lineOf(change);
    if (!args.isQuiet)
        for (const std::string& warning : comparison.warnings) warnOnStderr(warning);
    if (!args.isQuiet)
        for (const std::string& row : comparison.onlyInOne) warnOnStderr("only in one of them: " + row);
    const auto regressions = std::ranges::count_if(comparison.changes, &Change::isRegression);
    std::cout << fmt::format("{} times and sizes, {} past a tolerance of {:g}\n", comparison.changes.size(),
                             regressions, args.tolerance);
    return comparison.hasRegression() ? int(Failure::check) : 0;
}

// --- measuring

/// The user's own cage and map, or those that come with the program.
std::vector<Subject> subjectsOf(const BenchArgs& args) {
    if (args.object.cage.empty()) return builtInSubjects(args.isQuick);
    LoadedObject loaded = load(args.object, CageState::posed, makeWarn(args.isQuiet));
    if (loaded.dense)
        fail(Failure::usage, "{}: only a subdivision surface is measured; name its --scheme", args.object.cage);
    const std::string name = std::filesystem::path(args.object.cage).stem().string();
    return {{name, std::move(loaded.cage), loaded.options, std::move(*loaded.height)}};
}

void checkUsage(const BenchArgs& args) {
    if (args.object.cage.empty() != args.object.height.path.empty())
        fail(Failure::usage, "--cage and --height go together: displacement is what is measured");
    if (!args.from.empty() && !args.suites.empty())
        fail(Failure::usage, "--from has results already: it measures no suite");
}

int bench(BenchArgs args) {
    if (!args.compared.empty()) return compare(args);
    checkUsage(args);
    for (const std::string& path : {args.json, args.csv, args.report})
        if (!path.empty()) checkOutput(path, {args.from, args.object.cage, args.object.height.path});
    if (args.suites.empty()) args.suites = suiteNames();
    const Results results = !args.from.empty()
                                ? readResults(args.from)
                                : runSuites(args.suites, subjectsOf(args),
                                            {.isQuick = args.isQuick,
                                             .device = args.device,
                                             .program = std::filesystem::read_symlink("/proc/self/exe").string(),
                                             .progress = args.progress});
    if (!args.json.empty()) writeFile(args.json, jsonOf(results));
    if (!args.csv.empty()) writeFile(args.csv, csvOf(results));
    if (!args.report.empty()) writeFile(args.report, reportOf(results));
    if (args.json.empty() && args.csv.empty() && args.report.empty()) std::cout << tableOf(results);
    return 0;
}

void addFiles(CLI::App& app, BenchArgs& args) {
    const char* group = "results";
    app.add_option("--json", args.json, "every sample, as JSON in this file")->option_text("FILE")->group(group);
    app.add_option("--csv", args.csv, "a line a value, in this file")->option_text("FILE")->group(group);
    app.add_option("--report", args.report, "one HTML page with plots and pictures")->option_text("FILE")->group(group);
    app.add_option("--from", args.from, "no measuring: results that --json has written, to be told in another form")
        ->option_text("FILE")
        ->group(group);
    app.add_option("--compare", args.compared, "no measuring: ratios of the second results to the first")
        ->expected(2)
        ->option_text("FILE FILE")
        ->group(group);
    app.add_option("--tolerance", args.tolerance, "what --compare lets grow, as a share (0.1)")
        ->check(CLI::Range(0.0, 100.0))
        ->option_text("SHARE")
        ->group(group);
}

} // namespace

Run addBench(CLI::App& app) {
    auto args = std::make_shared<BenchArgs>();
    app.add_option("suites", args->suites, "bandwidth, frame, animate, memory, scaling, startup (all)")
        ->check(CLI::IsMember(suiteNames()))
        ->option_text("SUITE...");
    app.add_flag("--quick", args->isQuick, "small scenes, few rounds: half a minute, for a first look");
    app.add_option("--cage", args->object.cage, "a cage of your own (.obj), with its --height")->option_text("CAGE");
    addSurfaceOptions(app, args->object);
    addFiles(app, *args);
    addDevice(app, args->device);
    app.add_flag("-q,--quiet", args->isQuiet, "no warnings")->group("output");
    addProgress(app, args->progress);
    app.footer("What displacement costs and saves against dense meshes of the same error. Without a file to write, a\n"
               "table goes to stdout. The folder RELIEF_DATA may hold a larger built-in cage, bigguy.obj.\n"
               "--compare ends with 6 when a time or size has grown past the tolerance and its spread does not\n"
               "explain it.\n"
               "examples:\n"
               "  relief bench --report report.html --json results.json\n"
               "  relief bench frame scaling --quick\n"
               "  relief bench bandwidth --cage cage.obj --height map.exr --report mine.html\n"
               "  relief bench --compare before.json after.json --tolerance 0.05");
    return [args] { return bench(*args); };
}

} // namespace relief::app
