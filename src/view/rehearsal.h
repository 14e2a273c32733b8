// Internal: what a new height function costs, paid on another thread before the window shows it.
#pragma once

#include <atomic>

#include "view/shown_scene.h"

namespace relief {

/// Measures the height function of a scene that was read, if it has one, and draws a small picture with it, on a device
/// of its own. All shaders that contain the function are compiled then, and what the driver made of them lies in the
/// driver's cache (Mesa's and others keep one for all devices). `device`: the name of the window's. Only measures where
/// the window has drawn what `shown` says, and stops at the next step once `isEnding`. Throws as measureFunction().
/// Other failures are none: the window's own device has them, too, and says so.
void rehearse(const ViewDesc& desc, const std::string& device, const PipelineKey& shown, Prepared& prepared,
              const std::atomic<bool>& isEnding);

} // namespace relief
