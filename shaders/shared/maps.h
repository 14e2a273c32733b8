// How the texels of height maps are kept on the device: in 32-bit words, level after level, each level from a whole
// word on. Levels whose width and height are multiples of 4 are kept in blocks of 4 x 4 texels, so that the texels
// around a point lie in few cache lines and pages; other levels row after row. Blocks, and the texels of a block, go
// row after row from the top as well. Every device reads the same numbers: no sampler takes part, which may round as it
// likes.
//
//   kMapReal      one word per texel: its bits
//   kMapHalf      two texels per word, the first one in the low half: half floats
//   kMapUnorm16   two texels per word, as above: whole numbers 0..65535
//   kMapUnorm8    four texels per word, the first one lowest: whole numbers 0..255
//   kMapBc4       two words per block, which every level has, begun ones whole; numbers 0..255 (Khronos Data Format
//   Specification 1.3, "BC4 unsigned"):
//                 red0:8 red1:8 codes:16 | codes:32, the 16 codes of three bits each from the lowest bit on
#ifndef RELIEF_SHARED_MAPS_H
#define RELIEF_SHARED_MAPS_H

#include "shared/types.h"

#ifdef __cplusplus
namespace relief {
#endif

RELIEF_CONSTANT uint kMapReal = 0u;
RELIEF_CONSTANT uint kMapHalf = 1u;
RELIEF_CONSTANT uint kMapUnorm16 = 2u;
RELIEF_CONSTANT uint kMapUnorm8 = 3u;
RELIEF_CONSTANT uint kMapBc4 = 4u;

RELIEF_CONSTANT uint kMostMapLevels = 16u;

// Whether the texels of a level of that size are kept in blocks.
RELIEF_SHARED_FUNCTION bool mapIsInBlocks(uint format, ivec2 size) {
    return format == kMapBc4 || ((size.x | size.y) & 3) == 0;
}

// One map in the words of kBindHeight: h = scale * (number - mid) in cage units, of the numbers that the words hold.
struct MapRecord {
    ivec2 size; // texels of level 0; a level is half as large as the one before, at least 1
    float mid;
    float scale;
    uint repeats; // 1 repeat, 0 clamp
    uint levelCount;
    uint firstWords[kMostMapLevels]; // where each level's words begin
};

// Maps of one model. A lookup chooses its record by one function, mapAt() of heights.glsl.
// Of a vector map the first three are its components.
RELIEF_CONSTANT uint kMostMaps = 3u;

#ifdef __cplusplus
static_assert(sizeof(MapRecord) == 24 + 4 * kMostMapLevels);
} // namespace relief
#endif
#endif
