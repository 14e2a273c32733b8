// Internal: what is built into the program.
#pragma once

#include <string>

namespace relief {

extern const char* const kOctopusObj; ///< meshes/octopus.obj
extern const char* const kCommit; ///< of the source that was built, with "-dirty" where it had changed; or "unknown"

} // namespace relief
