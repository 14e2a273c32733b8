#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#define RELIEF_VARYING in
#include "varyings.glsl"
#include "octahedral.glsl"

// Writes what light.comp needs of the surface, four samples a pixel, and no more: dense triangles are about a pixel large,
// and what is done here is done several times a pixel.

layout(constant_id = 5) const uint kShow = kShowShaded;
layout(constant_id = 6) const bool kHasAlbedoMap = false;

layout(set = 0, binding = kBindAlbedo) uniform sampler2D albedoMap;

layout(location = 0) out vec2 normal; // octahedral
layout(location = 1) out vec4 color;  // albedo, or with --show what is seen

// A calm diverging map: blue below, white at rest, orange above.
vec3 heightColor(float x) {
    vec3 end = x < 0.0 ? vec3(0.10, 0.30, 0.65) : vec3(0.85, 0.38, 0.06);
    return mix(vec3(0.93), end, clamp(abs(x), 0.0, 1.0));
}

vec3 rateColor(float rate) {
    float x = clamp(log2(rate) / 6.0, 0.0, 1.0); // 1 to 64 segments
    return clamp(vec3(1.6 * x - 0.2, 0.25 + 1.3 * x * (1.2 - x), 0.75 - 0.9 * x), 0.0, 1.0);
}

vec3 faceColor(uint face) {
    uint h = face * 747796405u + 2891336453u;
    h = ((h >> ((h >> 28u) + 4u)) ^ h) * 277803737u;
    return vec3(0.35) + 0.55 * vec3(h & 255u, (h >> 8) & 255u, (h >> 16) & 255u) / 255.0;
}

void main() {
    vec3 n = gl_FrontFacing || kShow == kShowNormal ? vNormal : -vNormal;
    normal = octahedral(n);
    vec3 c = scene.albedo;
    if (kHasAlbedoMap) c *= texture(albedoMap, vec2(vTexCoord.x, 1.0 - vTexCoord.y)).rgb;
    if (kShow == kShowHeight) c = heightColor(scene.heightReach > 0.0 ? vHeight / scene.heightReach : 0.0);
    else if (kShow == kShowRate) c = rateColor(float(vRate));
    else if (kShow == kShowFaces) c = faceColor(vFace);
    else if (kShow == kShowWireframe) c = vec3(0.80, 0.82, 0.85);
    else if (kShow == kShowLines) c = vec3(0.08, 0.10, 0.14);
    color = vec4(c, 1.0);
}
