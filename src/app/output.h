// Where results go: warnings, progress, JSON and text on stdout, and files that may be written.
#pragma once

#include <memory>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>

#include "base/base.h"
#include "gpu/gpu.h"

namespace relief::app {

inline constexpr Word<ShowProgress> kProgressWords[] = {
    {"auto", ShowProgress::automatic, "on a terminal, for work that takes more than a second"},
    {"always", ShowProgress::always, "whatever stderr is"},
    {"never", ShowProgress::never, "not at all"},
};

struct Output {
    bool isJson = false, isQuiet = false, isVerbose = false;
    ShowProgress progress = ShowProgress::automatic;
};

/// Adds --json, --quiet, --verbose and --progress.
void addOutput(CLI::App& app, Output& output);
void addProgress(CLI::App& app, ShowProgress& progress);

/// Prints warnings on stderr, the same line only once; silent where the output is quiet.
Warn makeWarn(bool isQuiet);

/// Throws as checkWritable does, and Failure::usage when `target` is one of the inputs, which would be lost. Inputs may
/// be empty, or patterns of numbered files.
void checkOutput(const std::string& target, const std::vector<std::string>& inputs);

/// Prints JSON on stdout. In names that are not UTF-8, as files and what is in them may have, U+FFFD takes the place of
/// each wrong byte.
void printJson(const nlohmann::json& value);

/// Throws Failure::file unless everything printed on stdout has been written.
void finishStdout();

/// Throws Failure::internal when the validation layer (RELIEF_VALIDATE=1) has reported something.
void checkValidation(const Device& device);

} // namespace relief::app
