#include "app/command_line.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

#include "app/units.h"

namespace relief::app {
namespace {

bool isNumberWithoutZero(const std::string& word) {
    return word.size() > 2 && word.starts_with("-.") && std::isdigit(static_cast<unsigned char>(word[2])) != 0;
}

bool looksLikeNumber(const std::string& word) {
    double value = 0;
    return CLI::detail::lexical_cast(word, value);
}

/// The first option of one value that is given again, as the user calls it, or "". CLI11 counts the values instead.
std::string findRepeatedOption(const CLI::App& command, std::span<const std::string> words) {
    std::set<const CLI::Option*> seen;
    for (const std::string& word : words) {
        const std::string name = word.substr(0, word.starts_with("--") ? word.find('=') : 2);
        const CLI::Option* option = name.starts_with('-') ? command.get_option_no_throw(name) : nullptr;
        if (option == nullptr || option->get_multi_option_policy() != CLI::MultiOptionPolicy::Throw) continue;
        if (!seen.insert(option).second) return name;
    }
    return "";
}

/// The first word that is no option or verb although it stands for one, with the nearest that is; or "".
std::string explainUnknownWord(const CLI::App& command, bool isTop, std::span<const std::string> words,
                               const std::vector<std::string>& verbs) {
    std::vector<std::string> known;
    for (const CLI::Option* option : command.get_options())
        for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
    if (isTop) known.insert(known.end(), verbs.begin(), verbs.end());
    for (std::size_t i = 0; i < words.size(); ++i) {
        const std::string word = words[i].substr(0, words[i].find('='));
        const bool isCandidate = isTop ? i == 0 : word.starts_with("--");
        if (!isCandidate || std::ranges::find(known, word) != known.end()) continue;
        const std::string near = nearestWord(word, known);
        if (!near.empty()) return fmt::format("{} is not known here; did you mean {}?", word, near);
    }
    return "";
}

} // namespace

std::vector<std::string> prepareWords(int argc, char** argv) {
    std::vector<std::string> words(argv, argv + argc);
    for (std::size_t i = 1; i < words.size(); ++i) {
        if (words[i] == "--") break;
        const bool isAlone = i + 1 == words.size() || !parseDistance(words[i + 1]);
        if (words[i] == "--weld" && isAlone) words[i] = "--weld=0";
        if (isNumberWithoutZero(words[i])) words[i].insert(1, "0");
        // Azimuth and elevation may be two words, as those of other vectors.
        if (words[i] == "--light" && i + 2 < words.size() && looksLikeNumber(words[i + 1]) &&
            looksLikeNumber(words[i + 2])) {
            words[i + 1] += "," + words[i + 2];
            words.erase(words.begin() + std::ptrdiff_t(i) + 2);
        }
    }
    return words;
}

std::string explainMistake(const CLI::App& top, std::span<const std::string> words,
                           const std::vector<std::string>& verbs) {
    const bool isTop = top.get_subcommands().empty();
    const CLI::App& command = isTop ? top : *top.get_subcommands().front();
    const std::string repeated = findRepeatedOption(command, words);
    if (!repeated.empty()) return fmt::format("{} is given twice; give it once", repeated);
    const std::string unknown = explainUnknownWord(command, isTop, words, verbs);
    if (!unknown.empty() || !isTop) return unknown;
    return fmt::format("name what to do first: {} (relief --help explains)", fmt::join(verbs, ", "));
}

void requireFiniteNumbers(CLI::App& verb) {
    const auto check = [](const std::string& word) {
        double value = 0;
        const bool isNumber = CLI::detail::lexical_cast(word, value);
        return isNumber && !std::isfinite(value) ? fmt::format("{} is not a finite number", word) : std::string();
    };
    const auto isNumber = [](const CLI::Option* option) { return option->get_type_name().starts_with("FLOAT"); };
    for (CLI::Option* option : verb.get_options(isNumber)) option->check(CLI::Validator(check, ""));
}

} // namespace relief::app
