// Internal: the parts of the report.
#pragma once

#include "measure/plot.h"

namespace relief {

std::string styleSheet();
/// What the numbers of bytes assume, in words.
std::string assumptions();

/// The figures of each suite; empty where it did not run.
std::string bandwidthFigures(const Results& results);
std::string scalingFigures(const Results& results);
std::string breakEvenFigures(const Results& results);
std::string animateFigures(const Results& results);

/// A table of rows of one suite and scene: contestants down, values across.
std::string tableOfRows(std::span<const Row* const> rows);

} // namespace relief
