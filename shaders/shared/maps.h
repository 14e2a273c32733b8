// How the texels of height maps are kept on the device: in 32-bit words, row after row from the top, level after level, each
// level from a whole word on. Every device reads the same numbers: no sampler takes part, which may round as it likes.
//
//   kMapReal      a word a texel: its bits
//   kMapHalf      two texels a word, the first one in the low half: half floats
//   kMapUnorm16   the same: whole numbers 0..65535
//   kMapUnorm8    four texels a word, the first one lowest: whole numbers 0..255
//   kMapBc4       two words for 4 x 4 texels, numbers 0..255 (Khronos Data Format Specification 1.3, "BC4 unsigned"):
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

#ifdef __cplusplus
} // namespace relief
#endif
#endif
