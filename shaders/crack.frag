#version 460
#extension GL_GOOGLE_include_directive : require

// Blended by addition, without depth: along any line of sight through a closed surface as many triangles face the eye as face
// away, however it folds, and rasterisation gives every sample on a shared edge to one side. What is left over is a crack.
layout(location = 0) out float crossings;

void main() { crossings = gl_FrontFacing ? 1.0 : -1.0; }
