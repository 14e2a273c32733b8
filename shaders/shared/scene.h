// What every pass is given: one Scene in a uniform buffer, and the surface in texel buffers. Texel fetches are gathered
// for all lanes at once on CPU drivers, where a load through an address is a loop over the lanes (5 to 10 times slower),
// and go through the texture caches of GPUs.
#ifndef RELIEF_SHARED_SCENE_H
#define RELIEF_SHARED_SCENE_H

#include "shared/maps.h"
#include "shared/records.h"
#include "shared/sample.h"

#ifdef __cplusplus
namespace relief {
#define RELIEF_ADDRESS(type) std::uint64_t
#else
#define RELIEF_ARRAY(name, type)                                                                                       \
    layout(buffer_reference, scalar, buffer_reference_align = 4) buffer name { type at[]; };
#define RELIEF_ADDRESS(type) type
RELIEF_ARRAY(Words, uint)
RELIEF_ARRAY(Floats, float)
RELIEF_ARRAY(WordPairs, uvec2)
RELIEF_ARRAY(Vectors, vec4)
RELIEF_ARRAY(Pairs, vec2)
RELIEF_ARRAY(Queries, SampleQuery)
RELIEF_ARRAY(Results, SampleResult)
#endif

// Set 0.
RELIEF_CONSTANT uint kBindScene = 0u;
RELIEF_CONSTANT uint kBindHeight = 1u;       // words of the height map: shared/maps.h
RELIEF_CONSTANT uint kBindAlbedo = 2u;       // sampled images
RELIEF_CONSTANT uint kBindEnvironment = 3u;
RELIEF_CONSTANT uint kBindShadow = 4u;
RELIEF_CONSTANT uint kBindRecords = 5u;      // texel buffers: faces, patches and their control points, edges, corners, incidences: shared/records.h
RELIEF_CONSTANT uint kBindTree = 6u;        // tree
RELIEF_CONSTANT uint kBindPoints = 7u;
RELIEF_CONSTANT uint kBindTexPoints = 8u;
RELIEF_CONSTANT uint kBindEdgeRates = 9u;    // segments an edge, floats: written per frame
RELIEF_CONSTANT uint kBindDrawFaces = 10u;   // faces to draw in order: written per frame
RELIEF_CONSTANT uint kBindMesh = 11u;        // of a dense or diced mesh: position with height and normal in turn
RELIEF_CONSTANT uint kBindMeshTexCoords = 12u;
RELIEF_CONSTANT uint kBindDiceTable = 13u;   // runs of vertices and those around faces: shared/dice.h
RELIEF_CONSTANT uint kBindDiceTiles = 14u;   // written per frame
RELIEF_CONSTANT uint kBindDiceFirsts = 15u;  // first vertex of each run: written per frame
RELIEF_CONSTANT uint kBindLevels = 16u;      // mip levels of the height map: one a corner, then four a face
RELIEF_CONSTANT uint kBindEdgeHeights = 17u; // how far heights range along each edge, cage units
RELIEF_CONSTANT uint kBindDepths = 18u;      // the samples of a picture
RELIEF_CONSTANT uint kBindNormals = 19u;
RELIEF_CONSTANT uint kBindColors = 20u;
RELIEF_CONSTANT uint kBindCount = 21u;

// What footprints.comp leaves for each edge: its length in texels, the lowest and the highest (s,t) on it.
RELIEF_CONSTANT uint kFootprintFloats = 5u;

// --show
RELIEF_CONSTANT uint kShowShaded = 0u;
RELIEF_CONSTANT uint kShowNormal = 1u;
RELIEF_CONSTANT uint kShowHeight = 2u;
RELIEF_CONSTANT uint kShowRate = 3u;
RELIEF_CONSTANT uint kShowFaces = 4u;
RELIEF_CONSTANT uint kShowWireframe = 5u; // the surface under the lines
RELIEF_CONSTANT uint kShowLines = 6u;     // the lines themselves
RELIEF_CONSTANT uint kShowCracks = 7u;    // front faces count up, back faces down: closed surfaces add up to 0
RELIEF_CONSTANT uint kShowLayers = 8u;    // what layers.comp reads

// --normal
RELIEF_CONSTANT uint kNormalLimit = 0u;
RELIEF_CONSTANT uint kNormalFirstOrder = 1u;
RELIEF_CONSTANT uint kNormalFull = 2u;

struct Scene {
    // Written through addresses: light.comp (four halves a pixel), rates.comp, sample.comp, ...
    RELIEF_ADDRESS(WordPairs) pictureTarget;
    RELIEF_ADDRESS(Floats) edgeTarget;
    RELIEF_ADDRESS(Queries) sampleQueries;
    RELIEF_ADDRESS(Results) sampleResults;
    RELIEF_ADDRESS(Vectors) captureTarget;
    RELIEF_ADDRESS(Vectors) dicedVertices;   // as kBindMesh
    RELIEF_ADDRESS(Pairs) dicedTexCoords;
    RELIEF_ADDRESS(Words) dicedIndices;
    RELIEF_ADDRESS(Floats) layerTarget;      // layers.comp: kLayerChannels floats a pixel

