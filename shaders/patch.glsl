// The evaluation stage of patches: the tessellator says which sample of a face this is, never where it lies.
#include "displaced.glsl"
#include "emit.glsl"

#ifdef RELIEF_TRIANGLES
layout(triangles, equal_spacing, cw) in;
#else
layout(quads, equal_spacing, cw) in;
#endif

layout(location = 0) patch in uint face;
layout(location = 1) patch in vec2 insideRates;

const uint kInside = 4u;

// The side a vertex lies on, and how far along.
uint findSide(out float x) {
    vec3 c = gl_TessCoord;
    x = 0.0;
#ifdef RELIEF_TRIANGLES
    if (c.z == 0.0) { x = c.y; return 0u; }
    if (c.x == 0.0) { x = c.z; return 1u; }
    if (c.y == 0.0) { x = c.x; return 2u; }
#else
    if (c.y == 0.0) { x = c.x; return 0u; }
    if (c.x == 1.0) { x = c.y; return 1u; }
    if (c.y == 1.0) { x = 1.0 - c.x; return 2u; }
    if (c.x == 0.0) { x = 1.0 - c.y; return 3u; }
#endif
    return kInside;
}

// (u,v) of the tessellator's coordinates.
vec2 facePoint() {
    vec3 c = gl_TessCoord;
#ifdef RELIEF_TRIANGLES
    if (inputs.rates.isFractional != 0u) {
        float n = gl_TessLevelInner[0];
        c = vec3(spaced(c.x, n, insideRates.x), spaced(c.y, n, insideRates.x), spaced(c.z, n, insideRates.x));
        c /= c.x + c.y + c.z;
    }
    return c.yz;
#else
    if (inputs.rates.isFractional != 0u)
        return vec2(spaced(c.x, gl_TessLevelInner[0], insideRates.x), spaced(c.y, gl_TessLevelInner[1], insideRates.y));
    return c.xy;
#endif
}

void main() {
    vec2 uv = facePoint();
    float x;
    uint side = findSide(x);
    SampleLocation location = insideLocation(face, uv);
    if (side != kInside) {
        uint entry = fetchFace(face).sides[side];
        SideRate rate = sideRate(entry);
        uint sample_ = uint(round(x * float(rate.segments)));
        location = sideLocation(entry, sample_, rate);
        if (kPass == kPassLayers) uv = sidePoint(side, sampleAlongSide(entry, sample_, rate));
    }
    emitVertex(face, uv, location, uint(ceil(max(insideRates.x, insideRates.y))));
}
