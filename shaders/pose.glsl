// What the shaders that pose a cage share. They know nothing of a scene.
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/pose.h"

layout(buffer_reference, scalar, buffer_reference_align = 16) buffer Points { vec4 at[]; };

layout(push_constant, scalar) uniform Push {
    Points target;        // all posed points
    uint firstPoint;      // of the set that is written
    uint pointCount;      // of the cage
    uint firstBlock;      // of the dispatch
    uint endBlock;
    uint firstBlockEntry;
    uint firstTarget;     // words of kPoseWords
    uint firstEntry;
    uint influenceCount;
    uint morphCount;
    uint isRigged;        // 1: the upload is morph weights and joints
};

layout(set = 0, binding = kPosePoints) uniform samplerBuffer pointTexels;
