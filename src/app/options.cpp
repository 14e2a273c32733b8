#include "app/options.h"

namespace relief::app {

CLI::Option* listIn(const char* group, const char* value, CLI::Option* option) {
    return option->option_text(value)->group(group);
}

CLI::Validator numberIn(double lowest, double highest) {
    // CLI::Range would accept "nan".
    const auto check = [=](const std::string& word) {
        double value = 0;
        const bool isNumber = CLI::detail::lexical_cast(word, value);
        if (isNumber && value >= lowest && value <= highest) return std::string();
        return fmt::format("{} is not a number in {}..{}", word, lowest, highest);
    };
    return {check, ""};
}

CLI::Validator anyNumber() { return numberIn(-1e12, 1e12); }
CLI::Validator anyCoordinate() { return numberIn(-kFarthestCoordinate, kFarthestCoordinate); }

std::string describeWords(const std::string& help, std::span<const WordHelp> words) {
    std::string text = help;
    for (const WordHelp& word : words) text += fmt::format("\n  {}: {}", word.word, word.help);
    return text;
}

CLI::Validator oneOf(std::span<const WordHelp> words) {
    std::vector<std::string> known;
    for (const WordHelp& word : words) known.emplace_back(word.word);
    const auto check = [known](const std::string& word) {
        if (std::ranges::find(known, word) != known.end()) return std::string();
        const std::string near = nearestWord(word, known);
        return fmt::format("{} is not one of {}{}", word, fmt::join(known, ", "),
                           near.empty() ? "" : fmt::format("; did you mean {}?", near));
    };
    return {check, ""};
}

} // namespace relief::app
