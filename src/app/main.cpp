// relief: displaced subdivision surfaces on any Vulkan 1.3 device.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include "app/command_line.h"
#include "app/commands.h"
#include "app/help.h"
#include "app/memory.h"
#include "app/output.h"
#include "base/base.h"

namespace {

using namespace relief;

struct Command {
    const char* name;
    const char* description;
    app::Run (*add)(CLI::App&);
};

constexpr Command kCommands[] = {
    {"render", "draw one picture of a displaced cage, or of a mesh of triangles", app::addRender},
    {"animate", "draw the frames of a cage that moves, as pictures or as a clip", app::addAnimate},
    {"view", "show a displaced cage in a window: turn it, change it, play it", app::addView},
    {"export", "write the displaced triangles as a mesh", app::addExport},
    {"sample", "evaluate points, tangents and normals of the surface on the device", app::addSample},
    {"check", "certify that the triangles are watertight, exact and one-to-one", app::addCheck},
    {"bench", "measure what displacement costs and saves, against dense meshes", app::addBench},
    {"doctor", "find what is wrong with height maps on a cage, and how other renderers show them", app::addDoctor},
    {"normal-map", "make a normal map of a height map", app::addNormalMap},
    {"height-map", "make a height map of a normal map", app::addHeightMap},
    {"map", "make a map per face of a height map, or the other way round", app::addMap},
    {"bake", "make a height map of a sculpt over a cage, with a certificate", app::addBake},
    {"geometry-image", "spread a surface over a square picture of its points", app::addGeometryImage},
    {"environment", "turn a picture of an environment into another shape, or blur it", app::addEnvironment},
    {"matcap", "draw a ball of a material in light, for --shading matcap", app::addMatcap},
    {"shading-table", "write the table of --shading table", app::addShadingTable},
    {"info", "describe files, or the Vulkan devices of this machine", app::addInfo},
};

int fault(Failure failure, const std::string& line) {
    printOnStderr(fmt::format("relief: {}\n", onOneLine(line)));
    return int(failure);
}

/// Whether the words name a picture that is read or written by the library of pictures: not only the PNG that is drawn.
bool needsImages(const std::vector<std::string>& words) {
    const auto isPicture = [](const std::string& word) {
        for (const std::string_view extension : {".exr", ".tif", ".tiff", ".hdr", ".jpg", ".jpeg", ".png"})
            if (word.ends_with(extension)) return true;
        return false;
    };
    for (std::size_t i = 1; i < words.size(); ++i) {
        const bool isDrawn = words[i].ends_with(".png") && words[i - 1] == "-o";
        if (words[i] == "--compare" || (isPicture(words[i]) && !isDrawn)) return true;
    }
    return false;
}

int run(std::vector<std::string> words) {
    CLI::App app("Renders, animates, exports, certifies and measures displaced subdivision surfaces.", "relief");
    app.formatter(std::make_shared<app::HelpFormatter>());
    app.set_version_flag("--version", "relief 0.1.0");
    app.require_subcommand(1);
    app.footer("exit codes: 0 done, 1 internal error, 2 usage, 3 bad input, 4 reading or writing failed,\n"
               "            5 no device or out of memory, 6 a check failed, 130 interrupted\n"
               "relief VERB --help explains each verb.");
    // Each verb adds its options; the one that is named leaves what to run.
    app::Run chosen;
    std::vector<std::string> verbs;
    for (const Command& command : kCommands) {
        CLI::App* verb = app.add_subcommand(command.name, command.description);
        verb->callback([&chosen, action = command.add(*verb)] { chosen = action; });
        app::requireFiniteNumbers(*verb);
        verbs.emplace_back(command.name);
    }
    // CLI11 expects the words after the program's name, the last one first.
    words.erase(words.begin());
    try {
        app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        const std::string hint = app::explainMistake(app, words, verbs);
        return fault(Failure::usage, hint.empty() ? error.what() : hint);
    }
    std::jthread images;
    if (needsImages(words)) images = prepareImages();
    const int code = chosen();
    app::finishStdout();
    return code;
}

/// Reports exceptions of the system: threads, memory, files.
int faultOf(const std::system_error& error) {
    const std::error_code code = error.code();
    if (code == std::errc::resource_unavailable_try_again)
        return fault(Failure::device, "no more threads can be started: there are too many (ulimit -u), or no memory is "
                                      "left for one (ulimit -v)");
    if (code == std::errc::not_enough_memory) return fault(Failure::device, "out of memory");
    const bool isFile = dynamic_cast<const std::filesystem::filesystem_error*>(&error) != nullptr;
    return fault(isFile ? Failure::file : Failure::internal, error.what());
}

/// Reports the exception that is being handled; returns the exit code.
int faultOfCurrent() {
    try {
        throw;
    } catch (const Error& error) {
        return fault(error.failure, error.what());
    } catch (const app::OutOfMemory& error) {
        return fault(Failure::device, error.what());
    } catch (const std::bad_alloc&) { // thrown by a library's own allocator
        return fault(Failure::device, "out of memory");
    } catch (const std::length_error&) {
        return fault(Failure::device, "out of memory: more was asked for than any memory holds");
    } catch (const std::system_error& error) {
        return faultOf(error);
    } catch (const std::exception& error) {
        return fault(Failure::internal, error.what());
    }
}

/// Handles exceptions that escape from threads of libraries or through functions that may not throw.
[[noreturn]] void endTerminated() {
    if (std::current_exception()) _exit(faultOfCurrent());
    std::abort();
}

/// Opens stdin, stdout and stderr where they are closed, so that no file that this program opens later takes their
/// numbers and receives what is printed. They are opened the wrong way round: using them fails as before.
void occupyStandardFiles() {
    for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(file, F_GETFD) < 0 && open("/dev/null", file == STDIN_FILENO ? O_WRONLY : O_RDONLY) < 0) return;
}

} // namespace

int main(int argc, char** argv) {
    mallopt(M_MMAP_THRESHOLD, 1 << 20); // large arrays go back to the system when they are freed, at once
    std::signal(SIGXFSZ, SIG_IGN);      // write() then reports files that may not grow (ulimit -f)
    std::set_terminate(endTerminated);
    app::endWhereMemoryRunsOut();
    try {
        occupyStandardFiles();
        endCleanlyOnInterrupt();
        return run(app::prepareWords(argc, argv));
    } catch (...) {
        const int code = faultOfCurrent();
        // Memory that ran out while a library was loaded leaves the loader locked: exit() would wait for it for ever.
        std::fflush(stdout);
        _exit(code);
    }
}
