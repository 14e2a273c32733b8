// How the dicing shaders write a vertex. Included after displaced.glsl.
#ifndef RELIEF_DICE_STORE_GLSL
#define RELIEF_DICE_STORE_GLSL

void storeVertex(uint vertex, DisplacedSample s) {
    inputs.targets.dicedVertices.at[2u * vertex] = vec4(s.q, s.h);
    inputs.targets.dicedVertices.at[2u * vertex + 1u] = vec4(s.normal, 0.0);
    if (kHasTexCoords && kWantsTexCoords) inputs.targets.dicedTexCoords.at[vertex] = s.st;
    if (!kHasTangents) return;
    inputs.targets.dicedTangents.at[2u * vertex] = s.tangentS;
    inputs.targets.dicedTangents.at[2u * vertex + 1u] = s.tangentT;
}
#endif
