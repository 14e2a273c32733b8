#include <algorithm>
#include <filesystem>
#include <iostream>

#include "app/commands.h"
#include "app/object_options.h"
#include "app/options.h"
#include "app/output.h"
#include "app/picture_options.h"
#include "app/render_process.h"
#include "measure/measure.h"

namespace relief::app {
namespace {

struct BenchArgs {
    std::vector<std::string> suites;
    ObjectDesc object; ///< the cage and map to measure instead of the built-in ones
    std::string json, csv, report, from, goals, device;
    std::vector<std::string> compared;
    double tolerance = 0.1;
    bool isQuick = false, isQuiet = false;
    ShowProgress progress = ShowProgress::automatic;
};

Results readResults(const std::string& path) { return parseResults(readFile(path), path); }

// --- --compare

std::string formatChange(const Change& change) {
    const std::string place =
        change.axis == Axis::none ? "" : fmt::format(" at {} {:g}", toWord(change.axis), change.at);
    const MetricInfo& metric = describe(change.metric);
    return fmt::format("{:6.3f} x ({:.3f} to {:.3f})  {}: {}, {}{}: {}, {}: {:.6g} to {:.6g}{}\n", change.ratio,
                       change.low, change.high, toWord(change.suite), change.scene, toWord(change.method), place,
                       metric.name, toWord(metric.unit), change.before, change.after,
                       change.isRegression ? "  REGRESSION" : "");
}

/// Prints all changes, the largest growth first. Returns 6 where one of them is a regression, else 0.
int compare(const BenchArgs& args) {
    Comparison comparison =
        compareResults(readResults(args.compared[0]), readResults(args.compared[1]), args.tolerance);
    if (comparison.changes.empty())
        fail(Failure::input, "{} and {} have no suite in common", args.compared[0], args.compared[1]);
    std::ranges::stable_sort(comparison.changes, std::ranges::greater(), &Change::ratio);
    for (const Change& change : comparison.changes) std::cout << formatChange(change);
    if (!args.isQuiet)
        for (const std::string& warning : comparison.warnings) warnOnStderr(warning);
    if (!args.isQuiet)
        for (const std::string& row : comparison.onlyInOne) warnOnStderr("only in one of them: " + row);
    const auto regressions = std::ranges::count_if(comparison.changes, &Change::isRegression);
    std::cout << fmt::format("{} times and sizes, {} above the tolerance of {:g}\n", comparison.changes.size(),
                             regressions, args.tolerance);
    return comparison.hasRegression() ? int(Failure::check) : 0;
}

// --- measuring

/// The user's own cage and map, or the scenes that are built in.
std::vector<TestScene> loadScenes(const BenchArgs& args) {
    if (args.object.cage.empty()) return makeBuiltInScenes(args.isQuick);
    LoadedObject loaded = load(args.object, CageState::posed, makeWarn(args.isQuiet));
    if (loaded.dense)
        fail(Failure::usage, "{}: only a subdivision surface is measured; name its --scheme", args.object.cage);
    if (loaded.height->addressing != Addressing::texture)
        fail(Failure::usage, "{}: maps of one file over the unit square are measured, no sets of tiles",
             args.object.height.path);
    const std::string name = std::filesystem::path(args.object.cage).stem().string();
    return {
        {name, std::move(loaded.cage), loaded.options, std::move(*loaded.height), std::move(loaded.heightEncoding)}};
}

Results measure(const BenchArgs& args) {
    std::vector<Suite> suites(allSuites().begin(), allSuites().end());
    if (!args.suites.empty()) suites.clear();
    for (const std::string& word : args.suites) suites.push_back(parseSuite(word));
    const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
    return runSuites(
        suites, loadScenes(args),
        {.isQuick = args.isQuick,
         .device = args.device,
         .makeRenderProcess = [&](const TestScene& scene) { return makeRenderProcess(program, args.device, scene); },
         .progress = args.progress});
}

void checkUsage(const BenchArgs& args) {
    if (!args.object.height.function.empty())
        fail(Failure::usage,
             "--height-function {}: what is measured is a map, its formats and its bytes, and a function has none of "
             "them; relief render --json prints the times of a picture with one",
             args.object.height.function);
    if (args.object.cage.empty() != args.object.height.path.empty())
        fail(Failure::usage, "--cage and --height go together: displacement is what is measured");
    if (!args.from.empty() && !args.suites.empty()) fail(Failure::usage, "--from reads results: it measures no suite");
}

int bench(const BenchArgs& args) {
    if (!args.compared.empty()) return compare(args);
    // All that can be wrong is found before anything is measured.
    checkUsage(args);
    for (const std::string& path : {args.json, args.csv, args.report})
        if (!path.empty()) checkOutput(path, {args.from, args.goals, args.object.cage, args.object.height.path});
    std::vector<Goal> goals;
    if (!args.goals.empty()) goals = parseGoals(readFile(args.goals), args.goals);

    const Results results = args.from.empty() ? measure(args) : readResults(args.from);
    if (!args.json.empty()) writeFile(args.json, toJson(results));
    if (!args.csv.empty()) writeFile(args.csv, toCsv(results));
    if (!args.report.empty()) writeFile(args.report, makeReport(results, goals));
    if (args.json.empty() && args.csv.empty() && args.report.empty()) std::cout << toTable(results, goals);
    return 0;
}

void addFiles(CLI::App& app, BenchArgs& args) {
    const char* group = "results";
    app.add_option("--json", args.json, "every sample, as JSON in this file")->option_text("FILE")->group(group);
    app.add_option("--csv", args.csv, "one line per value, in this file")->option_text("FILE")->group(group);
    app.add_option("--report", args.report, "one HTML page with plots and pictures")->option_text("FILE")->group(group);
    app.add_option("--from", args.from, "measure nothing: read results that --json has written")
        ->option_text("FILE")
        ->group(group);
    CLI::Option* goals =
        app.add_option("--goals", args.goals,
                       "figures to reach, reported as met or missed (JSON: see bench/goals.json of the source)");
    goals->option_text("FILE")->group(group);
    app.add_option("--compare", args.compared, "measure nothing: print the ratios of the second results to the first")
        ->expected(2)
        ->excludes(goals)
        ->option_text("FILE FILE")
        ->group(group);
    app.add_option("--tolerance", args.tolerance, "growth that is no regression for --compare, as a fraction (0.1)")
        ->check(CLI::Range(0.0, 100.0))
        ->option_text("FRACTION")
        ->group(group);
}

} // namespace

Run addBench(CLI::App& app) {
    // What is measured.
    auto args = std::make_shared<BenchArgs>();
    std::vector<WordHelp> suites;
    std::vector<std::string> names;
    for (const Suite suite : allSuites()) {
        suites.push_back({toWord(suite), ""});
        names.emplace_back(toWord(suite));
    }
    app.add_option("suites", args->suites, fmt::format("{} (all)", fmt::join(names, ", ")))
        ->check(oneOf(suites))
        ->option_text("SUITE...");
    app.add_flag("--quick", args->isQuick, "small scenes, few rounds: half a minute, for a first look");
    app.add_option("--cage", args->object.cage, "a cage of your own (.obj), with its --height")->option_text("CAGE");
    addSurfaceOptions(app, args->object);
    addHeightFunction(app, args->object.height);
    // Where results go, and how the run behaves.
    addFiles(app, *args);
    addDevice(app, args->device);
    app.add_flag("-q,--quiet", args->isQuiet, "no warnings")->group("output");
    addProgress(app, args->progress);
    app.footer("Measures what displacement costs and saves, compared with dense meshes of the same error. Without a\n"
               "file to write, a table goes to stdout. Where the folder RELIEF_DATA holds bigguy.obj, that cage is\n"
               "measured instead of the built-in one. --compare ends with 6 where a time or size has grown by more\n"
               "than the tolerance and the spread of the samples does not explain it.\n"
               "examples:\n"
               "  relief bench --report report.html --json results.json\n"
               "  relief bench frame scaling --quick\n"
               "  relief bench bandwidth --cage cage.obj --height map.exr --report mine.html\n"
               "  relief bench --compare before.json after.json --tolerance 0.05");
    return [args] { return bench(*args); };
}

} // namespace relief::app
