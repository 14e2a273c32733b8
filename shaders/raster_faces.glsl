// The points of a diced surface that samples show: the face of a triangle, and where vertices lie in it. Included before
// raster_points.glsl.
#ifndef RELIEF_RASTER_FACES_GLSL
#define RELIEF_RASTER_FACES_GLSL

#include "inputs.glsl"
DicedFacePush dicedFace;
#define RELIEF_DICED_FACE dicedFace
#include "diced_points.glsl"

RELIEF_TABLE(kBindDiceTable, uint, dicedWord) // a DicedFacePush per face

const uint kFaceWords = 30u;

void fetchDicedFace(uint face) {
    uint at = kFaceWords * face;
    dicedFace.face = dicedWord(at);
    dicedFace.firstInside = dicedWord(at + 1u);
    for (uint i = 0u; i < 4u; ++i) {
        dicedFace.sides[i] = dicedWord(at + 2u + i);
        dicedFace.segments[i] = dicedWord(at + 6u + i);
        dicedFace.rates[i] = uintBitsToFloat(dicedWord(at + 10u + i));
        dicedFace.runs.corners[i] = dicedWord(at + 14u + i);
        dicedFace.runs.middles[i] = dicedWord(at + 18u + i);
    }
    for (uint i = 0u; i < 8u; ++i) dicedFace.runs.sides[i] = dicedWord(at + 22u + i);
}
#endif
