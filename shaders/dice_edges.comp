#version 460
#extension GL_GOOGLE_include_directive : require
#include "dice.glsl"
#include "displaced.glsl"
#include "dice_store.glsl"

// The samples on corners and edges, each evaluated at its owner: those of a list, one invocation per vertex; or, in the common
// case, those of pieces of edges in bicubic patches, one workgroup per piece.
layout(local_size_x_id = kIdGroupSize) in;

// The run that holds a vertex: corners come first, each a run of one; the others by halving.
uint runOf(uint vertex) {
    if (vertex < inputs.model.cornerRunCount) return vertex;
    uint low = inputs.model.cornerRunCount, high = inputs.model.runCount;
    while (high - low > 1u) {
        uint middle = (low + high) / 2u;
        if (firstVertexOf(middle) <= vertex) low = middle;
        else high = middle;
    }
    return low;
}

#if !defined(RELIEF_TRIANGLES) && !defined(RELIEF_STORAGE_TABLES)

void dicePiece(EdgePiece piece) {
    uint edge = fetchRun(piece.run).element, firstVertex = firstVertexOf(piece.run);
    Edge record = fetchEdge(edge);
    float rate = edgeRate(edge), low = cornerLevel(record.corners[0]), high = cornerLevel(record.corners[1]);
    uint n = segmentsOf(rate, inputs.rates.isFractional);
    for (uint k = piece.firstK + gl_LocalInvocationID.x; k < piece.endK; k += gl_WorkGroupSize.x) {
        float t = sampleParameter(k, n, rate);
        vec2 uv = incidencePoint(record.owner, t);
        Leaf leaf = findLeaf(record.owner.face, uv);
        PatchPoints patchPoints = fetchPatch(leaf.patchIndex, inputs.model.pointsNow);
        storeVertex(firstVertex + k - 1u, displacedInBicubic(patchPoints, leaf, uv, mix(low, high, t)));
    }
}
#endif

void main() {
#if !defined(RELIEF_TRIANGLES) && !defined(RELIEF_STORAGE_TABLES)
    if (kIsCommon) {
        uvec4 a = tileTexel(push.first + gl_WorkGroupID.x);
        dicePiece(EdgePiece(a.x, a.y, a.z, a.w));
        return;
    }
#endif
    uint i = (push.first + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (i >= push.count) return;
    uint vertex = tileTexel(push.list + (i >> 2))[i & 3u];
    uint index = runOf(vertex);
    VertexRun run = fetchRun(index);
    SampleLocation location;
    if (run.isCorner != 0u) {
        location = cornerLocation(run.element);
    } else {
        float rate = edgeRate(run.element);
        location = edgeLocation(run.element, vertex - firstVertexOf(index) + 1u,
                                segmentsOf(rate, inputs.rates.isFractional), rate);
    }
    DisplacedSample s = displaced(run.incidence.face, incidencePoint(run.incidence, location.t), location);
    storeVertex(vertex, s);
}
