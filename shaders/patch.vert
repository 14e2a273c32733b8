#version 460
#extension GL_GOOGLE_include_directive : require
#include "inputs.glsl"

// One point per face: its number travels to the control stage.
layout(location = 0) flat out uint face;

void main() { face = drawFace(gl_VertexIndex); }
