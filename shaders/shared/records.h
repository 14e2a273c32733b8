// The surface's tables as the device holds them: records of one or two texels of four words, in kBindRecords. What they
// say is in shared/surface.h; here are their bits, from the lowest on.
//
// clang-format off
//              x                            y                        z                          w
//   Face       root                         sides[0]                 sides[1]                   sides[2]
//              sides[3]                     cageFace                 -                          -
//   Edge       face:28 side:2 flags:2       corners[0]:30 span:2     corners[1]:30 partner:2    first incidence, kNoIncidence: smooth
//   Corner     face:28 side:2 flags:2       isMiddle:1 incidences:31    first incidence                -
//   Incidence  face                         side:8 count:24          start                      end
//   Patch      first texel of indices       base                     base of texture points     type:4 type of texture:4
//                                                                                               boundary:5 of texture:5 texels:6
//                                                                                               straight corners:4
// clang-format on
//
// Incidences are counted from the first one. `count` is how many incidences the edge has, in its first; at a corner it
// is Surface::sectorFaces of the incidence. A patch has the texel where the indices of its control points begin: each
// less its base, eight 16-bit numbers per texel; those of its texture coordinates follow after `texels` texels. Where
// the indices of a patch are too far apart for 16 bits all patches have a base of 0 and four 32-bit numbers per texel
// (kHasWideIndices). Before the indices of an exact cap (kPatchExactQuad, kPatchExactTriangle), and before those of its
// texture coordinates, lies one texel: the texel where the weights of its rules begin, its number of points, its
// corner. All weights lie before the patches, four to a texel, as shared/surface.h says.
#ifndef RELIEF_SHARED_RECORDS_H
#define RELIEF_SHARED_RECORDS_H

#include "shared/surface.h"

#ifdef __cplusplus
namespace relief {
#endif

// Texels of a record.
RELIEF_CONSTANT uint kFaceTexels = 2u;
RELIEF_CONSTANT uint kEdgeTexels = 1u;
RELIEF_CONSTANT uint kCornerTexels = 1u;
RELIEF_CONSTANT uint kIncidenceTexels = 1u;
RELIEF_CONSTANT uint kPatchTexels = 1u;

RELIEF_CONSTANT uint kNoIncidence = 0xffffffffu;

// Edge, span: how much of the side the edge is, in the owner's direction.
RELIEF_CONSTANT uint kSpanWhole = 0u;
RELIEF_CONSTANT uint kSpanFirstHalf = 1u;
RELIEF_CONSTANT uint kSpanSecondHalf = 2u;

// Edge, partner: the other half of a split edge is a neighbour in the table.
RELIEF_CONSTANT uint kPartnerNone = 0u;
RELIEF_CONSTANT uint kPartnerNext = 1u;
RELIEF_CONSTANT uint kPartnerBefore = 2u;

#ifdef __cplusplus
} // namespace relief
#endif
#endif
