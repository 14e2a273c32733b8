// Internal: the cages that windows have shown last.
#pragma once

#include <string>
#include <vector>

namespace relief {

/// Their absolute paths, the latest first; those whose file is gone are omitted. They are listed in a file of
/// cacheFolder(): without one, or where it cannot be read, there are none.
std::vector<std::string> readRecent();

/// Puts a cage in front of the others, of which eight are kept. Does nothing where the list cannot be written.
void addRecent(const std::string& path);

} // namespace relief
