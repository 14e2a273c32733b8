// What the shaders that pose a cage are given.
#ifndef RELIEF_SHARED_POSE_H
#define RELIEF_SHARED_POSE_H

#include "shared/surface.h"

#ifdef __cplusplus
namespace relief {
#endif

// Set 0 of pose_cage.comp, pose_mesh.comp, pose_points.comp and pose_blocks.comp: tables (shaders/tables.glsl).
RELIEF_CONSTANT uint kPoseUpload = 0u;     // floats: the posed cage, or morph weights and three rows of four per joint
RELIEF_CONSTANT uint kPoseRest = 1u;       // the rig's rest points, then the offsets of its morph targets
RELIEF_CONSTANT uint kPoseJoints = 2u;     // joints of each point
RELIEF_CONSTANT uint kPoseInfluences = 3u; // and their weights
RELIEF_CONSTANT uint kPosePoints = 4u;     // posed points, set after set: cage points, then stencil rows
RELIEF_CONSTANT uint kPoseWords = 5u;      // of stencils: first entry of each block and one more, targets, entries
RELIEF_CONSTANT uint kPoseWeights = 6u;    // of stencils
RELIEF_CONSTANT uint kPoseGradients = 7u;  // pose_mesh.comp: kBindMeshTexGradients of the mesh at rest
RELIEF_CONSTANT uint kPoseBindCount = 8u;

// Stencils in blocks of sixteen rows over one list of points (entries) that serves all sixteen: neighbouring rows use
// nearly the same points. Entries come in eights; what a row does not use has weight 0. Blocks with as many entries lie
// one behind another. Weight of row r for entries e to e + 3 of all (e a multiple of 4): vector 4 e + r of
// kPoseWeights, a whole number; a target is the row and, in its upper five bits, 31 more than the exponent of its
// weights (Stencils::scales).
RELIEF_CONSTANT uint kBlockRows = 16u;
RELIEF_CONSTANT uint kEntriesTogether = 8u;
RELIEF_CONSTANT uint kTargetRowBits = 27u;

// Sums of rows that are finer than floats: upper bits of weights times offsets in whole units are whole numbers that
// floats add up exactly while their sizes add up to less than 2^24; all else is smaller by as many bits, and so is its
// rounding.
RELIEF_CONSTANT int kFineWeightBits = 19; // the others: the upper ones of a row add up to 2^12 at most
RELIEF_CONSTANT int kOffsetBits = 12;

#ifndef __cplusplus
layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Points { vec4 at[]; };
#endif

// Push constants of all four.
struct PosePush {
    RELIEF_ADDRESS(Points) target; // all posed points
    uint firstPoint;               // of the set that is written; pose_mesh.comp: of the dispatch
    uint pointCount;               // of the cage, or of the mesh
    uint firstBlock;               // of the dispatch
    uint endBlock;
    uint firstBlockEntry;
    uint firstTarget; // words of kPoseWords
    uint firstEntry;
    uint influenceCount; // joints per point
    uint morphCount;
    uint isRigged;                    // 1: the upload is morph weights and joints
    RELIEF_ADDRESS(Points) gradients; // pose_mesh.comp: kBindMeshTexGradients
    uint gradientTexels;              // of them per vertex, or 0
    float offsetUnit;                 // a power of two: 2^kOffsetBits of it are as long as the cage's box
};

#ifdef __cplusplus
static_assert(sizeof(PosePush) == 64);
} // namespace relief
#endif
#endif
