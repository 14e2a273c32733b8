#include "app/render_process.h"

#include <csignal>
#include <cstdlib>
#include <filesystem>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <nlohmann/json.hpp>

#include "base/clock.h"

namespace relief::app {
namespace {

/// The child's side of a fork: stdout goes into a file, then the program takes the place of this one.
[[noreturn]] void becomeProgram(std::vector<std::string>& words, const std::string& output, bool usesShaderCache) {
    prctl(PR_SET_PDEATHSIG, SIGKILL); // an interrupt ends both
    if (!usesShaderCache) {
        setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
        setenv("RELIEF_CACHE", "0", 1);
    }
    const int file = open(output.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    if (file < 0 || dup2(file, STDOUT_FILENO) < 0) _exit(127);
    std::vector<char*> arguments;
    arguments.reserve(words.size() + 1);
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    execv(arguments[0], arguments.data());
    _exit(127);
}

/// Runs a program to its end. Fills in its time and its peak memory.
ProcessRun runProgram(std::vector<std::string> words, const std::string& output, bool usesShaderCache) {
    ProcessRun run;
    rusage usage{};
    int status = 0;
    pid_t child = -1;
    run.milliseconds = measureMilliseconds([&] {
        child = fork();
        if (child == 0) becomeProgram(words, output, usesShaderCache);
        if (child > 0) wait4(child, &status, 0, &usage);
    });
    if (child < 0) fail(Failure::device, "{} cannot be started: no more processes, or no memory for one", words[0]);
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    const bool isOfDevice = code == int(Failure::device); // it has printed why
    if (code != 0)
        fail(isOfDevice ? Failure::device : Failure::internal, "{} {} ended with exit code {}", words[0], words[1],
             code);
    run.peakBytes = std::uint64_t(usage.ru_maxrss) * 1024;
    return run;
}

/// A scene in files of a temporary folder, and the words that render it.
class SceneFiles {
public:
    SceneFiles(const std::string& program, const std::string& device, const TestScene& scene)
        : folder_([] {
              std::string name = (std::filesystem::temp_directory_path() / "relief-bench-XXXXXX").string();
              if (mkdtemp(name.data()) == nullptr) fail(Failure::file, "{}: cannot make a folder there", name);
              return name;
          }) {
        const HeightMap& map = scene.height;
        writeObj(path("cage.obj"), scene.cage);
        writeImage(path("map.exr"), {map.width, map.height, 1, map.texels}, SampleType::real);
        const double unit = scene.cage.coordinates.unit; // of the map; the files are in the world's
        words_ = {program,
                  "render",
                  path("cage.obj"),
                  "--height",
                  path("map.exr"),
                  "--scale",
                  fmt::format("{}", map.scale * unit),
                  "--mid",
                  fmt::format("{}", map.mid),
                  "--wrap",
                  map.wrap == Wrap::repeat ? "repeat" : "clamp",
                  "--isolation",
                  fmt::format("{}", scene.surface.isolation),
                  "-o",
                  path("picture.png"),
                  "--no-shadows",
                  "-q",
                  "--json"};
        if (!device.empty()) words_.insert(words_.end(), {"--device", device});
    }

    [[nodiscard]] ProcessRun render(const ProcessRequest& request) const {
        std::vector<std::string> words = words_;
        if (request.path) words.insert(words.end(), {"--path", toPathWord(*request.path)});
        if (request.rate) words.insert(words.end(), {"--rate", fmt::format("{}", *request.rate)});
        if (request.edgePixels) words.insert(words.end(), {"--edge-pixels", fmt::format("{}", *request.edgePixels)});
        ProcessRun run = runProgram(std::move(words), path("report.json"), request.usesShaderCache);
        const nlohmann::json report = nlohmann::json::parse(readFile(path("report.json")));
        run.triangleCount = report.at("triangles");
        run.deviceBytes = report.at("device_bytes");
        run.peakDeviceBytes = report.at("peak_device_bytes");
        return run;
    }

private:
    static const char* toPathWord(Path path) {
        return path == Path::tessellation ? "tessellation" : path == Path::grid ? "grid" : "dice";
    }
    [[nodiscard]] std::string path(const char* name) const { return folder_.path() + "/" + name; }

    Temporary folder_;
    std::vector<std::string> words_;
};

} // namespace

RenderProcess makeRenderProcess(const std::string& program, const std::string& device, const TestScene& scene) {
    return [files = std::make_shared<const SceneFiles>(program, device, scene)](const ProcessRequest& request) {
        return files->render(request);
    };
}

} // namespace relief::app
