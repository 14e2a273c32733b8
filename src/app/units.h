// Values of options that are sizes in bytes and distances.
#pragma once

#include <optional>

#include <CLI/CLI.hpp>

#include "scene/scene.h"

namespace relief::app {

/// The bytes of a size such as "512M", "1.5G" or "4000000"; units are decimal, as humanBytes prints them. Nothing
/// where the word is not a size from 1M to 1T.
std::optional<std::uint64_t> parseBytes(const std::string& word);
/// Accepts what parseBytes reads.
CLI::Validator sizeInBytes();

/// The distance of a word such as "0.01" or "0.5%", of either sign; nothing where the word is neither.
std::optional<Distance> parseDistance(std::string word);
/// Accepts finite distances of 0 or more.
CLI::Validator distanceFromZero();

} // namespace relief::app
