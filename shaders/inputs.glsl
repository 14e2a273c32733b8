// What every stage is given, and the tables that several stages read. Included before anything else.
#ifndef RELIEF_INPUTS_GLSL
#define RELIEF_INPUTS_GLSL

#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require

#include "points.glsl"
#include "tables.glsl"
#include "shared/bindings.h"
#include "shared/constants.h"
#include "shared/inputs.h"
#include "shared/push.h"

layout(set = 0, binding = kBindInputs, scalar) uniform InputBlock { PassInputs inputs; };

layout(constant_id = kIdHasMips) const bool kHasMips = false;
layout(constant_id = kIdStretches) const bool kStretches = false; // heights grow with the surface since the rest pose
#ifdef RELIEF_HEIGHT_FUNCTION
layout(constant_id = kIdReadsRest) const bool kReadsRest = false; // heights depend on the rest pose, and it is another
#else
#define kReadsRest kStretches
#endif
layout(constant_id = kIdVectorSpace) const uint kVectorSpace = kVectorNone;
layout(constant_id = kIdMapAddressing) const uint kMapAddressing = kMapOfTexture; // of shared/maps.h
layout(constant_id = kIdHasWideIndices) const bool kHasWideIndices = false;
layout(constant_id = kIdHasTexGradients) const bool kHasTexGradients = false;
layout(constant_id = kIdPass) const uint kPass = kPassSurface;

RELIEF_TABLE(kBindRecords, uvec4, recordAt)
RELIEF_TABLE(kBindTree, uint, treeEntry)
RELIEF_TABLE(kBindPoints, vec4, pointAt)
RELIEF_TABLE(kBindTexPoints, vec2, texPointAt)
RELIEF_TABLE(kBindEdgeRates, float, edgeRate)
RELIEF_TABLE(kBindDrawFaces, uint, drawFace)
RELIEF_TABLE(kBindLevels, vec4, levelsAt)

uvec4 recordTexel(uint first, uint texels, uint index, uint texel) { return recordAt(first + texels * index + texel); }

// --- records: the bits are those of shared/records.h ------------------------------------------------------------------

uint faceRoot(uint face) { return recordTexel(inputs.model.firstFace, kFaceTexels, face, 0u).x; }
uint cageFaceOf(uint face) { return recordTexel(inputs.model.firstFace, kFaceTexels, face, 1u).y; }

Face fetchFace(uint face) {
    uvec4 a = recordTexel(inputs.model.firstFace, kFaceTexels, face, 0u);
    uvec4 b = recordTexel(inputs.model.firstFace, kFaceTexels, face, 1u);
    return Face(a.x, uint[4](a.y, a.z, a.w, b.x), b.y);
}

Incidence unpackIncidence(uvec4 a) { return Incidence(a.x, a.y & 255u, uintBitsToFloat(a.z), uintBitsToFloat(a.w)); }
Incidence fetchIncidence(uint i) { return unpackIncidence(recordTexel(inputs.model.firstIncidence, kIncidenceTexels, i, 0u)); }

// The weight of an incidence at a corner in the shared direction there: faces of one smooth sector share one vote.
float sectorShare(uint incidence) {
    return 1.0 / float(recordTexel(inputs.model.firstIncidence, kIncidenceTexels, incidence, 0u).y >> 8);
}

Edge fetchEdge(uint i) {
    uvec4 a = recordTexel(inputs.model.firstEdge, kEdgeTexels, i, 0u);
    uint span = a.y >> 30, partner = a.z >> 30;
    Incidence owner = Incidence(a.x & 0xfffffffu, a.x >> 28 & 3u, span == kSpanSecondHalf ? 0.5 : 0.0,
                                span == kSpanFirstHalf ? 0.5 : 1.0);
    uint incidences = a.w == kNoIncidence ? 0u : recordTexel(inputs.model.firstIncidence, kIncidenceTexels, a.w, 0u).y >> 8;
    uint other = partner == kPartnerNext ? i + 1u : partner == kPartnerBefore ? i - 1u : i;
    return Edge(owner, uint[2](a.y & 0x3fffffffu, a.z & 0x3fffffffu), a.w, incidences, other, a.x >> 30);
}

Corner fetchCorner(uint i) {
    uvec4 a = recordTexel(inputs.model.firstCorner, kCornerTexels, i, 0u);
    float x = 0.5 * float(a.y & 1u);
    return Corner(Incidence(a.x & 0xfffffffu, a.x >> 28 & 3u, x, x), a.z, a.y >> 1, a.x >> 30);
}

// The control points of a patch, or of the texture coordinates on it, by their indices.
struct ControlPoints {
    uint first;    // texel where the indices begin
    uint base;     // that the indices are counted from
    uint type;     // kPatch...
    uint boundary; // Far::PatchParam's mask of boundary sides
    uint array;    // texel of kBindPoints where the points of a pose begin, or kTexturePoints: they are in kBindTexPoints
};

const uint kTexturePoints = 0xffffffffu;

struct PatchPoints {
    ControlPoints surface, texture;
    uint straightCorners; // as in Patch
};

// A patch in the pose whose points begin at `pose`, one of inputs.model.points...
PatchPoints fetchPatch(uint i, uint pose) {
    uvec4 a = recordTexel(inputs.model.firstPatch, kPatchTexels, i, 0u);
    return PatchPoints(ControlPoints(a.x, a.y, a.w & 15u, a.w >> 8 & 31u, pose),
                       ControlPoints(a.x + (a.w >> 18 & 63u), a.z, a.w >> 4 & 15u, a.w >> 13 & 31u, kTexturePoints), a.w >> 24);
}

ControlPoints inPose(ControlPoints points, uint pose) {
    points.array = pose;
    return points;
}

// Indices of control points 4 row .. 4 row + 3.
uvec4 pointRow(ControlPoints points, uint row) {
    if (kHasWideIndices) return recordTexel(points.first, 1u, row, 0u);
    uvec4 eight = recordTexel(points.first, 1u, row >> 1, 0u);
    uvec2 four = (row & 1u) == 0u ? eight.xy : eight.zw;
    return points.base + uvec4(four.x & 0xffffu, four.x >> 16, four.y & 0xffffu, four.y >> 16);
}

uint pointIndex(ControlPoints points, uint k) { return pointRow(points, k >> 2)[k & 3u]; }

vec4 surfacePointAt(ControlPoints points, uint i) { return pointAt(points.array + i); }

// Point i, as an offset from another one.
vec3 offsetAt(ControlPoints points, uint i, vec4 origin) { return pointDifference(surfacePointAt(points, i), origin); }

#endif
