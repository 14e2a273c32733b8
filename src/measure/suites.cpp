#include <algorithm>
#include <ctime>
#include <fstream>
#include <thread>

#include <malloc.h>
#include <sys/utsname.h>

#include "measure/embedded.h"
#include "measure/suite.h"

namespace relief {
namespace {

struct SuiteEntry {
    Suite suite;
    void (*measure)(SuiteContext&, const TestScene&);
    bool isForAllScenes;
    std::uint64_t steps; ///< of progress, per scene
};

/// In the order in which they run. Those that start processes come first: the peak memory of a child process includes
/// what this process holds when it forks.
constexpr SuiteEntry kSuiteEntries[] = {
    {Suite::memory, measureMemory, false, 1},   {Suite::startup, measureStartup, false, 1},
    {Suite::frame, measureFrame, false, 1},     {Suite::scaling, measureScaling, false, 11},
    {Suite::animate, measureAnimate, false, 1}, {Suite::bandwidth, measureBandwidth, true, 4},
    {Suite::detail, measureDetail, false, 5},   {Suite::light, measureLight, false, 1},
};

std::string readProcessorName() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name") && line.find(':') != std::string::npos)
            return line.substr(line.find(':') + 2);
    return "unknown";
}

std::string readMemorySize() {
    std::ifstream file("/proc/meminfo");
    std::string word;
    std::uint64_t kib = 0;
    return file >> word >> kib ? humanBytes(kib * 1024) : "unknown";
}

std::string formatTimeInUtc() {
    const std::time_t now = std::time(nullptr);
    char text[32] = {};
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    return text;
}

/// Fills in what the results say of the program, the machine, the device and the scenes.
void addDescriptions(Results& results, const DeviceTraits& traits, const MeasureOptions& options,
                     std::span<const TestScene> scenes) {
    utsname system{};
    uname(&system);
    results.program = {{"name", "relief"}, {"commit", kCommit}, {"time", formatTimeInUtc()}};
    results.machine = {{"processor", readProcessorName()},
                       {"threads", fmt::format("{}", std::thread::hardware_concurrency())},
                       {"memory", readMemorySize()},
                       {"system", fmt::format("{} {}", system.sysname, system.release)}};
    results.device = {{"name", traits.name},
                      {"driver", traits.driver},
                      {"vulkan", traits.api},
                      {"times passes", traits.timestampNanoseconds > 0 ? "yes" : "no"},
                      {"counts invocations", traits.countsPipeline ? "yes" : "no"}};
    results.settings = {{"quick", options.isQuick ? "yes" : "no"}};
    for (const TestScene& scene : scenes)
        results.settings["scene " + scene.name] =
            fmt::format("{} faces, isolation {}, map {} x {}, displacement bound {:.4g} of the diagonal",
                        scene.cage.faceCount(), scene.surface.isolation, scene.height.width, scene.height.height,
                        scene.height.heightBound() / computeDiagonal(scene.cage));
}

} // namespace

Results runSuites(std::span<const Suite> suites, std::span<const TestScene> scenes, const MeasureOptions& options) {
    if (scenes.empty()) fail(Failure::input, "there is no scene to measure");
    Results results;
    Device device({.name = options.device});
    addDescriptions(results, device.traits(), options, scenes);

    // Progress counts the steps of all wanted suites.
    const auto isWanted = [&](const SuiteEntry& entry) {
        return std::ranges::find(suites, entry.suite) != suites.end();
    };
    const auto selectScenes = [&](const SuiteEntry& entry) {
        return entry.isForAllScenes && !options.isQuick ? scenes : scenes.first(1);
    };
    std::uint64_t steps = 0;
    for (const SuiteEntry& entry : kSuiteEntries)
        if (isWanted(entry)) steps += entry.steps * selectScenes(entry).size();
    Progress progress("measuring", std::max<std::uint64_t>(steps, 1), options.progress);

    // The suites, with the seconds that each takes.
    SuiteContext context{device, options, results, progress};
    for (const SuiteEntry& entry : kSuiteEntries) {
        if (!isWanted(entry)) continue;
        const double ms = measureMilliseconds([&] {
            for (const TestScene& scene : selectScenes(entry)) entry.measure(context, scene);
        });
        results.settings[fmt::format("seconds of {}", toWord(entry.suite))] = fmt::format("{:.0f}", ms / 1e3);
        malloc_trim(0); // the next suite starts without the memory of this one
    }
    if (const std::size_t count = device.validationMessages().size(); count > 0)
        fail(Failure::internal, "the Vulkan validation layer reports {} messages", count);
    return results;
}

} // namespace relief
