#version 460
#extension GL_GOOGLE_include_directive : require
#include "raster.glsl"

// Small triangles, one invocation each. Those that are larger, or have to be clipped, are listed for raster_large.comp.
//
// On CPU drivers both sides of branches run and each atomic is a loop over the lanes, but arithmetic and texel fetches serve all
// lanes at once: coverage is a bit mask of eight pixels, and there is one loop over its bits with one atomic in it.
layout(local_size_x_id = kIdGroupSize) in;

const int kMostPixelsAcross = 32; // 256 * 32 squared fits 32-bit numbers
const ivec2 kBlock = ivec2(4, 2);

struct SmallTriangle {
    ivec2 first, last;   // pixels with samples in the bounding box; last < first: none
    ivec3 dx, dy;        // of the edges b -> c, c -> a, a -> b
    ivec3 bias;          // -1 on edges that are neither top nor left, else 0
    ivec3 e;             // E at the corner of the first pixel, with the bias
};

ivec3 edgesAt(SmallTriangle t, ivec2 place) { return t.e + t.dx * place.y - t.dy * place.x; }

uint coverageOfPixel(SmallTriangle t, ivec3 e) {
    if (sampleCount() == 1u) return isOutside(e + 128 * (t.dx - t.dy)) ^ 1u;
    ivec3 x = 32 * t.dx, y = 32 * t.dy;
    uint outside = isOutside(e + x - 3 * y) | isOutside(e + 3 * x - 7 * y) << 1 | isOutside(e + 5 * x - y) << 2 |
                   isOutside(e + 7 * x - 5 * y) << 3;
    return outside ^ 15u;
}

// A bit per sample of a block, sampleCount() per pixel, row by row.
uint coverageOfBlock(SmallTriangle t, ivec2 pixel) {
    ivec3 corner = edgesAt(t, 256 * pixel);
    uint mask = 0u;
    [[unroll]] for (int y = 0; y < kBlock.y; ++y) {
        [[unroll]] for (int x = 0; x < kBlock.x; ++x)
            mask |= coverageOfPixel(t, corner + 256 * (t.dx * y - t.dy * x)) << (int(sampleCount()) * (kBlock.x * y + x));
    }
    // Pixels past the last one.
    ivec2 left = t.last - t.first - pixel + 1;
    uint row = left.x >= kBlock.x ? (sampleCount() == 1u ? 0xfu : 0xffffu) : (1u << (sampleCount() * uint(left.x))) - 1u;
    return mask & (left.y > 1 ? row | row << (sampleCount() * uint(kBlock.x)) : row);
}

void main() {
    uint triangle = push.first + gl_GlobalInvocationID.x;
    if (triangle >= push.count) return;
    uvec4 va = screenAt(meshIndex(3u * triangle)), vb = screenAt(meshIndex(3u * triangle + 1u)), vc = screenAt(meshIndex(3u * triangle + 2u));
    ivec2 a = ivec2(va.xy), b = ivec2(vb.xy), c = ivec2(vc.xy);

    // The pixels that it may cover, and whether it is one of the small ones.
    SmallTriangle t;
    ivec2 low = min(a, min(b, c)), high = max(a, max(b, c));
    bool isUnplaced = low.x == kUnplaced;
    bool areBehind = max(a.x, max(b.x, c.x)) == kUnplaced && max(a.y, max(b.y, c.y)) == kBehind;
    t.first = max((low + (255 - lastPlace())) >> 8, ivec2(0));
    t.last = min((high - firstPlace()) >> 8, push.size - 1);
    bool isInView = all(lessThanEqual(t.first, t.last));
    ivec2 size = high - low; // wraps where a corner is unplaced
    bool isLarge = isUnplaced ? !areBehind : isInView && max(size.x, size.y) > 256 * kMostPixelsAcross;
    bool isDrawn = isInView && !isLarge && !isUnplaced;

    // Edges in the order that makes E positive inside.
    ivec2 ab = b - a, ac = c - a;
    int area = ab.x * ac.y - ab.y * ac.x;
    bool isFront = area < 0;
    if (isFront) {
        uvec4 v = vb;
        vb = vc, vc = v;
        b = ivec2(vb.xy), c = ivec2(vc.xy);
        area = -area;
    }
    ivec2 bc = c - b, ca = a - c;
    ab = b - a;
    t.dx = ivec3(bc.x, ca.x, ab.x);
    t.dy = ivec3(bc.y, ca.y, ab.y);
    t.bias = ivec3(biasOf(bc), biasOf(ca), biasOf(ab));
    ivec2 corner = 256 * t.first;
    t.e = ivec3(bc.x * (corner.y - b.y) - bc.y * (corner.x - b.x), ca.x * (corner.y - c.y) - ca.y * (corner.x - c.x),
                ab.x * (corner.y - a.y) - ab.y * (corner.x - a.x)) + t.bias;

    Attributes all = attributesOf(ScreenVertex(a, uintBitsToFloat(va.z), va.w), ScreenVertex(b, uintBitsToFloat(vb.z), vb.w),
                                  ScreenVertex(c, uintBitsToFloat(vc.z), vc.w), isFront);
    float perArea = 1.0 / float(area);
    ivec2 blocks = isDrawn && area > 0 ? (t.last - t.first + kBlock) / kBlock : ivec2(0);
    ivec2 block = ivec2(0);
    for (int k = blocks.x * blocks.y; k > 0; --k) {
        ivec2 pixel = kBlock * block;
        uint mask = coverageOfBlock(t, pixel);
        while (mask != 0u) {
            uint bit = uint(findLSB(mask));
            mask &= mask - 1u;
            ivec2 inBlock = ivec2(bit / sampleCount() % uint(kBlock.x), bit / (sampleCount() * uint(kBlock.x)));
            uint s = bit % sampleCount();
            ivec3 e = edgesAt(t, 256 * (pixel + inBlock) + placeOf(s)) - t.bias;
            store(t.first + pixel + inBlock, s, vec3(e) * perArea, all, triangle, isFront);
        }
        if (++block.x == blocks.x) block = ivec2(0, block.y + 1);
    }
    if (isLarge) {
        uint number = atomicAdd(inputs.targets.largeTriangles.at[kLargeCount], 1u);
        atomicMax(inputs.targets.largeTriangles.at[0], min(number + 1u, kMostLargeGroups));
        inputs.targets.largeTriangles.at[kLargeFirst + number] = triangle;
        inputs.targets.largeTriangles.at[kLargeSeen] = 1u;
    }
}
