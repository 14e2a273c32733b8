// The surface as flat arrays; shared/records.h has their bits on the device. A face here is OpenSubdiv's ptex face: a
// quad of the cage, one corner quad of an n-gon, or a triangle of a Loop cage.
//
//   quads (Catmull-Clark, bilinear)        triangles (Loop)
//   corner 3 --- side 2 --- corner 2       corner 2
//      |                       |              |    \ side 1      side s runs from corner s to corner s+1;
//    side 3                  side 1         side 2   \           x along a side goes from 0 to 1
//      |                       |              |       .  .
//   corner 0 --- side 0 --- corner 1       corner 0 -- side 0 -- corner 1
//   (0,0)                   (1,0)          (0,0)                 (1,0)
#ifndef RELIEF_SHARED_SURFACE_H
#define RELIEF_SHARED_SURFACE_H

#include "shared/types.h"

#ifdef __cplusplus
namespace relief {
#endif

// Tree entries: a leaf names a patch, an inner entry names the first of four child entries, kNoPatch is a hole.
// Quad children: 0 (u<½,v<½), 1 (u>=½,v<½), 2 (u<½,v>=½), 3 (both >=½).
// Triangle children: 0 at corner 0, 1 at corner 1 (u>=½), 2 at corner 2 (v>=½), 3 the middle, turned: (½-u, ½-v).
RELIEF_CONSTANT uint kLeafBit = 0x80000000u;
RELIEF_CONSTANT uint kNoPatch = 0xffffffffu;

// Face::sides entries: edge index, how the side runs along it, and whether the side is two edges (beside an n-gon).
// A split side names the first edge of a pair (2 consecutive edges e, e+1 in the edges' direction). Run forwards the
// side is e then e+1; run backwards it is e+1 reversed, then e reversed.
RELIEF_CONSTANT uint kSideReversed = 0x80000000u;
RELIEF_CONSTANT uint kSideSplit = 0x40000000u;
RELIEF_CONSTANT uint kSideEdgeMask = 0x3fffffffu;

// Patch types as OpenSubdiv numbers them (Far::PatchDescriptor).
RELIEF_CONSTANT uint kPatchQuads = 3u;
RELIEF_CONSTANT uint kPatchTriangles = 4u;
RELIEF_CONSTANT uint kPatchLoop = 5u;
RELIEF_CONSTANT uint kPatchRegular = 6u;
RELIEF_CONSTANT uint kPatchGregory = 9u;
RELIEF_CONSTANT uint kPatchGregoryTriangle = 10u;

// And those that OpenSubdiv has not: the limit surface in a face with one extraordinary vertex. Their number of control
// points depends on the vertex. Each pattern of rules around a vertex has a table of weights (Surface::capTables,
// surface/caps.h): per level 1 .. kCapLevels, piece 0 .. 2 and point, 16 weights of a quad's piece or 12 of a
// triangle's; then per point the weights of p_u and p_v at the vertex, 2 numbers and 2 that are 0.
RELIEF_CONSTANT uint kPatchExactQuad = 11u;
RELIEF_CONSTANT uint kPatchExactTriangle = 12u;
RELIEF_CONSTANT uint kCapLevels = 18u; // 2^-18 of the cap's size: nearer to the vertex the last level goes on
RELIEF_CONSTANT uint kCapPieces = 3u;

// What an edge or corner is besides.
RELIEF_CONSTANT uint kOnBoundary = 1u; // an edge of one drawn face alone, or an end of such an edge
RELIEF_CONSTANT uint kOnSeam = 2u;     // an edge whose faces have texture coordinates of their own

// Texels of kBindMeshTexGradients per vertex: the gradients of s and of t; where fragments evaluate a height function,
// then also the columns of vRestGradient with vRest in their w (shaders/varyings.glsl).
RELIEF_CONSTANT uint kGradientTexels = 2u;
RELIEF_CONSTANT uint kRestGradientTexels = 5u;

// Control points of a patch; 0 where the type does not say.
RELIEF_SHARED_FUNCTION uint patchSize(uint type) {
    return type == kPatchRegular           ? 16u
           : type == kPatchGregory         ? 20u
           : type == kPatchQuads           ? 4u
           : type == kPatchLoop            ? 12u
           : type == kPatchGregoryTriangle ? 18u
           : type == kPatchTriangles       ? 3u
                                           : 0u;
}

// A corner of a face is straight where its two sides continue each other: the face lies alone between two edges that
// are one smooth curve (a corner of a smooth boundary, a creased rim). Its tangents along the two sides are t and -t,
// so p_u x p_v vanishes there. The normal is the limit along the diagonal from the corner into the face: after the step
// s the product is s (t x d) to first order, where d is the second derivative of p along the diagonal. Around a vertex
// of two faces both tangents vanish; there t and d are the derivatives along the diagonal of the tangents of the two
// sides, and the product is s^2 (t x d). Around a vertex of more than 60 faces t and d are two tangents a quarter turn
// apart, since those of one face nearly coincide. The points p + t and p + d (p, t, d by the face's coordinates) follow
// the control points of the patch, two per such corner in the order of its corners: their rounding is that of points,
// where differences of control points lose all digits.

struct Patch {
    uint firstPoint;      // into Surface::patchPoints
    uint param0;          // Far::PatchParam::field0
    uint param1;          // Far::PatchParam::field1
    uint type;            // kPatch...
    uint texFirstPoint;   // into Surface::texPatchPoints
    uint texParam1;       // the face-varying patch's field1 (its boundary mask differs)
    uint texType;         // kPatch...
    uint straightCorners; // bit c: corner c is straight or narrow, or its tangents vanish
    uint pointCount;      // control points; those of straight corners follow
    uint texPointCount;
    uint cap; // of exact patches: Surface::capTables * 4 + the corner that is the extraordinary vertex
};

struct Face {
    uint root;     // tree entry
    uint sides[4]; // 3 used by triangles
    uint cageFace; // the face of the cage that this one belongs to
};

// A stretch of one side of one face: an edge's parameter t in [0,1] is at x = start + t (end - start) along the side.
struct Incidence {
    uint face;
    uint side; // for corners: start = end, 0 at the face's corner `side`, ½ in the middle of a split side
    float start;
    float end;
};

// Every edge has one owner, the incident face with the lowest index; its direction is the owner's (start < end).
struct Edge {
    Incidence owner;
    uint corners[2];     // at t = 0 and t = 1
    uint firstIncidence; // into Surface::incidences: all incident faces in index order,
    uint incidenceCount; // or 0 where the owner's normal is the surface's (smooth edges)
    uint partner;        // the other half of a split cage edge, or the edge itself
    uint flags;          // kOn...
};

struct Corner {
    Incidence owner;
    uint firstIncidence; // as for edges
    uint incidenceCount;
    uint flags; // kOn...
};

#ifdef __cplusplus
static_assert(sizeof(Patch) == 44 && sizeof(Face) == 24 && sizeof(Incidence) == 16);
static_assert(sizeof(Edge) == 40 && sizeof(Corner) == 28);
} // namespace relief
#endif
#endif
