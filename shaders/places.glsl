// Where samples are evaluated, and how many an edge has.
#ifndef RELIEF_PLACES_GLSL
#define RELIEF_PLACES_GLSL

#include "scene.glsl"
#include "shared/rates.h"

#ifdef RELIEF_TRIANGLES
const uint kSideCount = 3u;
#else
const uint kSideCount = 4u;
#endif

// Where a sample is evaluated. Inside a face that is the face itself; on an edge or corner it is the owner, whatever
// face is being drawn, so that all of them arrive at the same bits.
struct Place {
    Touch owner;
    uint firstTouch;
    uint touchCount;
    float t;         // along the owner edge
    bool isInside;
    vec2 uv;         // isInside: the face's own (u,v)
    uint flags;      // kPlace...
};

// Parameter of sample k of n along an edge (see segmentsOf); seen from the other end it is 1 minus this, to the bit.
float sampleParameter(uint k, uint n, float rate) {
    uint near = min(k, n - k);
    precise float t = min(float(near) / rate, 0.5);
    precise float mirrored = 1.0 - t;
    return k == near ? t : mirrored;
}

// The same for a coordinate x = k/n that needs no exactness.
float spaced(float x, float n, float rate) {
    float t = min(min(x, 1.0 - x) * n / rate, 0.5);
    return x <= 0.5 ? t : 1.0 - t;
}

vec2 sidePoint(uint side, float x) {
#ifdef RELIEF_TRIANGLES
    return side == 0u ? vec2(x, 0.0) : side == 1u ? vec2(1.0 - x, x) : vec2(0.0, 1.0 - x);
#else
    return side == 0u ? vec2(x, 0.0) : side == 1u ? vec2(1.0, x) : side == 2u ? vec2(1.0 - x, 1.0) : vec2(0.0, 1.0 - x);
#endif
}

vec2 touchPoint(Touch touch, float t) { return sidePoint(touch.side, touch.start + t * (touch.end - touch.start)); }

Place insidePlace(uint face, vec2 uv) { return Place(Touch(face, 0u, 0.0, 0.0), 0u, 0u, 0.0, true, uv, 0u); }

Place cornerPlace(uint corner) {
    Corner c = fetchCorner(corner);
    return Place(c.owner, c.firstTouch, c.touchCount, 0.0, false, vec2(0), c.flags);
}

// Sample k of n along an edge of that rate, in the edge's own direction.
Place edgePlace(uint edge, uint k, uint n, float rate) {
    Edge e = fetchEdge(edge);
    if (k == 0u || k == n) return cornerPlace(e.corners[k == 0u ? 0 : 1]);
    return Place(e.owner, e.firstTouch, e.touchCount, sampleParameter(k, n, rate), false, vec2(0), e.flags);
}

// A side has as many segments as its edge, or as the two halves of a split one.
struct SideRate {
    uint segments;
    float rate;
};

SideRate sideRate(uint sideEntry) {
    float rate = edgeRate(sideEntry & kSideEdgeMask);
    uint halves = (sideEntry & kSideSplit) != 0u ? 2u : 1u;
    return SideRate(halves * segmentsOf(rate, scene.isFractional), float(halves) * rate);
}

// Sample k along a side, in the side's direction.
Place sidePlace(uint sideEntry, uint k, SideRate side) {
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
    return edgePlace(edge, k, n, rate);
}
#endif
