// Push constants: one block per pass that has any.
#ifndef RELIEF_SHARED_PUSH_H
#define RELIEF_SHARED_PUSH_H

#include "shared/dice.h"

#ifdef __cplusplus
namespace relief {
#endif

// grid.vert, grid_capture.vert: a batch of faces with as many segments along u and v.
struct GridPush {
    uint columns;       // segments along u
    uint rows;          // segments along v
    uint firstCaptured; // where the batch's captured vertices begin, less those of the instances before it
};

// mesh.vert: a whole mesh, or the triangles of one face of a diced one.
struct MeshPush {
    uint isOneFace; // 1: the fields below hold
    uint face;
    uint rate; // largest of the face's sides
};

// diced_layers.vert: one face of a diced mesh, with what the numbers of its vertices mean.
struct DicedFacePush {
    uint face;
    uint firstInside; // vertex; those of all sides are before it
    uint sides[4];    // as Face::sides
    uint segments[4]; // of the sides
    float rates[4];   // of the sides
    FaceRuns runs;    // the first vertex of each
};

// dice_*.comp: invocations, workgroups or tiles of one of many dispatches.
struct DicePush {
    uint first; // number of the dispatch's first workgroup
    uint count; // dice_edges.comp: vertices of all dispatches
    uint list;  // dice_edges.comp: texel of kBindDiceTiles where the list of these vertices begins, four per texel
};

// raster_*.comp
struct RasterPush {
    ivec2 size;            // pixels of the target
    uint first;            // number of the dispatch's first vertex or triangle
    uint count;            // of all dispatches
    float depthAtInfinity; // of the projection, below 0: depth = depthAtInfinity + c / w
    uint firstId;          // number of the mesh's first triangle, among those of all instances
    uint faceCount;        // raster_resolve.comp: of a diced mesh
};

// sample.comp
struct SamplePush {
    uint count; // queries
};

#ifdef __cplusplus
static_assert(sizeof(GridPush) == 12 && sizeof(MeshPush) == 12 && sizeof(DicePush) == 12 && sizeof(SamplePush) == 4 &&
              sizeof(DicedFacePush) == 120 && sizeof(RasterPush) == 28);

// Bytes that every pipeline's layout reserves: what the largest block takes. Vulkan promises 128.
inline constexpr uint kPushBytes = 120;
} // namespace relief
#endif
#endif
