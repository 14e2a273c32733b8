// Specialization constants of all shaders: their ids, and the values of those that are no numbers or booleans. Both
// sides name a constant by its id here; a pipeline hands over one value per id.
#ifndef RELIEF_SHARED_CONSTANTS_H
#define RELIEF_SHARED_CONSTANTS_H

#include "shared/types.h"

#ifdef __cplusplus
namespace relief {
#endif

RELIEF_CONSTANT uint kIdGenericBasis = 0u;   // OpenSubdiv's own basis for all patches
RELIEF_CONSTANT uint kIdHasTexCoords = 1u;   // the surface or mesh has texture coordinates
RELIEF_CONSTANT uint kIdHasHeight = 2u;      // there is a height map
RELIEF_CONSTANT uint kIdNormal = 3u;         // kNormal...
RELIEF_CONSTANT uint kIdWantsTexCoords = 4u; // the pass shades with texture coordinates
RELIEF_CONSTANT uint kIdShow = 5u;           // kShow...
RELIEF_CONSTANT uint kIdHasAlbedoMap = 6u;
RELIEF_CONSTANT uint kIdGroupSize = 7u;       // invocations per workgroup
RELIEF_CONSTANT uint kIdHasMips = 8u;         // heights are read from mip levels
RELIEF_CONSTANT uint kIdIsCommon = 9u;        // dicing: the common case alone, see dice.glsl
RELIEF_CONSTANT uint kIdStretches = 10u;      // heights grow with the surface since the rest pose
RELIEF_CONSTANT uint kIdHasMotion = 11u;      // layers: the surface was in another pose in the frame before
RELIEF_CONSTANT uint kIdMapFormat = 12u;      // kMap... of shared/maps.h
RELIEF_CONSTANT uint kIdHasWideIndices = 13u; // control points have 32-bit indices, see shared/records.h
RELIEF_CONSTANT uint kIdHasStraightCorners = 14u;
RELIEF_CONSTANT uint kIdPass = 15u;            // kPass...
RELIEF_CONSTANT uint kIdIsMesh = 16u;          // layers, errors: the model is a triangle mesh
RELIEF_CONSTANT uint kIdIsPlaced = 17u;        // the model is turned or scaled in the world
RELIEF_CONSTANT uint kIdHasInstances = 18u;    // samples carry the number of their instance
RELIEF_CONSTANT uint kIdEntries = 19u;         // posing: entries per stencil block
RELIEF_CONSTANT uint kIdHasTexGradients = 20u; // vertices carry tangents and slopes, see varyings.glsl
RELIEF_CONSTANT uint kIdHasSlopes = 21u;       // normals are bent by the slopes of heights, per fragment
RELIEF_CONSTANT uint kIdNormalMap = 22u;       // kNormalMap...
RELIEF_CONSTANT uint kIdHeightFunction = 23u;  // number of a height function, for keys of pipelines
RELIEF_CONSTANT uint kIdReadsRest = 24u; // heights depend on the rest pose, and it is another than that of the frame
RELIEF_CONSTANT uint kIdReadsSampleBuffers = 25u; // light: samples are those of raster_*.comp
RELIEF_CONSTANT uint kIdWritesIds = 26u;          // raster: samples are numbers of triangles, for raster_resolve.comp
RELIEF_CONSTANT uint kIdHasSampleColors = 27u;    // light: samples in buffers have colours of their own
RELIEF_CONSTANT uint kIdReadsShadowCodes = 28u;   // light: the shadow map is that of raster_*.comp
RELIEF_CONSTANT uint kIdShading = 29u;            // kShading...
RELIEF_CONSTANT uint kIdAddsLight = 30u;          // light: adds one more light to the picture, which has all else
RELIEF_CONSTANT uint kIdHasOcclusion = 31u;       // light: occlusion.comp has run
RELIEF_CONSTANT uint kIdMapAddressing = 32u;      // kMapOf... of shared/maps.h
RELIEF_CONSTANT uint kIdReadsNodes = 33u;         // every sample lies on a node of a map per face, see heights.glsl
RELIEF_CONSTANT uint kIdHasPictureTiles = 34u;    // pictures cover more than the unit square, see lookup.glsl
RELIEF_CONSTANT uint kIdVectorSpace = 35u;        // kVector...
RELIEF_CONSTANT uint kIdPatchTypes = 36u;         // bit t: some patches are of type t (kPatch...), or their texture's
RELIEF_CONSTANT uint kIdIsFine = 37u;             // posing: sums of stencils are finer than floats, see shared/pose.h
RELIEF_CONSTANT uint kIdCount = 38u;

// What a picture shows (--show).
RELIEF_CONSTANT uint kShowShaded = 0u;
RELIEF_CONSTANT uint kShowNormal = 1u;
RELIEF_CONSTANT uint kShowHeight = 2u;
RELIEF_CONSTANT uint kShowRate = 3u;
RELIEF_CONSTANT uint kShowFaces = 4u;
RELIEF_CONSTANT uint kShowWireframe = 5u;
RELIEF_CONSTANT uint kShowTexCoords = 6u;
RELIEF_CONSTANT uint kShowError = 7u;

// How surfaces shade (--shading); the physical material has a second form.
RELIEF_CONSTANT uint kShadingPhysical = 0u;    // a dielectric
RELIEF_CONSTANT uint kShadingConserving = 1u;  // dielectrics and metals that conserve energy, mirrors
RELIEF_CONSTANT uint kShadingPhong = 2u;       // Hart, eq. 16.20
RELIEF_CONSTANT uint kShadingTable = 3u;       // the same from a table, looked up per pixel
RELIEF_CONSTANT uint kShadingVertexTable = 4u; // the same, with coordinates in the table that are those of vertices
RELIEF_CONSTANT uint kShadingMatcap = 5u;      // a picture of a ball, looked up by the normal
RELIEF_CONSTANT uint kShadingWater = 6u;       // clear, over a floor

RELIEF_CONSTANT int kShadingTableSide = 256; // texels

// What a draw is for.
RELIEF_CONSTANT uint kPassSurface = 0u; // the G-buffer of a picture
RELIEF_CONSTANT uint kPassShadow = 1u;  // depth from the key light
RELIEF_CONSTANT uint kPassLines = 2u;   // the lines of a wireframe, over the surface
RELIEF_CONSTANT uint kPassCracks = 3u;  // front faces count up, back faces down: closed surfaces sum to 0
RELIEF_CONSTANT uint kPassLayers = 4u;  // fragments know their face and (u,v): what layers.comp reads, errors

// Normals of the displaced surface (--normal).
RELIEF_CONSTANT uint kNormalLimit = 0u;
RELIEF_CONSTANT uint kNormalFirstOrder = 1u;
RELIEF_CONSTANT uint kNormalFull = 2u;

// What the texels of a normal map are relative to (--normal-space).
RELIEF_CONSTANT uint kNormalMapNone = 0u;
RELIEF_CONSTANT uint kNormalMapTangent = 1u;
RELIEF_CONSTANT uint kNormalMapObject = 2u;

// What the components of a vector map are along; kVectorNone: heights move the surface along its normal.
RELIEF_CONSTANT uint kVectorNone = 0u;
RELIEF_CONSTANT uint kVectorTangent = 1u;
RELIEF_CONSTANT uint kVectorObject = 2u;

// raster_*.comp: the lists of triangles for raster_large.comp and raster_thin.comp, in one buffer: one from the front,
// the other from the back. Each begins with the three words of its dispatch, its workgroups.
RELIEF_CONSTANT uint kLargeList = 0u;          // word: where what is known of a list begins
RELIEF_CONSTANT uint kThinList = 5u;           // word
RELIEF_CONSTANT uint kListCount = 3u;          // word from there: triangles in the list
RELIEF_CONSTANT uint kListSeen = 4u;           // word from there: 1 where a pass of the picture has listed any
RELIEF_CONSTANT uint kListFirst = 10u;         // word: the first triangle
RELIEF_CONSTANT uint kMostListGroups = 65535u; // that a dispatch may have on every device
RELIEF_CONSTANT uint kThinGroup = 64u;         // invocations of raster_thin.comp, one per triangle
RELIEF_CONSTANT int kLargeTile = 256;          // pixels each way that one of its workgroups fills

// How much nearer lines of triangles are drawn than they lie (--show wireframe): this many units of the last
// place of depths, and this many times the change of depth per pixel.
RELIEF_CONSTANT float kLineBiasUnits = 64.0f;
RELIEF_CONSTANT float kLineBiasSlope = 2.0f;

RELIEF_CONSTANT float kShadowCodes = 65535.0f; // depths of a shadow map are stored as whole numbers up to this

#ifdef __cplusplus
} // namespace relief
#endif
#endif
