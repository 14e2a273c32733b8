// Where samples are evaluated, and how many an edge has.
#ifndef RELIEF_LOCATIONS_GLSL
#define RELIEF_LOCATIONS_GLSL

#include "inputs.glsl"
#include "shared/rates.h"

#ifdef RELIEF_TRIANGLES
const uint kSideCount = 3u;
#else
const uint kSideCount = 4u;
#endif

// Where a sample is evaluated. Inside a face that is the face itself; on an edge or corner it is the owner, whatever
// face is being drawn, so that all faces there arrive at the same bits.
struct SampleLocation {
    Incidence owner;
    uint firstIncidence;
    uint incidenceCount;
    float t;         // along the owner edge
    bool isInside;
    vec2 uv;         // isInside: the face's own (u,v)
    uint flags;      // kOn...
    float level;     // of the height map: continuous over the surface, the corners' own along edges and inside faces
};

float cornerLevel(uint corner) { return kHasMips ? levelsAt(corner).x : 0.0; }

// Corners of a quad are in the order of its sides; of a triangle three are used.
float faceLevel(uint face, vec2 uv) {
    if (!kHasMips) return 0.0;
    vec4 c = levelsAt(inputs.rates.firstFaceLevel + face);
#ifdef RELIEF_TRIANGLES
    return (1.0 - uv.x - uv.y) * c.x + uv.x * c.y + uv.y * c.z;
#else
    return mix(mix(c.x, c.y, uv.x), mix(c.w, c.z, uv.x), uv.y);
#endif
}

// sampleParameter for a coordinate x = k/n that needs no exactness.
float spaced(float x, float n, float rate) {
    float t = min(min(x, 1.0 - x) * n / rate, 0.5);
    return x <= 0.5 ? t : 1.0 - t;
}

// Sample (i,j) of a lattice of n segments where rates need not be whole (--spacing fractional); `rates` are those of the sides.
vec2 fractionalPoint(uint i, uint j, uvec2 n, float rates[kSideCount]) {
#ifdef RELIEF_TRIANGLES
    float rate = max(rates[0], max(rates[1], rates[2]));
    vec3 c = vec3(n.x - i - j, i, j) / float(n.x);
    c = vec3(spaced(c.x, float(n.x), rate), spaced(c.y, float(n.x), rate), spaced(c.z, float(n.x), rate));
    return c.yz / (c.x + c.y + c.z);
#else
    return vec2(sampleParameter(i, n.x, max(rates[0], rates[2])), sampleParameter(j, n.y, max(rates[1], rates[3])));
#endif
}

vec2 sidePoint(uint side, float x) {
#ifdef RELIEF_TRIANGLES
    return side == 0u ? vec2(x, 0.0) : side == 1u ? vec2(1.0 - x, x) : vec2(0.0, 1.0 - x);
#else
    return side == 0u ? vec2(x, 0.0) : side == 1u ? vec2(1.0, x) : side == 2u ? vec2(1.0 - x, 1.0) : vec2(0.0, 1.0 - x);
#endif
}

vec2 incidencePoint(Incidence incidence, float t) {
    return sidePoint(incidence.side, incidence.start + t * (incidence.end - incidence.start));
}

SampleLocation insideLocation(uint face, vec2 uv) {
    return SampleLocation(Incidence(face, 0u, 0.0, 0.0), 0u, 0u, 0.0, true, uv, 0u, faceLevel(face, uv));
}

SampleLocation cornerLocation(uint corner) {
    Corner c = fetchCorner(corner);
    return SampleLocation(c.owner, c.firstIncidence, c.incidenceCount, 0.0, false, vec2(0), c.flags, cornerLevel(corner));
}

// Sample k of n along an edge of that rate, in the edge's own direction.
SampleLocation edgeLocation(uint edge, uint k, uint n, float rate) {
    Edge e = fetchEdge(edge);
    if (k == 0u || k == n) return cornerLocation(e.corners[k == 0u ? 0 : 1]);
    float t = sampleParameter(k, n, rate);
    precise float level = mix(cornerLevel(e.corners[0]), cornerLevel(e.corners[1]), t);
    return SampleLocation(e.owner, e.firstIncidence, e.incidenceCount, t, false, vec2(0), e.flags, level);
}

// A side has as many segments as its edge, or as the two halves of a split one.
struct SideRate {
    uint segments;
    float rate;
};

SideRate sideRate(uint sideEntry) {
    float rate = edgeRate(sideEntry & kSideEdgeMask);
    uint halves = (sideEntry & kSideSplit) != 0u ? 2u : 1u;
    return SideRate(halves * segmentsOf(rate, inputs.rates.isFractional), float(halves) * rate);
}

// How far along its side sample k lies, 0 to 1.
float sampleAlongSide(uint sideEntry, uint k, SideRate side) {
    if (inputs.rates.isFractional == 0u) return float(k) / float(side.segments);
    if ((sideEntry & kSideSplit) == 0u) return sampleParameter(k, side.segments, side.rate);
    uint n = side.segments / 2u, half_ = k > n ? 1u : 0u;
    return 0.5 * (float(half_) + sampleParameter(k - half_ * n, n, 0.5 * side.rate));
}

// Sample k along a side, in the side's direction.
SampleLocation sideLocation(uint sideEntry, uint k, SideRate side) {
    uint edge = sideEntry & kSideEdgeMask;
    uint n = side.segments;
    float rate = side.rate;
    if ((sideEntry & kSideReversed) != 0u) k = n - k;
    if ((sideEntry & kSideSplit) != 0u) {
        n /= 2u;
        rate *= 0.5;
        if (k > n) {
            k -= n;
            edge += 1u;
        }
    }
    return edgeLocation(edge, k, n, rate);
}
#endif
