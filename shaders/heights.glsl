// Heights from maps: h with central differences, between mip levels.
#ifndef RELIEF_HEIGHTS_GLSL
#define RELIEF_HEIGHTS_GLSL

#include "map_parts.glsl"

layout(constant_id = kIdReadsNodes) const bool kReadsNodes = false; // maps per face: every sample lies on a node of its level
layout(constant_id = kIdMapFormat) const uint kMapFormat = kMapReal; // kMap...

struct HeightSample {
    float h;
    vec2 gradient;  // (h_s, h_t); of a map per face (h_u, h_v)
};

// Texels are fetched and weighed here, not by the sampler, whose fractions are 8 bits on many devices: stairs in h_s.

// Code i of a block, and the number that it stands for.
float blockNumber(uint word0, uint word1, int i) {
    uint codes = i < 8 ? word0 >> 16 | word1 << 16 : word1 >> 8; // eight of them are 24 bits
    int code = int(codes >> (3 * (i & 7))) & 7;
    float red0 = float(word0 & 255u), red1 = float(word0 >> 8 & 255u);
    if (code < 2) return code == 0 ? red0 : red1;
    bool hasEight = red0 > red1;
    if (!hasEight && code > 5) return code == 6 ? 0.0 : 255.0;
    precise float share = float(code - 1) * (hasEight ? 1.0 / 7.0 : 1.0 / 5.0);
    precise float number = red0 + share * (red1 - red0);
    return number;
}

// Texel i, in the order in which they are kept, of a level that begins at word `first`.
float texel(int first, int i) {
    if (kMapFormat == kMapBc4) {
        uvec2 words = wordsAt(uint((first >> 1) + (i >> 4))); // levels of blocks begin at an even word
        return blockNumber(words.x, words.y, i & 15);
    }
    if (kMapFormat == kMapReal) return uintBitsToFloat(heightWord(first + i));
    if (kMapFormat == kMapUnorm8) return float(heightWord(first + (i >> 2)) >> (8 * (i & 3)) & 255u);
    uint number = heightWord(first + (i >> 1)) >> (16 * (i & 1)) & 0xffffu;
    return kMapFormat == kMapHalf ? unpackHalf2x16(number).x : float(number);
}

// --- heights ----------------------------------------------------------------------------------------------------------

// h bilinear; h_s = (h(s+d,t) - h(s-d,t)) / 2d with d one texel (Marschner, CS 569), h_t likewise: twelve texels, of
// which the four around the point serve both.
HeightSample sampleLevel(MapPart part, uint number) {
    int first = firstOfLevel(part, number);
    MapTexels t = texelsAround(part, number);
    ivec4 c = t.columns, r = t.rows;
    vec2 f = t.f;
    // What columns and rows add to the number of a texel.
    if (mapIsInBlocks(kMapFormat, t.stored)) {
        c = (c >> 2) * 16 + (c & 3);
        r = (r >> 2) * (((t.stored.x + 3) >> 2) * 16) + (r & 3) * 4;
    } else {
        r *= t.stored.x;
    }
    ivec4 i = c + r.y, j = c + r.z;
    vec4 below = vec4(texel(first, i.x), texel(first, i.y), texel(first, i.z), texel(first, i.w));
    vec4 above = vec4(texel(first, j.x), texel(first, j.y), texel(first, j.z), texel(first, j.w));
    vec2 low = vec2(texel(first, c.y + r.x), texel(first, c.z + r.x));
    vec2 high = vec2(texel(first, c.y + r.w), texel(first, c.z + r.w));

    // Rows: value at x in each of the four rows; and the difference across two texels in the middle two.
    precise float rowLow = mix(low.x, low.y, f.x), row0 = mix(below.y, below.z, f.x);
    precise float row1 = mix(above.y, above.z, f.x), rowHigh = mix(high.x, high.y, f.x);
    precise float across0 = mix(below.z, below.w, f.x) - mix(below.x, below.y, f.x);
    precise float across1 = mix(above.z, above.w, f.x) - mix(above.x, above.y, f.x);
    precise float along = mix(row1, rowHigh, f.y) - mix(rowLow, row0, f.y);

    HeightSample s;
    s.h = inputs.model.maps[part.map].scale * (mix(row0, row1, f.y) - inputs.model.maps[part.map].mid);
    vec2 perUnit = 0.5 * inputs.model.maps[part.map].scale * t.perUnit;
    s.gradient = vec2(mix(across0, across1, f.y), along) * perUnit;
    return s;
}

