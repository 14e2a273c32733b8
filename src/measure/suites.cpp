#include <algorithm>
#include <chrono>
#include <ctime>
#include <fstream>
#include <thread>

#include <malloc.h>
#include <sys/utsname.h>

#include "measure/embedded.h"
#include "measure/parts.h"

namespace relief {
namespace {

struct Suite {
    const char* name;
    void (*measure)(Bench&, const Subject&);
    bool isForAllSubjects;
    std::uint64_t steps; ///< of progress, a subject
};

/// Those that start processes come first: the peak memory of a child counts from what this process holds when it forks.
constexpr Suite kSuites[] = {
    {"memory", measureMemory, false, 1},   {"startup", measureStartup, false, 1},
    {"frame", measureFrame, false, 1},     {"scaling", measureScaling, false, 11},
    {"animate", measureAnimate, false, 1}, {"bandwidth", measureBandwidth, true, 4},
};

std::string processorName() {
    std::ifstream file("/proc/cpuinfo");
    for (std::string line; std::getline(file, line);)
        if (line.starts_with("model name") && line.find(':') != std::string::npos)
            return line.substr(line.find(':') + 2);
    return "unknown";
}

std::string memorySize() {
    std::ifstream file("/proc/meminfo");
    std::string word;
    std::uint64_t kib = 0;
    return file >> word >> kib ? humanBytes(kib * 1024) : "unknown";
}

std::string nowInUtc() {
    const std::time_t now = std::time(nullptr);
    char text[32] = {};
    std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", std::gmtime(&now));
    return text;
}

void describe(Results& results, const DeviceTraits& traits, const MeasureOptions& options,
              std::span<const Subject> subjects) {
    utsname system{};
    uname(&system);
    results.program = {{"name", "relief"}, {"commit", kCommit}, {"time", nowInUtc()}};
    results.machine = {{"processor", processorName()},
                       {"threads", fmt::format("{}", std::thread::hardware_concurrency())},
                       {"memory", memorySize()},
                       {"system", fmt::format("{} {}", system.sysname, system.release)}};
    results.device = {{"name", traits.name},
                      {"driver", traits.driver},
                      {"vulkan", traits.api},
                      {"times passes", traits.timestampNanoseconds > 0 ? "yes" : "no"},
                      {"counts calls", traits.countsPipeline ? "yes" : "no"}};
    results.settings = {{"quick", options.isQuick ? "yes" : "no"}};
    for (const Subject& subject : subjects)
        results.settings["scene " + subject.name] =
            fmt::format("{} faces, isolation {}, map {} x {}, reach {:.4g} of the diagonal", subject.cage.faceCount(),
                        subject.surface.isolation, subject.height.width, subject.height.height,
                        subject.height.heightBound() / diagonalOf(subject.cage));
}

} // namespace

const std::vector<std::string>& suiteNames() {
    static const std::vector<std::string> names{"bandwidth", "frame", "animate", "memory", "scaling", "startup"};
    return names;
}

Results runSuites(std::span<const std::string> suites, std::span<const Subject> subjects,
                  const MeasureOptions& options) {
    Results results;
    Device device({.name = options.device});
    describe(results, device.traits(), options, subjects);
    std::uint64_t steps = 0;
    const auto isWanted = [&](const Suite& suite) { return std::ranges::find(suites, suite.name) != suites.end(); };
    const auto subjectsOf = [&](const Suite& suite) {
        return suite.isForAllSubjects && !options.isQuick ? subjects : subjects.first(1);
    };
    for (const Suite& suite : kSuites)
        if (isWanted(suite)) steps += suite.steps * subjectsOf(suite).size();
    Progress progress("measuring", std::max<std::uint64_t>(steps, 1), options.progress);
    Bench bench{device, options, results, progress};
    for (const Suite& suite : kSuites) {
        if (!isWanted(suite)) continue;
        const double ms = millisecondsOf([&] {
            for (const Subject& subject : subjectsOf(suite)) suite.measure(bench, subject);
        });
        results.settings[fmt::format("seconds of {}", suite.name)] = fmt::format("{:.0f}", ms / 1e3);
        malloc_trim(0);
    }
    if (const std::size_t count = device.validationMessages().size(); count > 0)
        fail(Failure::internal, "the Vulkan validation layer has {} complaints", count);
    return results;
}

} // namespace relief
