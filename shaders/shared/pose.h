// What the shaders that pose a cage are given.
#ifndef RELIEF_SHARED_POSE_H
#define RELIEF_SHARED_POSE_H

#include "shared/surface.h"

#ifdef __cplusplus
namespace relief {
#endif

// Set 0 of pose_cage.comp and pose_points.comp: texel buffers.
RELIEF_CONSTANT uint kPoseUpload = 0u;     // floats: the posed cage, or morph weights and three rows of four a joint
RELIEF_CONSTANT uint kPoseRest = 1u;       // the rig's rest points, then the offsets of its morph targets
RELIEF_CONSTANT uint kPoseJoints = 2u;     // joints of each point
RELIEF_CONSTANT uint kPoseInfluences = 3u; // and their weights
RELIEF_CONSTANT uint kPosePoints = 4u;     // posed points, set after set: cage points, then stencil rows
RELIEF_CONSTANT uint kPoseWords = 5u;      // of stencils: first entry of each block and one more, targets, entries
RELIEF_CONSTANT uint kPoseWeights = 6u;    // of stencils
RELIEF_CONSTANT uint kPoseBindCount = 7u;

// Stencils in blocks of sixteen rows over one list of points (entries) that serves all sixteen: neighbouring rows use
// nearly the same points. Entries come in eights; what a row does not use has weight 0. Blocks with as many entries lie
// one behind another. Weight of row r for entries e to e + 3 of all (e a multiple of 4): vector 4 e + r of
// kPoseWeights.
RELIEF_CONSTANT uint kBlockRows = 16u;
RELIEF_CONSTANT uint kEntriesTogether = 8u;

#ifdef __cplusplus
} // namespace relief
#endif
#endif
