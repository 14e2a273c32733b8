// How a stage reaches its scene. Included before anything else.
#ifndef RELIEF_SCENE_GLSL
#define RELIEF_SCENE_GLSL

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

#include "shared/scene.h"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer SceneBuffer { Scene data; };

layout(push_constant, scalar) uniform Push {
    SceneBuffer sceneBuffer;
    uint passNumber;     // grid: segments a side; sample: number of queries
    uint drawsShadow;    // 1: from the key light
};

#define scene sceneBuffer.data

#endif
