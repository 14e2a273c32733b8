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
//
// A map is one rectangle of texels over the unit square of texture coordinates (s,t), or a set of tiles: one tile per
// unit square (UDIM), or one per face over its (u,v). The words of a set begin with its entries, a pair of words per
// tile: the word where level 0 begins (kNoTile: there is no tile), and its size. Level l > 0 begins at the word whose
// number stands l words before level 0. Entries of unit squares go row after row of the grid from the lowest (s,t) on,
// those of faces by their numbers. Around the texels of each level lies an apron: what lookups meet beyond the border.
//
//   kMapOfTiles   size: width:16 height:16. The apron is what the neighbouring tiles show there, kTileApron wide.
//   kMapOfFaces   size: log2 of the segments along u:16 and v:16. Values belong to the nodes between segments, n + 1
//                 along each side; row 0 is at v = 0. The apron is one node wide: what faces across the sides show.
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

// How a map is looked up, for all models of a pipeline.
RELIEF_CONSTANT uint kMapOfTexture = 0u; // one map over the unit square, which repeats or is clamped
RELIEF_CONSTANT uint kMapOfTiles = 1u;
RELIEF_CONSTANT uint kMapOfFaces = 2u;

RELIEF_CONSTANT uint kNoTile = 0xffffffffu;
RELIEF_CONSTANT int kTileApron = 4; // texels; lookups read two, and blocks stay whole
RELIEF_CONSTANT int kFaceApron = 1; // nodes
// A point so near to a tile, in units of tiles, counts as its own where there is no other: coordinates are rounded.
RELIEF_CONSTANT float kTileRounding = 1e-5f;

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
    uint firstWords[kMostMapLevels]; // where each level's words begin; of sets the first is that of all its words
    ivec2 firstTile;                 // sets of unit squares: (s,t) of the first one of the grid
    ivec2 tileCount;                 // and how many there are along s and t
};

// Maps of one model. A lookup chooses its record by one function, mapAt() of heights.glsl.
// Of a vector map the first three are its components.
RELIEF_CONSTANT uint kMostMaps = 3u;

#ifdef __cplusplus
static_assert(sizeof(MapRecord) == 40 + 4 * kMostMapLevels);
} // namespace relief
#endif
#endif
