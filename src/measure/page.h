// Internal: the parts of the report, and what they ask of results.
#pragma once

#include "measure/plot.h"

namespace relief {

// --- questions to results

/// Selects the rows of a suite and axis, in order.
std::vector<const Row*> selectRows(const Results& results, Suite suite, Axis axis);
/// Keeps the rows of one scene.
std::vector<const Row*> selectScene(std::vector<const Row*> rows, const std::string& scene);
/// Lists the scenes of a suite, in order of appearance.
std::vector<std::string> listScenes(const Results& results, Suite suite);
/// Lists the metrics of rows, in order of appearance.
std::vector<Metric> listMetrics(std::span<const Row* const> rows);

/// A figure of a goal with its unit: "34.7 ×", "12 %", "1.5 MB".
std::string formatGoal(const Goal& goal, double figure);

// --- HTML

std::string styleSheet();
/// What the numbers of bytes assume.
std::string describeAssumptions();

/// The figures of each suite; empty where it did not run.
std::string drawBandwidthFigures(const Results& results);
std::string drawScalingFigures(const Results& results);
std::string drawBreakEvenFigures(const Results& results);
std::string drawAnimateFigures(const Results& results);
std::string drawDetailFigures(const Results& results);

/// A table of rows of one suite, scene and axis: methods down, metrics across.
std::string makeHtmlTable(std::span<const Row* const> rows);

} // namespace relief
