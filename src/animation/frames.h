// Files that are numbered by frame.
#pragma once

#include "animation/animation.h"

namespace relief {

/// The frames of which a file of the pattern exists, from the lowest number. Throws Failure::usage for a pattern that
/// frameName refuses or whose folder varies, Failure::file when the folder cannot be read or no file exists.
std::vector<int> framesOnDisk(const std::string& pattern);

} // namespace relief
