// Triangles made into samples by compute shaders: coordinates, coverage and what is stored per sample.
//
// Positions are snapped to 1/256 of a pixel. From there on coverage is integer arithmetic: of the edge a -> b
// E(p) = dx (p.y - a.y) - dy (p.x - a.x) is twice the area of (a, b, p), and a sample is inside where no E is below 0, or 0 on an
// edge that is neither a top nor a left one (Pineda 1988). A sample on an edge that two triangles share is in one of them.
#ifndef RELIEF_RASTER_GLSL
#define RELIEF_RASTER_GLSL

#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_shader_explicit_arithmetic_types_int64 : require
#extension GL_EXT_shader_atomic_int64 : require

#include "inputs.glsl"
#include "octahedral.glsl"
#include "project.glsl"
#include "raster_samples.glsl"

layout(push_constant, scalar) uniform PushBlock { RasterPush push; };

RELIEF_TABLE(kBindMesh, vec4, meshAt)
RELIEF_TABLE(kBindMeshIndices, uint, meshIndex)
RELIEF_TABLE(kBindScreen, uvec4, screenAt)

layout(buffer_reference, scalar, buffer_reference_align = 8) buffer Longs { uint64_t at[]; };

layout(constant_id = kIdShow) const uint kShow = kShowShaded;
layout(constant_id = kIdWritesIds) const bool kWritesIds = false; // samples get numbers of triangles instead of normals

// Per pixel: of layers one, at its centre. No constants: Mesa 22.3 cannot compile those that follow from a specialization constant.
uint sampleCount() { return kPass == kPassSurface ? kMostSamples : 1u; }

// --- vertices on the screen -------------------------------------------------------------------------------------------

struct ScreenVertex {
    ivec2 p;      // 1/256 of a pixel; or x is kUnplaced, and y says why
    float depth;
    uint normal;  // octahedral, 16 bits each: in the world
};

// Vertices that have no place on the screen: their triangles are clipped.
const int kUnplaced = int(0x80000000);
const int kBehind = 1; // nearer than the near plane
const int kAside = 2;  // farther from the middle of the picture than numbers of a pixel are precise
const float kMostPixels = 1048576.0;

bool isBehind(vec4 clip) { return !(clip.w > 0.0 && clip.z <= clip.w); }

// A vertex that is not behind.
ScreenVertex toScreen(vec4 clip) {
    precise float perW = 1.0 / clip.w;
    precise vec2 halfSize = 0.5 * vec2(push.size);
    precise vec2 pixel = clip.xy * perW * halfSize + halfSize;
    ScreenVertex v = ScreenVertex(ivec2(kUnplaced, kAside), clip.z * perW, 0u);
    if (all(lessThan(abs(pixel), vec2(kMostPixels)))) v.p = ivec2(roundEven(256.0 * pixel));
    return v;
}

// In a parallel projection all are as far; else 1/w is this but for a factor: depth is push.depthAtInfinity + c / w.
float perDistance(float depth) { return kPass == kPassSurface ? depth - push.depthAtInfinity : 1.0; }

// --- samples of a pixel -----------------------------------------------------------------------------------------------

// Where sample s lies in its pixel, in 1/256 of a pixel: one alone in the middle.
ivec2 placeOf(uint s) { return sampleCount() == 1u ? ivec2(128) : placeInPixel(s); }
int firstPlace() { return sampleCount() == 1u ? 128 : 32; }
int lastPlace() { return 256 - firstPlace(); }

// 0 where the edges' sample is covered: no E is below 0.
uint isOutside(ivec3 e) { return uint(e.x | e.y | e.z) >> 31; }

int biasOf(ivec2 edge) { return edge.y < 0 || (edge.y == 0 && edge.x > 0) ? 0 : -1; }

// The first and the last of the columns 0 to `last` that may have samples inside of three edges, of which `most` are the largest E at
// the left side of column 0 in the rows that are asked for. E falls by dy to the right.
ivec2 columnsBetween(vec3 most, ivec3 dy, int last) {
    vec3 at = most / vec3(dy); // where E is 0
    float width = 256.0 * float(last + 1);
    vec3 lows = mix(vec3(0), at, lessThan(dy, ivec3(0))), highs = mix(vec3(width), at, greaterThan(dy, ivec3(0)));
    float low = clamp(max(lows.x, max(lows.y, lows.z)), 0.0, 2.0 * width), high = clamp(min(highs.x, min(highs.y, highs.z)), -width, width);
    // One more to each side than floats are precise to.
    return ivec2(max((int(low) - 1 + 255 - lastPlace()) >> 8, 0), min((int(high) + 1 - firstPlace()) >> 8, last));
}

// What a triangle's corners are interpolated with: the depth, and normals divided by w, whose sums have the direction of the
// perspective-correct normal.
struct Attributes {
    vec3 depths;
    vec3 normals[3];
};

Attributes attributesOf(ScreenVertex a, ScreenVertex b, ScreenVertex c, bool isFront) {
    Attributes all;
    all.depths = vec3(a.depth, b.depth, c.depth);
    if (kPass != kPassSurface || kWritesIds) return all;
    float side = isFront || kShow == kShowNormal ? 1.0 : -1.0;
    all.normals[0] = side * perDistance(a.depth) * unpackNormal(a.normal);
    all.normals[1] = side * perDistance(b.depth) * unpackNormal(b.normal);
    all.normals[2] = side * perDistance(c.depth) * unpackNormal(c.normal);
    return all;
}

// The nearest of all that arrive at a sample stays; of two at one depth that with the larger number, whichever comes first.
void keepNearest(uint at, uint s, uint low, float depth) {
    atomicMax(Longs(inputs.targets.samples).at[sampleCount() * at + s], packUint2x32(uvec2(low, floatBitsToUint(depth))));
}

// Writes a sample of a triangle at the barycentric coordinates `weights`.
void store(ivec2 pixel, uint s, vec3 weights, Attributes all, uint triangle, bool isFront) {
    uint at = uint(pixel.y * push.size.x + pixel.x);
    if (kPass == kPassCracks) {
        atomicAdd(inputs.targets.crossings.at[at], isFront ? 1u : 0xffffffffu);
        return;
    }
    float lowest = min(all.depths.x, min(all.depths.y, all.depths.z)), highest = max(all.depths.x, max(all.depths.y, all.depths.z));
    float depth = clamp(dot(weights, all.depths), lowest, highest);
    if (kPass == kPassShadow) {
        atomicMax(inputs.targets.shadow.at[at], uint(floor(kShadowCodes * clamp(depth, 0.0, 1.0) + 0.5)));
        return;
    }
    uint low = packId(push.firstId + triangle, false, isFront);
    if (!kWritesIds) low = packNormal(weights.x * all.normals[0] + weights.y * all.normals[1] + weights.z * all.normals[2]);
    keepNearest(at, s, low, max(depth, 0.0));
}
#endif