    // Where each array starts: texels of kBindRecords.
    uint firstFace;
    uint firstPatch;
    uint firstEdge;
    uint firstCorner;
    uint firstIncidence;
    uint firstFaceRuns;      // texels of kBindDiceTable; runs are at 0
    uint cornerRunCount;     // runs of one vertex: the first ones
    uint runCount;

    // First texel of each pose in kBindPoints.
    uint pointsNow;
    uint pointsBefore;
    uint pointsRest;

    // h = heightScale * (number - heightMid) in cage units, of the numbers that the map's words hold; a map of 0 x 0 is no
    // displacement.
    ivec2 mapSize;
    float heightMid;
    float heightScale;
    uint mapRepeats;     // 1 repeat, 0 clamp
    uint mapLevels;
    uint mapFirsts[16];  // where each level's words begin; a level is half as large as the one before, at least 1
    uint firstFaceLevel; // texel of kBindLevels
    uint edgeCount;

    // One rate an edge from its length on screen: pixels = world length * pixelsAtUnitDistance / distance.
    float pixelsAtUnitDistance;
    float edgePixels;
    uint maxRate;
    float nearDistance;
    uint isFractional;   // --spacing fractional: rates need not be whole

    mat4 worldToClip;
    mat4 clipToWorld;
    mat4 worldToClipBefore; // of the frame that motion is measured from
    ivec2 pictureSize;
    vec3 eye;
    float exposure;
    vec3 keyDirection;      // towards the light, unit
    vec3 keyRadiance;
    vec3 irradiance[9];     // the environment's spherical harmonics, convolved with the cosine lobe
    float environmentLevel; // of the environment map for this roughness, a whole number: one level is read
    vec3 albedo;            // linear; times the albedo map where there is one
    float roughness;
    float heightBound;      // largest |h|, for --show height
    mat4 worldToShadow;
    float hasShadows;       // 1 or 0
    float shadowBias;       // cage units along the normal
    vec3 crackShift;        // see emit.glsl; 0 for pictures
    float shadowSoftness;   // radius of the filter, as a fraction of the shadow map
};

// What layers.comp leaves of a pixel, floats in this order: distance along the view (1e10 where nothing is seen), unit normal,
// face of the cage (-1: none), texture coordinates, height, motion in pixels (x right, y down) since the frame before.
RELIEF_CONSTANT uint kLayerDepth = 0u;
RELIEF_CONSTANT uint kLayerNormal = 1u;
RELIEF_CONSTANT uint kLayerFace = 4u;
RELIEF_CONSTANT uint kLayerTexCoords = 5u;
RELIEF_CONSTANT uint kLayerHeight = 7u;
RELIEF_CONSTANT uint kLayerMotion = 8u;
RELIEF_CONSTANT uint kLayerChannels = 10u;

#ifdef __cplusplus
static_assert(offsetof(Scene, firstFace) == 72 && offsetof(Scene, worldToClip) == 72 + 32 + 12 + 44 + 72);
} // namespace relief
#endif
#endif
