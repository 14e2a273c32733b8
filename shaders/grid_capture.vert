#version 460
#extension GL_GOOGLE_include_directive : require
#define RELIEF_CAPTURES_STORED
#include "grid.glsl"
