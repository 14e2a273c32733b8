// How the dicing shaders write a vertex. Included after displaced.glsl.
#ifndef RELIEF_DICE_STORE_GLSL
#define RELIEF_DICE_STORE_GLSL

void storeVertex(uint vertex, DisplacedSample s) {
    inputs.targets.dicedVertices.at[2u * vertex] = vec4(s.q, s.h);
    inputs.targets.dicedVertices.at[2u * vertex + 1u] = vec4(s.normal, 0.0);
    if (kHasTexCoords && kWantsTexCoords) inputs.targets.dicedTexCoords.at[vertex] = s.st;
    if (!kHasTexGradients) return;
    inputs.targets.dicedTexGradients.at[2u * vertex] = s.gradientS;
    inputs.targets.dicedTexGradients.at[2u * vertex + 1u] = s.gradientT;
}
#endif
