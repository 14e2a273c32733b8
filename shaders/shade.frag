#version 460
#extension GL_GOOGLE_include_directive : require
#include "scene.glsl"
#define RELIEF_VARYING in
#include "varyings.glsl"

layout(constant_id = 5) const uint kShow = kShowShaded;
layout(constant_id = 6) const bool kHasAlbedoMap = false;

layout(set = 0, binding = kBindAlbedo) uniform sampler2D albedoMap;
layout(set = 0, binding = kBindEnvironment) uniform sampler2D environmentMap; // equirectangular, level = roughness
layout(set = 0, binding = kBindShadow) uniform sampler2D shadowMap;      // reversed depth from the key light

layout(location = 0) out vec4 color;

const float kPi = 3.14159265;

// Ramamoorthi and Hanrahan (2001), eq. 13, with the cosine lobe and basis constants folded into the coefficients.
vec3 irradiance(vec3 n) {
    return max(vec3(0), scene.irradiance[0] + scene.irradiance[1] * n.y + scene.irradiance[2] * n.z +
                            scene.irradiance[3] * n.x + scene.irradiance[4] * (n.x * n.y) +
                            scene.irradiance[5] * (n.y * n.z) + scene.irradiance[6] * (3.0 * n.z * n.z - 1.0) +
                            scene.irradiance[7] * (n.x * n.z) + scene.irradiance[8] * (n.x * n.x - n.y * n.y));
}

vec2 equirectangular(vec3 d) { return vec2(atan(d.x, -d.z) / (2.0 * kPi) + 0.5, acos(clamp(d.y, -1.0, 1.0)) / kPi); }

// Integrated specular albedo: Karis, "Physically Based Shading on Mobile" (2014), his fit of the split sum.
vec3 environmentBrdf(vec3 f0, float roughness, float nv) {
    vec4 r = roughness * vec4(-1, -0.0275, -0.572, 0.022) + vec4(1, 0.0425, 1.04, -0.04);
    float a = min(r.x * r.x, exp2(-9.28 * nv)) * r.x + r.y;
    vec2 ab = vec2(-1.04, 1.04) * a + r.zw;
    return f0 * ab.x + ab.y;
}

// GGX with Smith's height-correlated masking (Heitz 2014) and Schlick's Fresnel, times n.l.
float keySpecular(float nl, float nv, float nh, float vh, float roughness, float f0) {
    float a2 = roughness * roughness * roughness * roughness;
    float d = (nh * a2 - nh) * nh + 1.0;
    float distribution = a2 / (kPi * d * d);
    float visibility = 0.5 / max(1e-5, nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
    float fresnel = f0 + (1.0 - f0) * pow(1.0 - vh, 5.0);
    return distribution * visibility * fresnel * nl;
}

// Share of the key light that arrives: eight samples of the shadow map in a disc, turned from pixel to pixel.
const vec2 kDisc[8] = {vec2(0.25, 0.00), vec2(-0.32, 0.29), vec2(0.05, -0.56), vec2(0.40, 0.53),
                       vec2(-0.74, -0.13), vec2(0.70, -0.45), vec2(-0.23, 0.87), vec2(-0.45, -0.86)};

float keyVisibility(vec3 position, vec3 n) {
    if (scene.hasShadows == 0.0) return 1.0;
    float slope = 1.0 - abs(dot(n, scene.keyDirection));
    vec4 clip = scene.worldToShadow * vec4(position + n * scene.shadowBias * (0.5 + 2.0 * slope), 1.0);
    vec2 center = clip.xy * 0.5 + 0.5;
    float angle = 2.0 * kPi * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
    vec2 x = scene.shadowSoftness * vec2(cos(angle), sin(angle)), y = vec2(-x.y, x.x);
    float lit = 0.0;
    for (int i = 0; i < 8; ++i) {
        float depth = textureLod(shadowMap, center + kDisc[i].x * x + kDisc[i].y * y, 0.0).r;
        lit += depth <= clip.z ? 0.125 : 0.0;
    }
    return lit;
}

vec3 shaded(vec3 n, vec3 v) {
    vec3 albedo = scene.albedo;
    if (kHasAlbedoMap) albedo *= texture(albedoMap, vec2(vTexCoord.x, 1.0 - vTexCoord.y)).rgb;
    const float f0 = 0.04; // a dielectric of index 1.5
    float nv = max(dot(n, v), 1e-4);

    vec3 diffuse = irradiance(n) / kPi;
    vec3 mirrored = reflect(-v, n);
    // Directions below the surface see the surface: fade what they would reflect.
    float horizon = clamp(1.0 + 1.5 * dot(mirrored, n), 0.0, 1.0);
    vec3 around = textureLod(environmentMap, equirectangular(mirrored), scene.roughness * scene.environmentLevel).rgb;
    vec3 specular = around * environmentBrdf(vec3(f0), scene.roughness, nv) * horizon;

    vec3 l = scene.keyDirection, h = normalize(l + v);
    float nl = dot(n, l);
    if (nl > 0.0) {
        vec3 arriving = scene.keyRadiance * keyVisibility(vPosition, n);
        diffuse += arriving * nl / kPi;
        specular += arriving * keySpecular(nl, nv, clamp(dot(n, h), 0.0, 1.0), clamp(dot(v, h), 0.0, 1.0), scene.roughness, f0);
    }
    return scene.exposure * (albedo * diffuse + specular);
}

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
    vec3 n = normalize(gl_FrontFacing ? vNormal : -vNormal);
    vec3 v = normalize(scene.eye - vPosition);
    float light = 0.35 + 0.65 * max(dot(n, v), 0.0);
    vec3 c;
    if (kShow == kShowShaded) c = shaded(n, v);
    else if (kShow == kShowNormal) c = 0.5 * normalize(vNormal) + 0.5;
    else if (kShow == kShowHeight) c = light * heightColor(scene.heightReach > 0.0 ? vHeight / scene.heightReach : 0.0);
    else if (kShow == kShowRate) c = light * rateColor(float(vRate));
    else if (kShow == kShowFaces) c = light * faceColor(vFace);
    else if (kShow == kShowWireframe) c = light * vec3(0.80, 0.82, 0.85);
    else c = vec3(0.08, 0.10, 0.14);
    color = vec4(c, 1.0);
}
