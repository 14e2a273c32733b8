// A face drawn as a regular grid of push.columns x push.rows segments, one instance per face. Samples on a side move to the
// nearest sample of the edge's own rate, which is never larger: both faces pass through exactly the same points.
#include "displaced.glsl"
#include "emit.glsl"

layout(push_constant, scalar) uniform PushBlock { GridPush push; };

uint snap(uint k, uint from, uint to) { return (2u * k * to + from) / (2u * from); }

// Sample (i,j) of the grid.
vec2 facePoint(uint face, uint i, uint j) {
    uint n = push.columns, m = push.rows;
    if (inputs.rates.isFractional == 0u) return vec2(i, j) / vec2(n, m);
    Face record = fetchFace(face);
    float rates[kSideCount];
    for (uint side = 0u; side < kSideCount; ++side) rates[side] = sideRate(record.sides[side]).rate;
    return fractionalPoint(i, j, uvec2(n, m), rates);
}

void main() {
    uint face = drawFace(gl_InstanceIndex);
    uint n = push.columns, m = push.rows;
    uint i = uint(gl_VertexIndex) % (n + 1u), j = uint(gl_VertexIndex) / (n + 1u);
    vec2 uv = facePoint(face, i, j);

    uint side = 4u, k = 0u, count = n;
    if (j == 0u) { side = 0u; k = i; }
#ifdef RELIEF_TRIANGLES
    else if (i + j == n) { side = 1u; k = j; }
    else if (i == 0u) { side = 2u; k = n - j; }
#else
    else if (i == n) { side = 1u; k = j; count = m; }
    else if (j == m) { side = 2u; k = n - i; }
    else if (i == 0u) { side = 3u; k = m - j; count = m; }
#endif
    SampleLocation location = insideLocation(face, uv);
    if (side < 4u) {
        uint entry = fetchFace(face).sides[side];
        SideRate rate = sideRate(entry);
        uint sample_ = snap(k, count, rate.segments);
        location = sideLocation(entry, sample_, rate);
        if (kPass == kPassLayers) uv = sidePoint(side, sampleAlongSide(entry, sample_, rate));
    }
    vec4 captured = emitVertex(face, uv, location, max(n, m));
#ifdef RELIEF_CAPTURES_STORED
    uint slot = uint(gl_InstanceIndex) * (n + 1u) * (m + 1u) + uint(gl_VertexIndex);
    inputs.targets.captured.at[push.firstCaptured + slot] = captured;
    gl_PointSize = 1.0; // captured as points
#endif
}
