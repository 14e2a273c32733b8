// `relief render` in a process of its own, for the suites that measure whole processes.
#pragma once

#include "measure/measure.h"

namespace relief::app {

/// Writes the scene into temporary files, and returns what renders them by `program`, the path of relief itself.
/// `device` is the word of --device, or empty. Throws Failure::file where the files cannot be written. A render throws
/// Failure::device where its process ends with that exit code, and Failure::internal where it ends with any other.
RenderProcess makeRenderProcess(const std::string& program, const std::string& device, const TestScene& scene);

} // namespace relief::app
