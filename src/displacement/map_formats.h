// Internal: how levels of maps become words.
#pragma once

#include "displacement/displacement.h"
#include "displacement/mips.h"

namespace relief {

/// Bytes of one level: whole words.
std::uint64_t levelBytes(MapFormat format, const ivec2& size);

/// Stores a level in words that are 0; returns the largest difference between its texels and what a reader finds.
float storeLevel(std::span<std::uint32_t> to, const MapEncoding& encoding, const MapLevel<float>& level);
/// Stores a level as storeLevel() does, from blocks that are encoded already where the format has blocks.
float storeBlocks(std::span<std::uint32_t> to, const MapEncoding& encoding, const MapLevel<float>& level,
                  std::span<const std::uint8_t> blocks);

/// Stores all tiles of a set, after its entries (shared/maps.h).
void storeTiles(MapWords& words, const HeightMap& set, const MapEncoding& encoding);

} // namespace relief
