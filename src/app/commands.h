// The verbs of the command line. Each adds its options to a CLI11 subcommand and returns what to run.
#pragma once

#include <functional>

#include <CLI/CLI.hpp>

namespace relief::app {

/// Runs the parsed command; returns the exit code. Mistakes are reported as early as they can be known: first options
/// that make no sense, then an output that cannot be written, then inputs that cannot be read.
using Run = std::function<int()>;

Run addRender(CLI::App& app);
Run addAnimate(CLI::App& app);
Run addExport(CLI::App& app);
Run addSample(CLI::App& app);
Run addCheck(CLI::App& app);
Run addDoctor(CLI::App& app);
Run addBench(CLI::App& app);
Run addNormalMap(CLI::App& app);
Run addHeightMap(CLI::App& app);
Run addMap(CLI::App& app);
Run addBake(CLI::App& app);
Run addGeometryImage(CLI::App& app);
Run addEnvironment(CLI::App& app);
Run addMatcap(CLI::App& app);
Run addShadingTable(CLI::App& app);
Run addView(CLI::App& app);
Run addInfo(CLI::App& app);

} // namespace relief::app
