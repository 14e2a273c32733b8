// Frame lists, as usdrecord writes them.
#pragma once

#include <string>
#include <vector>

namespace relief::app {

/// "101", "1:24", "101:109x2" (every second one), and several of these with commas between; ranges may run down. Throws
/// Failure::usage, saying what was found where, for anything else and for more than a million frames.
std::vector<int> parseFrames(const std::string& text);

} // namespace relief::app
