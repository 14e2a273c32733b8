// Where samples are evaluated, and how many an edge has.
#ifndef RELIEF_PLACES_GLSL
#define RELIEF_PLACES_GLSL

#include "scene.glsl"

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
};

vec2 sidePoint(uint side, float x) {
#ifdef RELIEF_TRIANGLES
    return side == 0u ? vec2(x, 0.0) : side == 1u ? vec2(1.0 - x, x) : vec2(0.0, 1.0 - x);
#else
    return side == 0u ? vec2(x, 0.0) : side == 1u ? vec2(1.0, x) : side == 2u ? vec2(1.0 - x, 1.0) : vec2(0.0, 1.0 - x);
#endif
}

vec2 touchPoint(Touch touch, float t) { return sidePoint(touch.side, touch.start + t * (touch.end - touch.start)); }

Place insidePlace(uint face, vec2 uv) { return Place(Touch(face, 0u, 0.0, 0.0), 0u, 0u, 0.0, true, uv); }

Place cornerPlace(uint corner) {
    Corner c = fetchCorner(corner);
    return Place(c.owner, c.firstTouch, c.touchCount, 0.0, false, vec2(0));
}

// Sample k of n along an edge, in the edge's own direction.
Place edgePlace(uint edge, uint k, uint n) {
    Edge e = fetchEdge(edge);
    if (k == 0u || k == n) return cornerPlace(e.corners[k == 0u ? 0 : 1]);
    return Place(e.owner, e.firstTouch, e.touchCount, float(k) / float(n), false, vec2(0));
}

uint sideRate(uint sideEntry) {
    uint rate = edgeRate(sideEntry & kSideEdgeMask);
    return (sideEntry & kSideSplit) != 0u ? 2u * rate : rate;
}

// Sample k of n = sideRate() along a side, in the side's direction.
Place sidePlace(uint sideEntry, uint k, uint n) {
    uint edge = sideEntry & kSideEdgeMask;
    if ((sideEntry & kSideReversed) != 0u) k = n - k;
    if ((sideEntry & kSideSplit) != 0u) {
        n /= 2u;
        if (k > n) {
            k -= n;
            edge += 1u;
        }
    }
    return edgePlace(edge, k, n);
}
#endif
