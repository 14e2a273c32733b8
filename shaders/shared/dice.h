// What the host hands to the dicing shaders. A diced mesh has one vertex for every distinct sample of the surface, and more where
// shading attributes part (sharp edges, texture seams): runs along edges, of which corners are runs of one, then the insides
// of faces.
#ifndef RELIEF_SHARED_DICE_H
#define RELIEF_SHARED_DICE_H

#include "shared/surface.h"

#ifdef __cplusplus
namespace relief {
#endif

// Vertices of one edge or corner that share their attributes.
struct VertexRun {
    Incidence incidence;       // a face that they belong to
    uint element;      // the edge, or the corner
    uint isCorner;
};

// Runs around a face.
struct FaceRuns {
    uint corners[4];
    uint middles[4];   // of split sides
    uint sides[8];     // side s: 2 s and, the other half of a split one, 2 s + 1; halves in the edges' direction
};

// Inner samples of a face that lie in one leaf of its tree: i in [first, first + size) along u, j along v.
struct InsideTile {
    uint face;
    uint patchIndex;
    uint firstIJ;      // two halves: i, j << 16
    uint sizeIJ;
    uint segments;     // of the face: along u, along v << 16
    uint depth;        // the leaf's (u,v) is 2^depth (u,v) of the face less origin
    uint origin;       // u, v << 16
    uint firstVertex;  // of the face's inside
};

// A run of triangles of one face.
struct TriangleTile {
    uint face;
    uint firstInFace;
    uint firstTriangle; // in the mesh
    uint firstVertex;   // of the face's inside
};

// Texels of four words that a record takes.
RELIEF_CONSTANT uint kRunTexels = 2u;
RELIEF_CONSTANT uint kFaceRunsTexels = 4u;
RELIEF_CONSTANT uint kInsideTileTexels = 2u;
RELIEF_CONSTANT uint kTriangleTileTexels = 1u;

RELIEF_CONSTANT uint kTrianglesPerTile = 256u;

#ifdef __cplusplus
static_assert(sizeof(VertexRun) == 24 && sizeof(FaceRuns) == 64 && sizeof(InsideTile) == 32 && sizeof(TriangleTile) == 16);
} // namespace relief
#endif
#endif
