// How the dicing shaders write a vertex. Included after displaced.glsl.
#ifndef RELIEF_DICE_STORE_GLSL
#define RELIEF_DICE_STORE_GLSL

void storeVertex(uint vertex, DisplacedSample s) {
    inputs.targets.dicedVertices.at[2u * vertex] = vec4(s.q, s.h);
    inputs.targets.dicedVertices.at[2u * vertex + 1u] = vec4(s.normal, 0.0);
    if (kHasTexCoords && kWantsTexCoords) inputs.targets.dicedTexCoords.at[vertex] = s.st;
    if (!kHasTexGradients) return;
#ifdef RELIEF_HEIGHT_FUNCTION
    uint first = (kHasSlopes ? kRestGradientTexels : kGradientTexels) * vertex;
#else
    uint first = kGradientTexels * vertex;
#endif
    inputs.targets.dicedTexGradients.at[first] = s.gradientS;
    inputs.targets.dicedTexGradients.at[first + 1u] = s.gradientT;
#ifdef RELIEF_HEIGHT_FUNCTION
    if (!kHasSlopes) return;
    for (uint i = 0u; i < 3u; ++i)
        inputs.targets.dicedTexGradients.at[first + kGradientTexels + i] = vec4(s.restGradient[i], s.rest[i]);
#endif
}
#endif
