// Pages of libraries that a program needed once.
#pragma once

namespace relief::app {

/// Takes the pages of code and constants of all libraries out of the process: the system reads those from their files
/// again that are used again. After pictures are read they are a fifth of a render's memory, for OpenImageIO loads 260
/// libraries.
void releaseLibraryPages();

} // namespace relief::app
