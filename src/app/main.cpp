// relief: displaced subdivision surfaces on any Vulkan 1.3 device.
#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <set>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <malloc.h>
#include <unistd.h>

#include "app/commands.h"
#include "app/memory.h"
#include "app/output.h"
#include "app/weld.h"

namespace {

using namespace relief;

struct Command {
    const char* name;
    const char* description;
    app::Run (*add)(CLI::App&);
};

constexpr Command kCommands[] = {
    {"render", "one picture of a displaced cage, or of a dense mesh", app::addRender},
    {"animate", "many pictures of a cage that moves, or a clip of them", app::addAnimate},
    {"export", "the displaced triangles as a mesh", app::addExport},
    {"sample", "the device's own frames at given points of the surface", app::addSample},
    {"check", "certificate: watertight, exact, one-to-one", app::addCheck},
    {"bench", "what displacement costs and saves, against dense meshes", app::addBench},
    {"info", "what a file holds; what the devices can do", app::addInfo},
};

int fault(Failure failure, const std::string& line) {
    printOnStderr(fmt::format("relief: {}\n", onOneLine(line)));
    return int(failure);
}

/// The first option of one value that is given again, as the user calls it, or "". CLI11 counts the values instead.
std::string repeatedOption(const CLI::App& command, int argc, char** argv) {
    std::set<const CLI::Option*> seen;
    for (int i = 1; i < argc; ++i) {
        const std::string_view word = argv[i];
        std::string name(word.substr(0, word.starts_with("--") ? word.find('=') : 2));
        const CLI::Option* option = name.starts_with('-') ? command.get_option_no_throw(name) : nullptr;
        if (option == nullptr || option->get_multi_option_policy() != CLI::MultiOptionPolicy::Throw) continue;
        if (!seen.insert(option).second) return name;
    }
    return "";
}

/// What helps more than CLI11's own words: an option given twice, the nearest option or verb to an unknown one, or the
/// verbs that there are.
std::string hintFor(const CLI::App& top, int argc, char** argv) {
    const CLI::App* command = top.get_subcommands().empty() ? &top : top.get_subcommands().front();
    const std::string repeated = repeatedOption(*command, argc, argv);
    if (!repeated.empty()) return fmt::format("{} is given twice; give it once", repeated);
    std::vector<std::string> known;
    for (const CLI::Option* option : command->get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    if (command == &top)
        for (const Command& c : kCommands) known.emplace_back(c.name);
    for (int i = 1; i < argc; ++i) {
        const std::string word = std::string(argv[i]).substr(0, std::string_view(argv[i]).find('='));
        const bool isCandidate = command == &top ? i == 1 : word.starts_with("--");
        if (!isCandidate || std::ranges::find(known, word) != known.end()) continue;
        const std::string near = nearestWord(word, known);
        if (!near.empty()) return fmt::format("{} is not known here; did you mean {}?", word, near);
    }
    if (command != &top) return "";
    std::string verbs;
    for (const Command& c : kCommands) verbs += fmt::format("{}{}", verbs.empty() ? "" : ", ", c.name);
    return fmt::format("name what to do first: {} (relief --help explains)", verbs);
}

/// Numbers are finite, whatever the option and its range: CLI::Range lets "nan" through.
void wantFiniteNumbers(CLI::App& verb) {
    const auto check = [](const std::string& word) {
        double value = 0;
        const bool isNumber = CLI::detail::lexical_cast(word, value);
        return isNumber && !std::isfinite(value) ? fmt::format("{} is not a finite number", word) : std::string();
    };
    const auto isNumber = [](const CLI::Option* option) { return option->get_type_name().starts_with("FLOAT"); };
    for (CLI::Option* option : verb.get_options(isNumber)) option->check(CLI::Validator(check, ""));
}

int run(int argc, char** argv) {
    CLI::App app("Renders, animates, exports and measures displaced subdivision surfaces.", "relief");
    app.set_version_flag("--version", "relief 0.1.0");
    app.require_subcommand(1);
    app.footer("exit codes: 0 done, 1 internal error, 2 usage, 3 bad input, 4 reading or writing failed,\n"
               "            5 no device or out of memory, 6 a check failed, 130 interrupted\n"
               "relief VERB --help explains each verb.");
    app::Run chosen;
    for (const Command& command : kCommands) {
        CLI::App* verb = app.add_subcommand(command.name, command.description);
        verb->callback([&chosen, action = command.add(*verb)] { chosen = action; });
        wantFiniteNumbers(*verb);
    }
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        if (error.get_exit_code() == 0) return app.exit(error);
        const std::string hint = hintFor(app, argc, argv);
        return fault(Failure::usage, hint.empty() ? error.what() : hint);
    }
    const int code = chosen();
    app::finishStdout();
    return code;
}

/// What libraries say in their own kinds of exceptions.
int faultOf(const std::system_error& error) {
    const std::error_code code = error.code();
    if (code == std::errc::resource_unavailable_try_again)
        return fault(Failure::device, "no more threads can be started: there are too many (ulimit -u), or no memory is "
                                      "left for one (ulimit -v)");
    if (code == std::errc::not_enough_memory) return fault(Failure::device, "out of memory");
    const bool isFile = dynamic_cast<const std::filesystem::filesystem_error*>(&error) != nullptr;
    return fault(isFile ? Failure::file : Failure::internal, error.what());
}

/// Of the exception at hand.
int faultOfCurrent() {
    try {
        throw;
    } catch (const Error& error) {
        return fault(error.failure, error.what());
    } catch (const app::OutOfMemory& error) {
        return fault(Failure::device, error.what());
    } catch (const std::bad_alloc&) { // of a library's own making
        return fault(Failure::device, "out of memory");
    } catch (const std::length_error&) {
        return fault(Failure::device, "out of memory: more was asked for than any memory holds");
    } catch (const std::system_error& error) {
        return faultOf(error);
    } catch (const std::exception& error) {
        return fault(Failure::internal, error.what());
    }
}

/// Exceptions in threads of libraries, or through code that knows none.
[[noreturn]] void endTerminated() {
    if (std::current_exception()) _exit(faultOfCurrent());
    std::abort();
}

/// Files that this program opens must not become its stdout or stderr where those are closed: what is printed would
/// get into them. Each is opened such that using it fails as before.
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
        std::vector<std::string> words = app::withDefaultDistances(argc, argv);
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        return run(argc, pointers.data());
    } catch (...) {
        return faultOfCurrent();
    }
}
