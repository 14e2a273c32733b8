// Internal: what is built into the library.
#pragma once

#include <string>

namespace relief {

extern const char* const kOctopusObj; ///< meshes/octopus.obj
/// The commit of the source that was built, with "-dirty" where the source was changed; "unknown" outside of git.
extern const char* const kCommit;

} // namespace relief
