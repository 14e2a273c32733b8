// The suites `memory` and `startup`: what the process takes beside the buffers that it lists, and what a cold start
// costs.
#include <csignal>
#include <cstdlib>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "measure/parts.h"

namespace relief {
namespace {

struct Run {
    double milliseconds = 0;
    std::uint64_t peakBytes = 0;
};

/// Runs a program to its end, what it prints into a file, with Mesa's shader cache or without.
Run runProgram(const std::vector<std::string>& words, const std::string& output, bool isCold) {
    Run run;
    rusage usage{};
    int status = 0;
    run.milliseconds = millisecondsOf([&] {
        const pid_t child = fork();
        if (child == 0) {
            prctl(PR_SET_PDEATHSIG, SIGKILL); // an interrupt ends both
            if (isCold) setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
            const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
            if (file < 0 || dup2(file, STDOUT_FILENO) < 0) _exit(127);
            std::vector<char*> arguments;
            arguments.reserve(words.size() + 1);
            for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
            arguments.push_back(nullptr);
            execv(arguments[0], arguments.data());
            _exit(127);
        }
        if (child > 0) wait4(child, &status, 0, &usage);
    });
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    const bool isOfDevice = code == int(Failure::device); // it has said why
    if (code != 0)
        fail(isOfDevice ? Failure::device : Failure::internal, "{} {} ended with exit code {}", words[0], words[1],
             code);
    run.peakBytes = std::uint64_t(usage.ru_maxrss) * 1024;
    return run;
}

/// A subject in files, for a process of its own.
class RenderRuns {
public:
    RenderRuns(const Bench& bench, const Subject& subject) : bench_(bench), subject_(subject) {
        writeObj(folder_ / "cage.obj", subject.cage);
        writeImage(folder_ / "map.exr", {subject.height.width, subject.height.height, 1, subject.height.texels},
                   SampleType::real);
    }

    /// `relief render` with these further words; what it says of itself goes into `said`.
    Run render(std::vector<std::string> more, bool isCold, nlohmann::json* said = nullptr) const {
        std::vector<std::string> words{bench_.options.program, "render", folder_ / "cage.obj"};
        const HeightMap& map = subject_.height;
        const double unit = subject_.cage.coordinates.unit; // of the map; the files are in the world's
        for (const auto& [option, value] : {std::pair<const char*, std::string>{"--height", folder_ / "map.exr"},
                                            {"--scale", fmt::format("{}", map.scale * unit)},
                                            {"--mid", fmt::format("{}", map.mid)},
                                            {"--wrap", map.wrap == Wrap::repeat ? "repeat" : "clamp"},
                                            {"--isolation", fmt::format("{}", subject_.surface.isolation)},
                                            {"--device", bench_.options.device},
                                            {"-o", folder_ / "picture.png"}})
            if (!value.empty()) words.insert(words.end(), {option, value});
        words.insert(words.end(), {"--no-shadows", "-q", "--json"});
        words.insert(words.end(), more.begin(), more.end());
        const Run run = runProgram(words, folder_ / "said.json", isCold);
        if (said != nullptr) *said = nlohmann::json::parse(readFile(folder_ / "said.json"));
        return run;
    }

private:
    const Bench& bench_;
    const Subject& subject_;
    ScratchFolder folder_;
};

/// A frame of many triangles in a process of its own, less what the same frame of few takes: how much of the growth is
/// in the buffers that are listed.
void measureFrameMemory(Bench& bench, const Subject& subject, const RenderRuns& runs, const std::string& path,
                        int rate) {
    nlohmann::json few, many;
    const std::uint64_t fewPeak = runs.render({"--path", path, "--rate", "1"}, false, &few).peakBytes;
    const std::uint64_t manyPeak =
        runs.render({"--path", path, "--rate", fmt::format("{}", rate)}, false, &many).peakBytes;
    Row row{.suite = "memory", .scene = subject.name, .contestant = path == "dice" ? "dicing" : path};
    const double listed = many.at("peak_device_bytes"), listedFew = few.at("peak_device_bytes");
    const double grown = double(manyPeak) - double(fewPeak);
    row.add("triangles", "triangles", Origin::measured, many.at("triangles").get<double>());
    row.add("surface and map", "bytes", Origin::measured, many.at("device_bytes").get<double>());
    row.add("all buffers", "bytes", Origin::measured, listed);
    row.add("all buffers, rate 1", "bytes", Origin::measured, listedFew);
    row.add("process at most", "bytes", Origin::measured, double(manyPeak));
    row.add("process at most, rate 1", "bytes", Origin::measured, double(fewPeak));
    row.add("grown and first buffers to all buffers", "ratio", Origin::computed, (grown + listedFew) / listed);
    bench.results.rows.push_back(row);
}

} // namespace

void measureMemory(Bench& bench, const Subject& subject) {
    const RenderRuns runs(bench, subject);
    const int rate = OnDevice(bench.device, subject).rateFor(bench.options.isQuick ? 1e5 : 1e7);
    measureFrameMemory(bench, subject, runs, "dice", rate);
    measureFrameMemory(bench, subject, runs, "grid", rate);
    bench.progress.advance();
}

void measureStartup(Bench& bench, const Subject& subject) {
    const RenderRuns runs(bench, subject);
    const OnDevice on(bench.device, subject);
    Renderer renderer(bench.device, {.width = 1024, .height = 1024});
    RenderOptions options = on.renderOptions(1);
    const std::string pixels = bench.options.isQuick ? "16" : "4";
    options.rate.reset();
    options.edgePixels = std::stod(pixels);
    if (!bench.device.traits().hasTessellation) options.path = Path::grid;
    renderer.render(on.model, options);
    std::vector<double> cold, cached, frame, tables, device, peak;
    for (int round = 0; round < (bench.options.isQuick ? 1 : 2); ++round) {
        const Run first = runs.render({"--edge-pixels", pixels}, true);
        cold.push_back(first.milliseconds);
        peak.push_back(double(first.peakBytes));
        cached.push_back(runs.render({"--edge-pixels", pixels}, false).milliseconds);
        device.push_back(millisecondsOf([&] { const Device another({.name = bench.options.device}); }));
        tables.push_back(1e3 * buildSurface(subject.cage, subject.surface).tableSeconds);
        frame.push_back(renderer.render(on.model, options).stats.wallMs);
    }
    Row row{.suite = "startup", .scene = subject.name, .contestant = "relief render"};
    row.add("whole run, no cached shaders", "ms", cold);
    row.add("whole run, cached shaders", "ms", cached);
    row.add("of it: OpenSubdiv's tables", "ms", tables);
    row.add("of it: opening the device", "ms", device);
    row.add("its frame when warm", "ms", frame);
    row.add("peak memory", "bytes", peak);
    row.add("(cold - tables) to frame", "ratio", Origin::computed,
            (spreadOf(cold).median - spreadOf(tables).median) / spreadOf(frame).median);
    bench.results.rows.push_back(row);
    bench.progress.advance();
}

} // namespace relief
