// What the vertices of a mesh carry for fragments that bend normals. Included after varyings.glsl and project.glsl.
#ifndef RELIEF_MESH_GRADIENTS_GLSL
#define RELIEF_MESH_GRADIENTS_GLSL

RELIEF_TABLE(kBindMeshTexGradients, vec4, meshTexGradients)

#ifdef RELIEF_HEIGHT_FUNCTION
layout(constant_id = kIdHasSlopes) const bool kHasSlopes = false; // by the function: the table has what it is given
#else
const bool kHasSlopes = false;
#endif

void readGradients(uint vertex) {
    uint first = (kHasSlopes ? kRestGradientTexels : kGradientTexels) * vertex;
    vGradientS = kHasTexGradients ? worldGradient(meshTexGradients(first)) : vec4(0);
    vGradientT = kHasTexGradients ? worldGradient(meshTexGradients(first + 1u)) : vec4(0);
#ifdef RELIEF_HEIGHT_FUNCTION
    vec4 columns[3];
    for (uint i = 0u; i < 3u; ++i) columns[i] = kHasSlopes ? meshTexGradients(first + kGradientTexels + i) : vec4(0);
    vRest = vec3(columns[0].w, columns[1].w, columns[2].w);
    vRestGradient = worldGradients(mat3(columns[0].xyz, columns[1].xyz, columns[2].xyz));
#endif
}
#endif
