#version 460
#extension GL_GOOGLE_include_directive : require
#include "raster_coverage.glsl"

// Small triangles, one invocation each. Others are listed: long thin ones for raster_thin.comp, those that cover more or have to be
// clipped for raster_large.comp.
layout(local_size_x_id = kIdGroupSize) in;

const int kMostPixelsAcross = 32; // of a small one
const float kMostArea = 256.0 * 256.0 * 32.0 * 32.0; // of a thin one, twice: what a small one may have

// Whether a triangle covers no more than a small one may and its E fit 32 bits: at places around the box of the corners no E is
// larger than the box and these places are together.
bool isThin(ivec2 size, ivec2 ab, ivec2 ac) {
    vec2 s = vec2(size) + float(kAroundBox), u = vec2(ab), v = vec2(ac);
    return s.x * s.y < 2147483648.0 && abs(u.x * v.y - u.y * v.x) <= kMostArea;
}

void main() {
    uint triangle = push.first + gl_GlobalInvocationID.x;
    if (triangle >= push.count) return;
    uvec4 va = screenAt(meshIndex(3u * triangle)), vb = screenAt(meshIndex(3u * triangle + 1u)), vc = screenAt(meshIndex(3u * triangle + 2u));
    ivec2 a = ivec2(va.xy), b = ivec2(vb.xy), c = ivec2(vc.xy);

    // Whether it may cover pixels, and is one of the small ones.
    ShortTriangle t = shortTriangle(va, vb, vc);
    ivec2 low = min(a, min(b, c)), high = max(a, max(b, c));
    bool isUnplaced = low.x == kUnplaced;
    bool areBehind = max(a.x, max(b.x, c.x)) == kUnplaced && max(a.y, max(b.y, c.y)) == kBehind;
    bool isInView = all(lessThanEqual(t.first, t.last));
    ivec2 size = high - low; // wraps where a corner is unplaced
    bool isLarge = isUnplaced ? !areBehind : isInView && max(size.x, size.y) > 256 * kMostPixelsAcross;
    bool isDrawn = isInView && !isLarge && !isUnplaced;

    ivec2 blocks = isDrawn && t.area > 0 ? (t.last - t.first + kBlock) / kBlock : ivec2(0);
    ivec2 block = ivec2(0);
    for (int k = blocks.x * blocks.y; k > 0; --k) {
        drawBlock(t, kBlock * block, triangle);
        if (++block.x == blocks.x) block = ivec2(0, block.y + 1);
    }
    if (isLarge) {
        bool isListedThin = !isUnplaced && isThin(size, b - a, c - a);
        uint list = isListedThin ? kThinList : kLargeList;
        uint number = atomicAdd(inputs.targets.listedTriangles.at[list + kListCount], 1u);
        uint groups = (isListedThin ? number / kThinGroup : number) + 1u;
        atomicMax(inputs.targets.listedTriangles.at[list], min(groups, kMostListGroups));
        inputs.targets.listedTriangles.at[kListFirst + (isListedThin ? push.count - 1u - number : number)] = triangle;
        inputs.targets.listedTriangles.at[list + kListSeen] = 1u;
    }
}
