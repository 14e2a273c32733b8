// Internal: colour pictures on the device.
#pragma once

#include "gpu/gpu.h"

namespace relief {

/// A picture of 3 or more channels, sRGB-encoded values 0..1, with its mip levels: 8 bits per channel. Averages are
/// taken of linear light.
Texture uploadAlbedo(Device& device, const Image& image);

} // namespace relief
