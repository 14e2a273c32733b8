#version 460
#extension GL_GOOGLE_include_directive : require
#include "dice.glsl"
#include "displaced.glsl"
#include "dice_store.glsl"

// The samples on corners and edges, one invocation per vertex, each evaluated at its owner.
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

void main() {
    uint vertex = (push.first + gl_WorkGroupID.x) * gl_WorkGroupSize.x + gl_LocalInvocationID.x;
    if (vertex >= push.count) return;
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
