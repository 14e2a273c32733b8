// Internal: the pictures that fragments read, on the device with their mip levels.
#pragma once

#include "displacement/displacement.h"
#include "model/model.h"

namespace relief {

/// A picture of 3 or more channels, sRGB-encoded values 0..1: 8 bits per channel. Averages are taken of linear light.
Texture uploadAlbedo(Device& device, const Image& image);

/// The words of a height map in the order of shared/maps.h, which those of `map` are not in yet. Shaders read two words
/// at once: there is an even number of them.
TexelBuffer uploadHeights(Device& device, MapWords map, MapFormat format);

/// Two half floats per texel.
GpuSlopeMap uploadSlopes(Device& device, const HeightMap& map);

/// Four half floats per texel, the last one unused. Coarser levels hold means of normals.
GpuNormalMap uploadNormals(Device& device, const NormalMap& map);

} // namespace relief
