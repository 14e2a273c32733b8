#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#define RELIEF_VARYING in
#include "varyings.glsl"
#include "octahedral.glsl"
#include "rounding.glsl"

// Writes what light.comp needs of the surface, four samples a pixel, and no more: dense triangles are about a pixel large,
// and what is done here is done several times a pixel.

layout(constant_id = 5) const uint kShow = kShowShaded;
layout(constant_id = 6) const bool kHasAlbedoMap = false;

layout(set = 0, binding = kBindAlbedo) uniform sampler2D albedoMap;

layout(location = 0) out vec2 normal; // octahedral
layout(location = 1) out vec4 color;  // albedo, or with --show what is seen: see storedColor()

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

void main() {
    vec3 n = gl_FrontFacing || kShow == kShowNormal ? vNormal : -vNormal;
    normal = roundToHalf(octahedral(n));
    vec3 c = scene.albedo;
    if (kHasAlbedoMap) c *= texture(albedoMap, vec2(vTexCoord.x, 1.0 - vTexCoord.y)).rgb;
    if (kShow == kShowHeight) c = heightColor(scene.heightBound > 0.0 ? vHeight / scene.heightBound : 0.0);
    else if (kShow == kShowRate) c = rateColor(float(vRate));
    else if (kShow == kShowFaces) c = faceColor(vFace);
    else if (kShow == kShowWireframe) c = shown(ivec3(204, 209, 217));
    else if (kShow == kShowLines) c = shown(ivec3(20, 26, 36));
    color = vec4(storedColor(c, kShow == kShowShaded), 1.0);
}
