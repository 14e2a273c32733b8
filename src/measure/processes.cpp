// The suites `memory` and `startup`: what the process takes beside the buffers that it lists, and what a cold start
// costs.
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <malloc.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "measure/parts.h"

namespace relief {
namespace {

/// A line of /proc/self/status in bytes; 0 where there is none.
std::uint64_t statusBytes(const std::string& name) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (std::uint64_t kib = 0; word == name + ":" && status >> kib) return kib * 1024;
    return 0;
}

/// From now on the peak of resident memory counts anew; false where the system cannot.
bool resetPeak() {
    std::ofstream file("/proc/self/clear_refs");
    file << 5 << std::flush;
    return file.good();
}

/// A frame of so many triangles: the buffers it lists, and by how much the process grows.
void measureFrameMemory(Bench& bench, const Subject& subject, Path path, const char* name) {
    malloc_trim(0);
    if (!resetPeak()) {
        bench.results.notes.emplace_back("memory: the system does not tell the peak of resident memory");
        return;
    }
    const std::uint64_t before = statusBytes("VmRSS"), allocatedBefore = bench.device.allocatedBytes();
    const OnDevice on(bench.device, subject);
    Row row{.suite = "memory", .scene = subject.name, .contestant = name};
    const std::uint64_t model = bench.device.allocatedBytes() - allocatedBefore;
    Renderer renderer(bench.device, {.width = bench.pictureSide(), .height = bench.pictureSide(), .shadowSide = 1});
    const std::uint64_t targets = bench.device.allocatedBytes() - allocatedBefore - model;
    RenderOptions options = on.renderOptions(on.rateFor(bench.options.isQuick ? 3e5 : 1e7));
    options.path = path;
    malloc_trim(0);
    bench.device.startPeak();
    const FrameStats stats = renderer.render(on.model, options).stats;
    const std::uint64_t listed = bench.device.peakBytes() - allocatedBefore;
    const std::uint64_t peak = statusBytes("VmHWM"), grown = peak - std::min(before, peak);
    row.add("triangles", "triangles", Origin::measured, double(stats.triangleCount));
    row.add("surface and map", "bytes", Origin::measured, double(model));
    row.add("picture", "bytes", Origin::measured, double(targets));
    row.add("this frame's buffers", "bytes", Origin::measured, double(listed - model - targets));
    row.add("all buffers", "bytes", Origin::measured, double(listed));
    row.add("grown by", "bytes", Origin::measured, double(grown));
    row.add("process before", "bytes", Origin::measured, double(before));
    row.add("grown to listed", "ratio", Origin::measured, double(grown) / double(listed));
    bench.results.rows.push_back(row);
}

struct Run {
    double milliseconds = 0;
    std::uint64_t peakBytes = 0;
};

/// Runs a program to its end, with Mesa's shader cache or without.
Run runProgram(const std::vector<std::string>& words, bool isCold) {
    Run run;
    rusage usage{};
    int status = 0;
    run.milliseconds = millisecondsOf([&] {
        const pid_t child = fork();
        if (child == 0) {
            if (isCold) setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
            std::vector<char*> arguments;
            for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
            arguments.push_back(nullptr);
            execv(arguments[0], arguments.data());
            _exit(127);
        }
        if (child > 0) wait4(child, &status, 0, &usage);
    });
    if (status != 0) fail(Failure::internal, "{} ended with status {}", words[0], status);
    run.peakBytes = std::uint64_t(usage.ru_maxrss) * 1024;
    return run;
}

/// The command line of a whole `relief render` of the subject.
std::vector<std::string> renderWords(const Bench& bench, const Subject& subject, const ScratchFolder& folder) {
    writeObj(folder / "cage.obj", subject.cage);
    writeImage(folder / "map.exr", {subject.height.width, subject.height.height, 1, subject.height.texels},
               SampleType::real);
    std::vector<std::string> words{bench.options.program, "render", folder / "cage.obj", "--height",
                                   folder / "map.exr"};
    for (const std::string& word :
         {std::string("--scale"), fmt::format("{}", subject.height.scale), std::string("--mid"),
          fmt::format("{}", subject.height.mid), std::string("--edge-pixels"), std::string("4"),
          std::string("--no-shadows"), std::string("-q"), std::string("-o")})
        words.push_back(word);
    words.push_back(folder / "picture.png");
    return words;
}

} // namespace

void measureMemory(Bench& bench, const Subject& subject) {
    measureFrameMemory(bench, subject, Path::dice, "dicing");
    measureFrameMemory(bench, subject, Path::grid, "grid");
    bench.progress.advance();
}

void measureStartup(Bench& bench, const Subject& subject) {
    const ScratchFolder folder;
    const std::vector<std::string> words = renderWords(bench, subject, folder);
    const OnDevice on(bench.device, subject);
    Renderer renderer(bench.device, {.width = 1024, .height = 1024});
    RenderOptions options = on.renderOptions(1);
    options.rate.reset();
    options.edgePixels = 4;
    renderer.render(on.model, options);
    std::vector<double> cold, cached, frame, tables, device, peak;
    for (int round = 0; round < (bench.options.isQuick ? 1 : 5); ++round) {
        const Run first = runProgram(words, true);
        cold.push_back(first.milliseconds);
        peak.push_back(double(first.peakBytes));
        cached.push_back(runProgram(words, false).milliseconds);
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
