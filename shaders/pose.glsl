// What the shaders that pose a cage or a mesh share. None of them depends on a picture.
#extension GL_EXT_buffer_reference : require

#include "tables.glsl"
#include "shared/constants.h"
#include "shared/pose.h"

layout(push_constant, scalar) uniform PushBlock { PosePush push; };
