// How the options of verbs are made: words of a table, vectors, numbers in a range, and how --help lists them.
#pragma once

#include <span>

#include <CLI/CLI.hpp>

#include "base/base.h"
#include "base/words.h"

namespace relief::app {

/// Sets what --help calls an option's value, and the group where it lists the option.
CLI::Option* listIn(const char* group, const char* value, CLI::Option* option);

// --- numbers ------------------------------------------------------------------------------------------------------

/// Accepts finite numbers from `lowest` to `highest`.
CLI::Validator numberIn(double lowest, double highest);
CLI::Validator anyNumber();     ///< of a usual size: within 1e12 of 0
CLI::Validator anyCoordinate(); ///< in the units of any cage

/// Adds an option that takes as many numbers as `Vector` has, with commas between them: a size, a point, a color.
/// `target` is a Vector or an optional one.
template <typename Vector, typename Target>
CLI::Option* addVector(CLI::App& app, const char* name, Target& target, const std::string& help) {
    using Number = std::conditional_t<std::is_integral_v<typename Vector::value_type>, int, double>;
    const auto set = [&target](const std::vector<Number>& numbers) {
        Vector vector;
        for (int i = 0; i < Vector::length(); ++i) vector[i] = typename Vector::value_type(numbers[std::size_t(i)]);
        target = vector;
    };
    return app.add_option_function<std::vector<Number>>(name, set, help)
        ->delimiter(',')
        ->expected(Vector::length())
        ->allow_extra_args(false); // else a cage that follows would be taken for one more number
}

// --- words --------------------------------------------------------------------------------------------------------

struct WordHelp {
    const char *word, *help;
};

template <typename Value, std::size_t kCount>
std::vector<WordHelp> listWords(const Word<Value> (&table)[kCount]) {
    std::vector<WordHelp> words;
    for (const Word<Value>& row : table) words.push_back({row.word, row.help});
    return words;
}

/// The help of an option with its words below it, one per line.
std::string describeWords(const std::string& help, std::span<const WordHelp> words);
/// Accepts these words; for others it names them and the nearest one.
CLI::Validator oneOf(std::span<const WordHelp> words);

/// Adds an option that takes one word of a table. `target` is a Value, which is the default that --help names, or an
/// optional one, whose default `help` has to explain.
template <typename Value, std::size_t kCount, typename Target>
CLI::Option* addEnum(CLI::App& app, const char* name, Target& target, const Word<Value> (&table)[kCount],
                     std::string help) {
    if constexpr (std::is_same_v<Target, Value>) help += fmt::format(" (default: {})", wordOf(table, target));
    const auto set = [&target, &table](const std::string& word) {
        for (const Word<Value>& row : table)
            if (row.word == word) target = row.value;
    };
    const std::vector<WordHelp> words = listWords(table);
    return app.add_option_function<std::string>(name, set, describeWords(help, words))->check(oneOf(words));
}

} // namespace relief::app
