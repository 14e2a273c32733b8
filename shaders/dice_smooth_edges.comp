#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "dice.glsl"

// The samples along smooth edges whose owner is one bicubic patch, one workgroup per run: what dice_edges.comp would make
// of them.
layout(local_size_x_id = kIdGroupSize) in;

#ifdef RELIEF_TRIANGLES
void main() {} // all runs are dice_edges.comp's
#else
#include "dice_tile.glsl"
#include "dice_store.glsl"

void main() {
    uint index = push.first + gl_WorkGroupID.x, edge = fetchRun(index).element;
    Edge record = fetchEdge(edge);
    uint patchIndex = faceRoot(record.owner.face) & ~kLeafBit;
    PatchPoints patchPoints = fetchPatch(patchIndex, inputs.model.pointsNow);
    patchPoints.surface.type = patchPoints.texture.type = kPatchRegular;
    loadTile(patchPoints);
    float rate = edgeRate(edge);
    uint n = segmentsOf(rate, inputs.rates.isFractional), firstVertex = firstVertexOf(index);
    float low = cornerLevel(record.corners[0]), high = cornerLevel(record.corners[1]);
    for (uint k = 1u + gl_LocalInvocationID.x; k < n; k += gl_WorkGroupSize.x) {
        float t = sampleParameter(k, n, rate);
        vec2 uv = incidencePoint(record.owner, t);
        DisplacedSample s = displacedInBicubic(patchPoints, Leaf(patchIndex, uv, 1.0, record.owner.face), uv, mix(low, high, t));
        storeVertex(firstVertex + k - 1u, s);
    }
}
#endif
