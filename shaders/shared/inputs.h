// What every pass is given in a uniform buffer: PassInputs. Positions are those of a model in its own space, except in
// light.comp, which works in the world; normals of samples and directions of light are in the world everywhere.
#ifndef RELIEF_SHARED_INPUTS_H
#define RELIEF_SHARED_INPUTS_H

#include "shared/maps.h"
#include "shared/records.h"
#include "shared/sample.h"

#ifdef __cplusplus
namespace relief::pass {
#endif

// Where the tables of a model begin.
struct ModelTables {
    uint firstFace; // texels of kBindRecords
    uint firstPatch;
    uint firstEdge;
    uint firstCorner;
    uint firstIncidence;
    uint edgeCount;

    uint firstFaceRuns;  // texel of kBindDiceTable; runs are at 0
    uint cornerRunCount; // runs of one vertex: the first ones
    uint runCount;

    uint pointsNow; // texels of kBindPoints: this frame's pose, that of the frame before, and the rest pose
    uint pointsBefore;
    uint pointsRest;

    float heightBound;      // largest |h|, cage units; 0 without heights
    float slopeUnit;        // what the numbers of kBindSlopes are multiplied with: cage units per unit of s and t
    float heightTime;       // height functions: time of this frame, seconds
    float heightTimeBefore; // height functions: time of the frame that motion is measured from, seconds
    float heightUnit;       // height functions: cage units per unit of positions
    float heightStep;       // height functions: distance of differences to either side, in units of positions
    vec4 albedoTiles;       // what pictures cover, see lookup.glsl
    vec4 slopeTiles;
    vec4 normalTiles;
    MapRecord maps[kMostMaps];
};

// How many segments edges have.
struct Rates {
    float pixelsAtUnitDistance; // pixels = length * pixelsAtUnitDistance / distance
    float edgePixels;           // wanted length of a segment on screen
    float nearDistance;
    uint maxRate;
    uint isFractional;   // 1: rates need not be whole (--spacing fractional)
    uint firstFaceLevel; // texel of kBindLevels
};

struct View {
    mat4 toClip;        // from positions
    mat4 fromClip;      // to positions
    mat4 toClipBefore;  // of the frame that motion is measured from
    mat3 normalToWorld; // a rotation; kIsPlaced: it is not the identity
    vec3 eye;
    ivec2 pictureSize;
    vec3 crackShift; // kPassCracks: where vertices of odd parity move, see project.glsl
    uint instance;   // number of the instance that is drawn
};

struct Light {
    vec3 keyDirection; // towards the light, unit
    vec3 keyRadiance;
    vec3 irradiance[9];    // the environment's spherical harmonics, convolved with the cosine lobe
    mat4 toShadow;         // from positions to the clip space of the shadow map
    float hasShadows;      // 1 or 0
    float shadowBias;      // along the normal, world units
    float shadowSoftness;  // radius of the filter, as a fraction of the shadow map
    uint shadowSide;       // texels
    vec4 phong;            // k_a, k_d, k_s and the exponent of Hart, eq. 16.20
    float occlusionRadius; // world units
    float environmentTurn; // about Y, counter-clockwise seen from above, in whole turns
    vec3 floorColor;       // kShadingWater: linear albedo
    float floorHeight;     // world units, as those that follow: y of the floor
    float floorDepth;      // of the floor under level water
    float floorTile;       // side of light and dark tiles; 0: none
};

struct Material {
    vec3 albedo; // linear; times the albedo map where there is one
    float roughness;
    float environmentLevel; // of the environment map for this roughness; kShadingPhysical: a whole number, one level is
                            // read
    float metallic;         // kShadingConserving
};

#ifndef __cplusplus
RELIEF_ARRAY(Words, uint)
RELIEF_ARRAY(Floats, float)
RELIEF_ARRAY(WordPairs, uvec2)
RELIEF_ARRAY(WordQuads, uvec4)
RELIEF_ARRAY(Vectors, vec4)
RELIEF_ARRAY(Pairs, vec2)
RELIEF_ARRAY(Queries, SampleQuery)
RELIEF_ARRAY(Results, SampleResult)
RELIEF_ARRAY(Materials, Material)
#endif

// Arrays that are reached by their addresses: what passes write, and what compute passes read one element of at a time.
struct Targets {
    RELIEF_ADDRESS(WordPairs) picture;     // light.comp: four halves per pixel
    RELIEF_ADDRESS(Floats) edges;          // rates.comp: one float per edge; footprints.comp: kFootprintFloats
    RELIEF_ADDRESS(Queries) sampleQueries; // sample.comp
    RELIEF_ADDRESS(Results) sampleResults;
    RELIEF_ADDRESS(Vectors) captured;      // grid_capture.vert: position, 1 on a boundary
    RELIEF_ADDRESS(Vectors) dicedVertices; // as kBindMesh
    RELIEF_ADDRESS(Pairs) dicedTexCoords;
    RELIEF_ADDRESS(Vectors) dicedTexGradients; // as kBindMeshTexGradients
    RELIEF_ADDRESS(Words) dicedIndices;
    RELIEF_ADDRESS(Floats) layers;          // layers.comp: kLayerChannels floats per pixel
    RELIEF_ADDRESS(Materials) materials;    // light.comp with kHasInstances: one per instance
    RELIEF_ADDRESS(WordQuads) screen;       // as kBindScreen
    RELIEF_ADDRESS(WordPairs) samples;      // as kBindSamples
    RELIEF_ADDRESS(WordPairs) sampleColors; // as kBindSampleColors
    RELIEF_ADDRESS(Words) sampleInstances;  // as kBindSampleInstances
    RELIEF_ADDRESS(Words) shadow;           // as kBindShadowCodes
    RELIEF_ADDRESS(Words) crossings;        // kPassCracks: front faces less back faces per pixel
    RELIEF_ADDRESS(Words) listedTriangles;  // k...List
    RELIEF_ADDRESS(Floats) occlusion;       // occlusion.comp: the share of the environment that arrives, per pixel
};

struct PassInputs {
    ModelTables model;
    Rates rates;
    View view;
    Light light;
    Material material;
    Targets targets;
};

#ifdef __cplusplus
static_assert(sizeof(ModelTables) == 30 * 4 + kMostMaps * sizeof(MapRecord) && sizeof(Rates) == 24);
static_assert(sizeof(View) == 3 * 64 + 36 + 12 + 8 + 12 + 4 && sizeof(Light) == 11 * 12 + 64 + 16 + 24 + 24);
static_assert(sizeof(Material) == 24 && sizeof(Targets) == 19 * 8);
static_assert(sizeof(PassInputs) == offsetof(PassInputs, targets) + sizeof(Targets));
} // namespace relief::pass

namespace relief {
using pass::PassInputs;
#endif

// What footprints.comp writes per edge: its length in texels, the lowest and the highest (s,t) on it.
RELIEF_CONSTANT uint kFootprintFloats = 5u;

// What layers.comp writes per pixel, floats in this order: distance along the view (1e10 where nothing is seen), unit
// normal, face of the cage (-1: none), texture coordinates, height, motion in pixels (x right, y down) since the frame
// before.
RELIEF_CONSTANT uint kLayerDepth = 0u;
RELIEF_CONSTANT uint kLayerNormal = 1u;
RELIEF_CONSTANT uint kLayerFace = 4u;
RELIEF_CONSTANT uint kLayerTexCoords = 5u;
RELIEF_CONSTANT uint kLayerHeight = 7u;
RELIEF_CONSTANT uint kLayerMotion = 8u;
RELIEF_CONSTANT uint kLayerChannels = 10u;

#ifdef __cplusplus
} // namespace relief
#endif
#endif
