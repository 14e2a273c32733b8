// What every pass is given: one Scene in a buffer, whose address is the first push constant.
#ifndef RELIEF_SHARED_SCENE_H
#define RELIEF_SHARED_SCENE_H

#include "shared/sample.h"
#include "shared/surface.h"

#ifdef __cplusplus
namespace relief {
#define RELIEF_ADDRESS(type) std::uint64_t
using ivec4 = glm::ivec4;
#else
#define RELIEF_ARRAY(name, type)                                                                                       \
    layout(buffer_reference, scalar, buffer_reference_align = 4) buffer name { type at[]; };
#define RELIEF_ADDRESS(type) type
RELIEF_ARRAY(Faces, Face)
RELIEF_ARRAY(Patches, Patch)
RELIEF_ARRAY(Edges, Edge)
RELIEF_ARRAY(Corners, Corner)
RELIEF_ARRAY(Touches, Touch)
RELIEF_ARRAY(Words, uint)
RELIEF_ARRAY(Points, vec3)
RELIEF_ARRAY(TexPoints, vec2)
RELIEF_ARRAY(Queries, SampleQuery)
RELIEF_ARRAY(Results, SampleResult)
#endif

// --show
RELIEF_CONSTANT uint kShowShaded = 0u;
RELIEF_CONSTANT uint kShowNormal = 1u;
RELIEF_CONSTANT uint kShowHeight = 2u;
RELIEF_CONSTANT uint kShowRate = 3u;
RELIEF_CONSTANT uint kShowFaces = 4u;
RELIEF_CONSTANT uint kShowWireframe = 5u; // the surface under the lines
RELIEF_CONSTANT uint kShowLines = 6u;     // the lines themselves

// --normal
RELIEF_CONSTANT uint kNormalLimit = 0u;
RELIEF_CONSTANT uint kNormalFirstOrder = 1u;
RELIEF_CONSTANT uint kNormalFull = 2u;

struct Scene {
    // The surface (shared/surface.h).
    RELIEF_ADDRESS(Faces) faces;
    RELIEF_ADDRESS(Words) tree;
    RELIEF_ADDRESS(Patches) patches;
    RELIEF_ADDRESS(Words) patchPoints;
    RELIEF_ADDRESS(Points) points;
    RELIEF_ADDRESS(Words) texPatchPoints;
    RELIEF_ADDRESS(TexPoints) texPoints;
    RELIEF_ADDRESS(Edges) edges;
    RELIEF_ADDRESS(Corners) corners;
    RELIEF_ADDRESS(Touches) touches;
    // Segments an edge, and the faces to draw in order: written per frame.
    RELIEF_ADDRESS(Words) edgeRates;
    RELIEF_ADDRESS(Words) drawFaces;
    // A dense mesh, where one is drawn instead.
    RELIEF_ADDRESS(Points) meshPositions;
    RELIEF_ADDRESS(Points) meshNormals;
    RELIEF_ADDRESS(TexPoints) meshTexCoords;
    // Single points, where they are asked for.
    RELIEF_ADDRESS(Queries) sampleQueries;
    RELIEF_ADDRESS(Results) sampleResults;

    // h = heightScale * (texel - heightMid) in cage units; a map of 0 x 0 is no displacement.
    ivec2 mapSize;
    float heightMid;
    float heightScale;
    uint mapRepeats;     // 1 repeat, 0 clamp
    uint edgeCount;

    // One rate an edge from its length on screen: pixels = world length * pixelsAtUnitDistance / distance.
    float pixelsAtUnitDistance;
    float edgePixels;
    uint maxRate;
    float nearDistance;

    mat4 worldToClip;
    vec3 eye;
    float exposure;
    vec3 keyDirection;      // towards the light, unit
    vec3 keyRadiance;
    vec3 irradiance[9];     // the environment's spherical harmonics, convolved with the cosine lobe
    float environmentLevel; // of the environment map, for a roughness of 1
    vec3 albedo;            // linear; times the albedo map where there is one
    float roughness;
    float heightReach;      // largest |h|, for --show height
    mat4 worldToShadow;
    float hasShadows;       // 1 or 0
    float shadowBias;       // cage units along the normal
    float shadowSoftness;   // radius of the filter, as a fraction of the shadow map
};

#ifdef __cplusplus
static_assert(sizeof(Scene) % 8 == 0 && offsetof(Scene, mapSize) == 17 * 8 && offsetof(Scene, worldToClip) == 17 * 8 + 40);
} // namespace relief
#endif
#endif
