// The words of a command line before CLI11 parses them, and what helps where it cannot.
#pragma once

#include <span>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

namespace relief::app {

/// The command line as CLI11 reads it the way users mean it:
/// "--weld" alone, or before a word that is no distance, is "--weld=0": CLI11 would take that word for its distance;
/// numbers such as "-.5" are "-0.5": CLI11 would take them for options.
std::vector<std::string> prepareWords(int argc, char** argv);

/// What helps more than CLI11's own message: an option that is given twice, the option or verb nearest to an unknown
/// one, or the verbs that there are. Empty where none of these is at fault.
std::string explainMistake(const CLI::App& top, std::span<const std::string> words,
                           const std::vector<std::string>& verbs);

/// Makes all options of numbers refuse those that are not finite, whatever their range: CLI::Range accepts "nan".
void requireFiniteNumbers(CLI::App& verb);

} // namespace relief::app
