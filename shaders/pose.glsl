// What the shaders that pose a cage or a mesh share. They know nothing of a picture.
#extension GL_EXT_buffer_reference : require

#include "tables.glsl"
#include "shared/constants.h"
#include "shared/pose.h"

layout(push_constant, scalar) uniform PushBlock { PosePush push; };
