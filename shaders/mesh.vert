#version 460
#extension GL_GOOGLE_include_directive : require
#include "inputs.glsl"
#define RELIEF_VARYING out
#include "varyings.glsl"
#include "project.glsl"
#include "vertex_table.glsl"

// A triangle mesh as it is: a dense one, which displaced surfaces are compared with, or one that was diced.
layout(push_constant, scalar) uniform PushBlock { MeshPush push; };

RELIEF_TABLE(kBindMesh, vec4, meshAt)
RELIEF_TABLE(kBindMeshTexCoords, vec2, meshTexCoords)
#include "mesh_gradients.glsl"

layout(constant_id = kIdHasTexCoords) const bool kHasTexCoords = false;
layout(constant_id = kIdWantsTexCoords) const bool kWantsTexCoords = false;

void main() {
    vec4 vertex = meshAt(2 * gl_VertexIndex);
    precise vec4 clip = project(vertex.xyz);
    gl_Position = clip;
    vNormal = worldNormal(meshAt(2 * gl_VertexIndex + 1).xyz);
    vTexCoord = vec4(kHasTexCoords && kWantsTexCoords ? meshTexCoords(gl_VertexIndex) : vec2(0), vec2(0));
    if (kShading == kShadingVertexTable && kPass == kPassSurface)
        vTexCoord.zw = tableCoordinates(vNormal, vertex.xyz);
    vHeight = vertex.w;
    readGradients(uint(gl_VertexIndex));
    // A draw of one face carries its number; a whole mesh in one draw shows patches of 64 vertices instead.
    vFace = push.isOneFace != 0u ? cageFaceOf(push.face) : uint(gl_VertexIndex) / 64u;
    vRate = max(push.rate, 1u);
}
