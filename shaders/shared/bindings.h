// Set 0 of every pass but those that pose a cage. Tables are read through texel buffers, or through storage buffers
// where the device reads too few texels from one (shaders/tables.glsl). Texel fetches are gathered for all lanes at
// once on CPU drivers, where a load through an address is a loop over the lanes (5 to 10 times slower), and go through
// the texture caches of GPUs.
#ifndef RELIEF_SHARED_BINDINGS_H
#define RELIEF_SHARED_BINDINGS_H

#include "shared/types.h"

#ifdef __cplusplus
namespace relief {
#endif

RELIEF_CONSTANT uint kBindInputs = 0u;         // uniform buffer: PassInputs
RELIEF_CONSTANT uint kBindHeight = 1u;         // table: pairs of words of the height maps, see shared/maps.h
RELIEF_CONSTANT uint kBindAlbedo = 2u;         // sampled image
RELIEF_CONSTANT uint kBindEnvironment = 3u;    // sampled image, equirectangular
RELIEF_CONSTANT uint kBindShadow = 4u;         // sampled image, reversed depth from the key light
RELIEF_CONSTANT uint kBindRecords = 5u;        // table: the surface's records, see shared/records.h
RELIEF_CONSTANT uint kBindTree = 6u;           // table: patch trees of faces
RELIEF_CONSTANT uint kBindPoints = 7u;         // table: control points, one pose after another
RELIEF_CONSTANT uint kBindTexPoints = 8u;      // table: control points of texture coordinates
RELIEF_CONSTANT uint kBindEdgeRates = 9u;      // table: segments per edge; written per frame
RELIEF_CONSTANT uint kBindDrawFaces = 10u;     // table: faces to draw in order; written per frame
RELIEF_CONSTANT uint kBindMesh = 11u;          // table: vertices of a mesh: position with height, and normal, in turn
RELIEF_CONSTANT uint kBindMeshTexCoords = 12u; // table: (s,t) per vertex
RELIEF_CONSTANT uint kBindDiceTable = 13u;     // table: runs of vertices, and those around faces, see shared/dice.h
RELIEF_CONSTANT uint kBindDiceTiles = 14u;     // table; written per frame
RELIEF_CONSTANT uint kBindDiceFirsts = 15u;    // table: first vertex of each run; written per frame
RELIEF_CONSTANT uint kBindLevels = 16u;      // table: mip levels of the height map, one per corner, then four per face
RELIEF_CONSTANT uint kBindEdgeHeights = 17u; // table: how far heights range along each edge, cage units
RELIEF_CONSTANT uint kBindDepths = 18u;      // sampled images: the samples of a picture
RELIEF_CONSTANT uint kBindNormals = 19u;
RELIEF_CONSTANT uint kBindColors = 20u;
RELIEF_CONSTANT uint kBindInstances = 21u;
RELIEF_CONSTANT uint kBindSlopes = 22u;           // sampled image: (h_s, h_t) / ModelTables::slopeUnit
RELIEF_CONSTANT uint kBindNormalMap = 23u;        // sampled image: unit normals, y along t
RELIEF_CONSTANT uint kBindMeshTexGradients = 24u; // table: kGradientTexels or more per vertex of a mesh
RELIEF_CONSTANT uint kBindMeshIndices = 25u;      // table: three per triangle of a mesh
RELIEF_CONSTANT uint kBindScreen = 26u;           // table: vertices of a mesh on the screen, see shaders/raster.glsl
RELIEF_CONSTANT uint kBindSamples = 27u;      // table: two samples of a picture per element: normal and depth of each
RELIEF_CONSTANT uint kBindShadowCodes = 28u;  // table: depths from the key light, kShadowCodes
RELIEF_CONSTANT uint kBindSampleColors = 29u; // table: two samples per element: normal and colour of each
RELIEF_CONSTANT uint kBindSampleInstances = 30u; // table: four numbers of instances per pixel
RELIEF_CONSTANT uint kBindFaceTriangles = 31u;   // table: first triangle and rate of each face of a diced mesh
RELIEF_CONSTANT uint kBindCount = 32u;

// light.comp: sampled image, the table of kShadingTable or the ball of kShadingMatcap. It has no color map.
RELIEF_CONSTANT uint kBindShading = kBindAlbedo;

#ifdef __cplusplus
} // namespace relief
#endif
#endif
