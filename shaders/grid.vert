#version 460
#extension GL_GOOGLE_include_directive : require
#include "displaced.glsl"
#include "emit.glsl"

// A face drawn as a regular grid of passNumber segments a side, an instance a face. Samples on a side move to the nearest
// sample of the edge's own rate, which is never larger: both faces pass through exactly the same points.
uint snap(uint k, uint from, uint to) { return (2u * k * to + from) / (2u * from); }

void main() {
    uint face = texelFetch(drawFaceTexels, gl_InstanceIndex).x;
    uint n = passNumber;
    uint i = uint(gl_VertexIndex) % (n + 1u), j = uint(gl_VertexIndex) / (n + 1u);
    vec2 uv = vec2(i, j) / float(n);

    uint side = 4u, k = 0u;
    if (j == 0u) { side = 0u; k = i; }
#ifdef RELIEF_TRIANGLES
    else if (i + j == n) { side = 1u; k = j; }
    else if (i == 0u) { side = 2u; k = n - j; }
#else
    else if (i == n) { side = 1u; k = j; }
    else if (j == n) { side = 2u; k = n - i; }
    else if (i == 0u) { side = 3u; k = n - j; }
#endif
    Place place = insidePlace(face, uv);
    if (side < 4u) {
        uint entry = fetchFace(face).sides[side];
        uint rate = sideRate(entry);
        place = sidePlace(entry, snap(k, n, rate), rate);
    }
    emitVertex(face, uv, place, n);
}
