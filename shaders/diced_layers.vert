#version 460
#extension GL_GOOGLE_include_directive : require
#include "inputs.glsl"

// One face of a diced mesh, whose fragments know where in it they lie.
layout(push_constant, scalar) uniform PushBlock { DicedFacePush push; };
#define RELIEF_DICED_FACE push
#include "diced_points.glsl"
#define RELIEF_VARYING out
#include "varyings.glsl"
#include "project.glsl"

RELIEF_TABLE(kBindMesh, vec4, meshAt)
RELIEF_TABLE(kBindMeshTexCoords, vec2, meshTexCoords)
#include "mesh_gradients.glsl"

layout(constant_id = kIdHasTexCoords) const bool kHasTexCoords = false;
layout(constant_id = kIdWantsTexCoords) const bool kWantsTexCoords = false;

void main() {
    uint vertex = uint(gl_VertexIndex);
    vec4 at = meshAt(2u * vertex);
    precise vec4 clip = project(at.xyz);
    gl_Position = clip;
    vNormal = worldNormal(meshAt(2u * vertex + 1u).xyz);
    vec2 uv = dicedPoint(vertex);
    vTexCoord = vec4(kHasTexCoords && kWantsTexCoords ? meshTexCoords(vertex) : uv, uv);
    vHeight = at.w;
    readGradients(vertex);
    if (!kHasTexGradients) vGradientS = vec4(at.xyz, 0.0);
    vFace = push.face;
    vRate = 1u;
}
