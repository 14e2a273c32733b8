// Frame lists, as usdrecord writes them.
#pragma once

#include <string>
#include <vector>

namespace relief::app {

/// The frames of a list such as "101", "1:24", "-5:5", "101:109x2" (every second one), or several of these with commas
/// between them. Ranges may count down. Throws Failure::usage, naming what was expected at which character, for
/// anything else and for more than a million frames.
std::vector<int> parseFrames(const std::string& text);

} // namespace relief::app
