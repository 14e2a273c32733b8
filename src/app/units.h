// Words of the command line that are sizes and distances.
#pragma once

#include <optional>

#include <CLI/CLI.hpp>

#include "base/base.h"

namespace relief::app {

/// Bytes of "512M", "1.5G" or "4000000", decimal as humanBytes prints them; nothing where the word is no such size.
std::optional<std::uint64_t> bytesOf(const std::string& word);
CLI::Validator sizeInBytes();

/// In cage units, or as a share of the diagonal of a bounding box.
struct Distance {
    double value = 0;
    bool isShare = false;

    [[nodiscard]] double cageUnits(double diagonal) const { return isShare ? value * diagonal : value; }
};
/// Of "0.01" or "0.5%"; nothing where the word is neither, whatever its sign.
std::optional<Distance> parseDistance(std::string word);
/// Distances of 0 or more.
CLI::Validator distanceFromZero();

} // namespace relief::app
