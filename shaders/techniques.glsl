// What a fragment of each technique (kShow) looks like before light: its colour, 0..1.
#ifndef RELIEF_TECHNIQUES_GLSL
#define RELIEF_TECHNIQUES_GLSL

layout(constant_id = kIdHasAlbedoMap) const bool kHasAlbedoMap = false;

#include "lookup.glsl"

layout(set = 0, binding = kBindAlbedo) uniform sampler2D albedoMap;

// The colors of --show are whole codes of 8 bits, made by whole numbers: faces of one color have no value that a device could
// round to either side.
vec3 shown(ivec3 code) { return vec3(code) / 255.0; }

// A calm diverging map: blue below, white at rest, orange above.
vec3 heightColor(float x) {
    vec3 end = x < 0.0 ? shown(ivec3(26, 77, 166)) : shown(ivec3(217, 97, 15));
    return mix(shown(ivec3(237)), end, clamp(abs(x), 0.0, 1.0));
}

// From blue (1 segment per edge) to red (64), by the logarithm of the rate in 64ths, straight between powers of two.
vec3 rateColor(float rate) {
    int x = clamp(int(floatBitsToUint(rate) >> 17u) - (127 << 6), 0, 6 * 64);
    return shown(clamp(ivec3((17 * x >> 4) - 51, 64 + x * (461 - x) / 445, 191 - (153 * x >> 8)), 0, 255));
}

vec3 faceColor(uint face) {
    uint h = face * 747796405u + 2891336453u;
    h = ((h >> ((h >> 28u) + 4u)) ^ h) * 277803737u;
    return shown(ivec3(89) + (9 * ivec3(h & 255u, (h >> 8) & 255u, (h >> 16) & 255u) >> 4));
}

// Each unit square of texture coordinates in 8 x 8 fields, light and dark by turns: s makes them redder, t greener.
vec3 texCoordColor(vec2 st) {
    if (!kWantsTexCoords) return shown(ivec3(204)); // there are none
    ivec2 field = clamp(ivec2(8.0 * fract(st)), 0, 7);
    ivec3 code = ivec3(45 + 26 * field, 150);
    return shown(((field.x + field.y) & 1) == 0 ? code : 3 * code / 4);
}

vec3 albedo() {
    vec3 c = inputs.material.albedo;
    return kHasAlbedoMap ? c * lookUp(albedoMap, inputs.model.albedoTiles, 0.0).rgb : c;
}

vec3 lineColor() { return shown(ivec3(20, 26, 36)); }

vec3 techniqueColor() {
    if (kPass == kPassLines) return lineColor();
    switch (kShow) {
    case kShowHeight: return heightColor(inputs.model.heightBound > 0.0 ? vHeight / inputs.model.heightBound : 0.0);
    case kShowRate: return rateColor(float(vRate));
    case kShowFaces: return faceColor(vFace);
    case kShowTexCoords: return texCoordColor(vTexCoord.xy);
    case kShowWireframe: return shown(ivec3(204, 209, 217)); // the surface under the lines
    default: return albedo();
    }
}
#endif
