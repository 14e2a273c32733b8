// Heights from the map: h(s,t) with central differences, between mip levels.
#ifndef RELIEF_HEIGHTS_GLSL
#define RELIEF_HEIGHTS_GLSL

#include "inputs.glsl"

layout(constant_id = kIdMapFormat) const uint kMapFormat = kMapReal; // kMap...

// Words are fetched in pairs, for neighbouring texels of small formats lie in the same one.
RELIEF_TABLE(kBindHeight, uvec2, wordsAt)

struct HeightSample {
    float h;
    vec2 gradient;  // (h_s, h_t)
};

// The record of the map that holds (s,t).
uint mapAt(vec2 st) { return 0u; }

// The columns or rows first - 1 to first + 2 of a map level of that size.
ivec4 wrapped(int first, int size, bool repeats) {
    if (!repeats) return clamp(first + ivec4(-1, 0, 1, 2), 0, size - 1);
    // The first one falls anywhere, each of the others is the next one or 0: of a level may be a single one.
    ivec4 at = ivec4(first - 1 - size * int(floor(float(first - 1) / float(size))));
    at.y = at.x + 1 == size ? 0 : at.x + 1;
    at.z = at.y + 1 == size ? 0 : at.y + 1;
    at.w = at.z + 1 == size ? 0 : at.z + 1;
    return at;
}

// Texels are fetched and weighed here, not by the sampler, whose fractions are 8 bits on many devices: stairs in h_s.

uint heightWord(int i) {
    uvec2 words = wordsAt(uint(i >> 1));
    return (i & 1) == 0 ? words.x : words.y;
}

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

// h bilinear; h_s = (h(s+d,t) - h(s-d,t)) / 2d with d one texel (Marschner, CS 569), h_t likewise: twelve texels, of
// which the four around the point serve both. t points up, rows go down.
HeightSample sampleLevel(uint map, vec2 st, uint number) {
    ivec2 size = max(inputs.model.maps[map].size >> int(number), 1);
    int first = int(inputs.model.maps[map].firstWords[number]);
    precise vec2 x = vec2(st.x, 1.0 - st.y) * vec2(size) - 0.5;
    vec2 whole = floor(x);
    vec2 f = x - whole;
    bool repeats = inputs.model.maps[map].repeats != 0u;
    ivec4 c = wrapped(int(whole.x), size.x, repeats), r = wrapped(int(whole.y), size.y, repeats);
    // What columns and rows add to the number of a texel.
    if (mapIsInBlocks(kMapFormat, size)) {
        c = (c >> 2) * 16 + (c & 3);
        r = (r >> 2) * (((size.x + 3) >> 2) * 16) + (r & 3) * 4;
    } else {
        r *= size.x;
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
    precise float down = mix(row1, rowHigh, f.y) - mix(rowLow, row0, f.y);

    HeightSample s;
    s.h = inputs.model.maps[map].scale * (mix(row0, row1, f.y) - inputs.model.maps[map].mid);
    vec2 perUnit = 0.5 * inputs.model.maps[map].scale * vec2(size);
    s.gradient = vec2(mix(across0, across1, f.y), -down) * perUnit;
    return s;
}

#ifdef RELIEF_HEIGHT_FUNCTION
#include "function.glsl"
#endif

// Between two levels of the map. Both are always read, one after the other and not in a loop: a processor then waits for the
// memory of both at once. SwiftShader, which reads tables from storage buffers, takes minutes to compile that; it gets the loop.
HeightSample betweenLevels(uint map, vec2 st, float level) {
    if (!kHasMips) return sampleLevel(map, st, 0u);
    float last = float(inputs.model.maps[map].levelCount - 1u);
    level = clamp(level, 0.0, last);
    float lower = floor(level);
    precise float f = level - lower;
#ifdef RELIEF_STORAGE_TABLES
    HeightSample s = HeightSample(0.0, vec2(0));
    for (uint i = 0u; i < (f > 0.0 ? 2u : 1u); ++i) {
        precise float weight = i == 0u ? 1.0 - f : f;
        HeightSample one = sampleLevel(map, st, uint(lower) + i);
        precise float h = s.h + weight * one.h;
        s.h = h;
        s.gradient += weight * one.gradient;
    }
    return s;
#else
    HeightSample fine = sampleLevel(map, st, uint(lower)), coarse = sampleLevel(map, st, uint(min(lower + 1.0, last)));
    precise float h = (1.0 - f) * fine.h + f * coarse.h;
    return HeightSample(h, (1.0 - f) * fine.gradient + f * coarse.gradient);
#endif
}
#endif
