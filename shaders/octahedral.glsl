// Cigolle et al. (2014), "Survey of Efficient Representations for Independent Unit Vectors".
#ifndef RELIEF_OCTAHEDRAL_GLSL
#define RELIEF_OCTAHEDRAL_GLSL

vec2 octahedral(vec3 n) {
    vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    vec2 folded = (1.0 - abs(p.yx)) * vec2(p.x >= 0.0 ? 1.0 : -1.0, p.y >= 0.0 ? 1.0 : -1.0);
    return n.z < 0.0 ? folded : p;
}

vec3 fromOctahedral(vec2 p) {
    vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
    float fold = max(-n.z, 0.0);
    n.xy -= fold * vec2(n.x >= 0.0 ? 1.0 : -1.0, n.y >= 0.0 ? 1.0 : -1.0);
    return normalize(n);
}

// 16 bits per number, each -1..1.
uint packPair(vec2 p) {
    ivec2 code = ivec2(floor(32767.0 * p + 0.5));
    return uint(code.x & 0xffff) | uint(code.y) << 16;
}
vec2 unpackPair(uint code) { return vec2(int(code << 16) >> 16, int(code) >> 16) / 32767.0; }

uint packNormal(vec3 n) { return packPair(octahedral(n)); }
vec3 unpackNormal(uint code) { return fromOctahedral(unpackPair(code)); }
#endif
