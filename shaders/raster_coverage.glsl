// Coverage of triangles whose edges' E fit 32 bits, block by block. Included by shaders of one invocation per triangle.
//
// On CPU drivers both sides of branches run and each atomic is a loop over the lanes, but arithmetic and texel fetches serve all
// lanes at once: coverage is a bit mask of eight pixels, and there is one loop over its bits with one atomic in it.
#ifndef RELIEF_RASTER_COVERAGE_GLSL
#define RELIEF_RASTER_COVERAGE_GLSL

#include "raster.glsl"

const ivec2 kBlock = ivec2(4, 2);
const int kAroundBox = 2048; // how much wider and higher than a triangle's box the places are at which E is asked for, at most

struct ShortTriangle {
    ivec2 first, last; // pixels with samples in the bounding box; last < first: none
    ivec3 dx, dy;      // of the edges b -> c, c -> a, a -> b, in the order that makes E positive inside
    ivec3 bias;        // -1 on edges that are neither top nor left, else 0
    ivec3 e;           // E at the corner of the first pixel, with the bias
    int area;          // twice
    bool isFront;
    Attributes all;
};

// Makes one of three vertices on the screen, which are x, y, depth and normal.
ShortTriangle shortTriangle(uvec4 va, uvec4 vb, uvec4 vc) {
    ShortTriangle t;
    ivec2 a = ivec2(va.xy), b = ivec2(vb.xy), c = ivec2(vc.xy);
    t.first = max((min(a, min(b, c)) + (255 - lastPlace())) >> 8, ivec2(0));
    t.last = min((max(a, max(b, c)) - firstPlace()) >> 8, push.size - 1);
    ivec2 ab = b - a, ac = c - a;
    t.area = ab.x * ac.y - ab.y * ac.x;
    t.isFront = t.area < 0;
    if (t.isFront) {
        uvec4 v = vb;
        vb = vc, vc = v;
        b = ivec2(vb.xy), c = ivec2(vc.xy);
        t.area = -t.area;
    }
    ivec2 bc = c - b, ca = a - c;
    ab = b - a;
    t.dx = ivec3(bc.x, ca.x, ab.x);
    t.dy = ivec3(bc.y, ca.y, ab.y);
    t.bias = ivec3(biasOf(bc), biasOf(ca), biasOf(ab));
    ivec2 corner = 256 * t.first;
    t.e = ivec3(bc.x * (corner.y - b.y) - bc.y * (corner.x - b.x), ca.x * (corner.y - c.y) - ca.y * (corner.x - c.x),
                ab.x * (corner.y - a.y) - ab.y * (corner.x - a.x)) + t.bias;
    t.all = attributesOf(ScreenVertex(a, uintBitsToFloat(va.z), va.w), ScreenVertex(b, uintBitsToFloat(vb.z), vb.w),
                         ScreenVertex(c, uintBitsToFloat(vc.z), vc.w), t.isFront);
    return t;
}

ivec3 edgesAt(ShortTriangle t, ivec2 place) { return t.e + t.dx * place.y - t.dy * place.x; }

uint coverageOfPixel(ShortTriangle t, ivec3 e) {
    if (sampleCount() == 1u) return isOutside(e + 128 * (t.dx - t.dy)) ^ 1u;
    ivec3 x = 32 * t.dx, y = 32 * t.dy;
    uint outside = isOutside(e + x - 3 * y) | isOutside(e + 3 * x - 7 * y) << 1 | isOutside(e + 5 * x - y) << 2 |
                   isOutside(e + 7 * x - 5 * y) << 3;
    return outside ^ 15u;
}

// A bit per sample of a block, sampleCount() per pixel, row by row.
uint coverageOfBlock(ShortTriangle t, ivec2 pixel) {
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

// Writes the samples that a triangle covers in the block at `pixel`, counted from its first one.
void drawBlock(ShortTriangle t, ivec2 pixel, uint triangle) {
    float perArea = 1.0 / float(t.area);
    uint mask = coverageOfBlock(t, pixel);
    while (mask != 0u) {
        uint bit = uint(findLSB(mask));
        mask &= mask - 1u;
        ivec2 inBlock = ivec2(bit / sampleCount() % uint(kBlock.x), bit / (sampleCount() * uint(kBlock.x)));
        uint s = bit % sampleCount();
        ivec3 e = edgesAt(t, 256 * (pixel + inBlock) + placeOf(s)) - t.bias;
        store(t.first + pixel + inBlock, s, vec3(e) * perArea, t.all, triangle, t.isFront);
    }
}
#endif
