// What the host hands to the dicing shaders. A diced mesh has one vertex for every distinct sample of the surface, and
// split vertices where shading attributes differ (sharp edges, texture seams): runs along edges, of which corners are
// runs of one, then the insides of faces.
#ifndef RELIEF_SHARED_DICE_H
#define RELIEF_SHARED_DICE_H

#include "shared/surface.h"

#ifdef __cplusplus
#include <algorithm>
#endif

#ifdef __cplusplus
namespace relief {
#endif

// Vertices of one edge or corner that share their attributes.
struct VertexRun {
    Incidence incidence; // a face that they belong to
    uint element;        // the edge, or the corner
    uint isCorner;
};

// Runs around a face.
struct FaceRuns {
    uint corners[4];
    uint middles[4]; // of split sides
    uint sides[8];   // side s: 2 s and, the other half of a split one, 2 s + 1; halves in the edges' direction
};

// Inner samples of a face that lie in one leaf of its tree: i in [first, first + size) along u, j along v.
struct InsideTile {
    uint face;
    uint patchIndex;
    uint firstIJ; // two halves: i, j << 16
    uint sizeIJ;
    uint segments;    // of the face: along u, along v << 16
    uint depth;       // the leaf's (u,v) is 2^depth (u,v) of the face less origin
    uint origin;      // u, v << 16
    uint firstVertex; // of the face's inside
};

// Samples of a run that lie in bicubic patches of the owner, of the surface and of its texture coordinates.
struct EdgePiece {
    uint run;
    uint firstK; // in the edge's direction
    uint endK;   // one past the last
    uint unused;
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
RELIEF_CONSTANT uint kEdgePieceTexels = 1u;
RELIEF_CONSTANT uint kTriangleTileTexels = 1u;

RELIEF_CONSTANT uint kTrianglesPerTile = 256u;

#ifdef __cplusplus
namespace formulas {
using std::max;
#endif

// --- triangles of one face ---
// Inner samples form a lattice of n.x by n.y segments without its border (of a triangle: n.x segments per side). Each
// side has a ring of triangles that joins its segments to those of the inner samples beside it; within are the cells.

// A face with more than one segment has at least one inner sample: a lattice of 1 segment beside sides with more counts
// as 2, and as 3 in a triangle.
RELIEF_SHARED_FUNCTION uint atLeastInner(uint sideCount, uint segments) {
    return max(segments, sideCount == 3u ? 3u : 2u);
}

RELIEF_SHARED_FUNCTION uvec2 latticeSegments(uint sideCount, uint side0, uint side1, uint side2, uint side3) {
    if (sideCount == 3u) return uvec2(atLeastInner(3u, max(side0, max(side1, side2))));
    return uvec2(atLeastInner(4u, max(side0, side2)), atLeastInner(4u, max(side1, side3)));
}

// Segments of the inner samples beside a side.
RELIEF_SHARED_FUNCTION uint innerSegments(uint sideCount, uint side, uvec2 n) {
    if (sideCount == 3u) return n.x - 3u;
    return (side % 2u == 0u ? n.x : n.y) - 2u;
}

// Triangles of all rings: one per segment of the sides, `sum` together, and one per inner segment.
RELIEF_SHARED_FUNCTION uint ringTriangles(uint sideCount, uint sum, uvec2 n) {
    for (uint side = 0u; side < sideCount; ++side) sum += innerSegments(sideCount, side, n);
    return sum;
}

// Triangles of the cells: between inner samples alone.
RELIEF_SHARED_FUNCTION uint cellTriangles(uint sideCount, uvec2 n) {
    if (sideCount == 3u) return (n.x - 3u) * (n.x - 3u);
    return 2u * (n.x - 2u) * (n.y - 2u);
}

#ifdef __cplusplus
} // namespace formulas
static_assert(sizeof(VertexRun) == 24 && sizeof(FaceRuns) == 64 && sizeof(InsideTile) == 32 &&
              sizeof(EdgePiece) == 16 && sizeof(TriangleTile) == 16);
} // namespace relief
#endif
#endif
