// Where results go: files that may be written, JSON and words on stdout.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "app/options.h"

namespace relief::app {

/// The files that a surface is made of, as the user names them; empty names where there are none.
std::vector<std::string> inputsOf(const SurfaceArgs& args);
std::vector<std::string> inputsOf(const SurfaceArgs& surface, const PictureArgs& picture);

/// checkWritable; and throws Failure::usage when `target` is one of the inputs, which would be lost.
void checkOutput(const std::string& target, const std::vector<std::string>& inputs);

/// Prints JSON on stdout. Names that are not UTF-8, as files and what is in them may have, are printed with U+FFFD in
/// the place of each byte that is wrong.
void printJson(const nlohmann::json& value);

/// Throws Failure::file unless everything on stdout has got to where it goes.
void finishStdout();

} // namespace relief::app
