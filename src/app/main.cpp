// relief: displaced subdivision surfaces on any Vulkan 1.3 device.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <iostream>
#include <new>
#include <set>

#include <malloc.h>

#include "app/commands.h"
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

/// One line, whatever stood in the words that it repeats.
int fault(Failure failure, std::string line) {
    std::ranges::replace_if(
        line, [](unsigned char letter) { return std::iscntrl(letter) != 0; }, ' ');
    std::cerr << "relief: " << line << '\n';
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
    CLI::App app("Renders, animates, bakes and measures displaced subdivision surfaces.", "relief");
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
    return chosen();
}

} // namespace

int main(int argc, char** argv) {
    mallopt(M_MMAP_THRESHOLD, 1 << 20); // large arrays go back to the system when they are freed, at once
    try {
        endCleanlyOnInterrupt();
        std::vector<std::string> words = app::withDefaultDistances(argc, argv);
        std::vector<char*> pointers;
        for (std::string& word : words) pointers.push_back(word.data());
        return run(argc, pointers.data());
    } catch (const Error& error) {
        return fault(error.failure, error.what());
    } catch (const std::bad_alloc&) {
        return fault(Failure::device, "out of memory");
    } catch (const std::exception& error) {
        return fault(Failure::internal, error.what());
    }
}