#ifndef RELIEF_STORAGE_TABLES
// A level of a face's nodes: what all lookups in it share. CPU drivers load it lane by lane where it is read in a loop.
struct NodeLevel {
    int first;        // word where the level begins
    ivec2 segments;
    float scale, mid;
};

NodeLevel nodeLevel(MapPart part, float level) {
    uint number = kHasMips ? min(uint(level + 0.5), lastLevel(part)) : 0u;
    ivec2 segments = ivec2(1) << max(part.size - int(number), 0);
    return NodeLevel(firstOfLevel(part, number), segments, inputs.model.maps[part.map].scale, inputs.model.maps[part.map].mid);
}

// What sampleLevel() gives at a node: the node itself and the four beside it.
HeightSample sampleNode(NodeLevel level, vec2 at) {
    ivec2 node = ivec2(at * vec2(level.segments) + 0.5) + kFaceApron, stored = level.segments + 1 + 2 * kFaceApron;
    float left, middle, right, low, high;
    if (kMapFormat == kMapReal) {
        // Floats come in pairs: two of them hold the three nodes of the row.
        int i = level.first + node.y * stored.x + node.x;
        uvec2 before = wordsAt(uint((i - 1) >> 1)), behind = wordsAt(uint((i + 1) >> 1));
        bool isFirst = (i & 1) == 0; // of its pair
        left = uintBitsToFloat(isFirst ? before.y : before.x);
        middle = uintBitsToFloat(isFirst ? behind.x : before.y);
        right = uintBitsToFloat(isFirst ? behind.y : behind.x);
        low = texel(0, i - stored.x), high = texel(0, i + stored.x);
    } else {
        ivec3 c = node.x + ivec3(-1, 0, 1), r = node.y + ivec3(-1, 0, 1);
        bool isInBlocks = kMapFormat == kMapBc4; // sizes are odd
        if (isInBlocks) c = (c >> 2) * 16 + (c & 3), r = (r >> 2) * (((stored.x + 3) >> 2) * 16) + (r & 3) * 4;
        else r *= stored.x;
        left = texel(level.first, c.x + r.y), middle = texel(level.first, c.y + r.y), right = texel(level.first, c.z + r.y);
        low = texel(level.first, c.y + r.x), high = texel(level.first, c.y + r.z);
    }
    precise float h = level.scale * (middle - level.mid);
    return HeightSample(h, 0.5 * level.scale * vec2(level.segments) * vec2(right - left, high - low));
}
#endif

#ifdef RELIEF_HEIGHT_FUNCTION
#include "function.glsl"
#endif

// Between two levels of the map. Both are always read, one after the other and not in a loop: a processor then waits for the
// memory of both at once. SwiftShader, which reads tables from storage buffers, takes minutes to compile that; it gets the loop.
HeightSample betweenLevels(MapPart part, float level) {
    if (!kHasMips) return sampleLevel(part, 0u);
    float last = float(lastLevel(part));
    level = clamp(level, 0.0, last);
    float lower = floor(level);
    precise float f = level - lower;
#ifdef RELIEF_STORAGE_TABLES
    HeightSample s = HeightSample(0.0, vec2(0));
    for (uint i = 0u; i < (f > 0.0 ? 2u : 1u); ++i) {
        precise float weight = i == 0u ? 1.0 - f : f;
        HeightSample one = sampleLevel(part, uint(lower) + i);
        precise float h = s.h + weight * one.h;
        s.h = h;
        s.gradient += weight * one.gradient;
    }
    return s;
#else
    HeightSample fine = sampleLevel(part, uint(lower)), coarse = sampleLevel(part, uint(min(lower + 1.0, last)));
    precise float h = (1.0 - f) * fine.h + f * coarse.h;
    return HeightSample(h, (1.0 - f) * fine.gradient + f * coarse.gradient);
#endif
}
#endif
