#version 460
#extension GL_GOOGLE_include_directive : require
#include "inputs.glsl"
#include "octahedral.glsl"
#include "raster_samples.glsl"
#include "rounding.glsl"

// Light on the samples that surface.frag left: once per pixel inside the surface, once per sample where its depth jumps.
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = kIdShow) const uint kShow = kShowShaded;
layout(constant_id = kIdHasInstances) const bool kHasInstances = false;
layout(constant_id = kIdReadsSampleBuffers) const bool kReadsSampleBuffers = false; // else images
layout(constant_id = kIdReadsShadowCodes) const bool kReadsShadowCodes = false;     // else an image
layout(constant_id = kIdHasSampleColors) const bool kHasSampleColors = false;       // else all are the material's

layout(set = 0, binding = kBindEnvironment) uniform sampler2D environmentMap; // equirectangular
layout(set = 0, binding = kBindShadow) uniform sampler2D shadowMap;           // reversed depth from the key light
layout(set = 0, binding = kBindDepths) uniform sampler2DMS depthSamples;
layout(set = 0, binding = kBindNormals) uniform sampler2DMS normalSamples;
layout(set = 0, binding = kBindColors) uniform sampler2DMS colorSamples;
layout(set = 0, binding = kBindInstances) uniform usampler2DMS instanceSamples; // kHasInstances
RELIEF_TABLE(kBindSamples, uvec4, samplePair)
RELIEF_TABLE(kBindSampleColors, uvec4, sampleColors)
RELIEF_TABLE(kBindSampleInstances, uvec4, sampleInstances)
RELIEF_TABLE(kBindShadowCodes, uint, shadowCode)

const float kPi = 3.14159265;

// Ramamoorthi and Hanrahan (2001), eq. 13, with the cosine lobe and basis constants folded into the coefficients.
vec3 irradiance(vec3 n) {
    return max(vec3(0), inputs.light.irradiance[0] + inputs.light.irradiance[1] * n.y + inputs.light.irradiance[2] * n.z +
                            inputs.light.irradiance[3] * n.x + inputs.light.irradiance[4] * (n.x * n.y) +
                            inputs.light.irradiance[5] * (n.y * n.z) + inputs.light.irradiance[6] * (3.0 * n.z * n.z - 1.0) +
                            inputs.light.irradiance[7] * (n.x * n.z) + inputs.light.irradiance[8] * (n.x * n.x - n.y * n.y));
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
    float a2 = roughness * roughness * roughness * roughness, x = 1.0 - vh;
    float d = (nh * a2 - nh) * nh + 1.0;
    float distribution = a2 / (kPi * d * d);
    float visibility = 0.5 / max(1e-5, nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
    float fresnel = f0 + (1.0 - f0) * x * x * x * x * x;
    return distribution * visibility * fresnel * nl;
}

// The depth of what the key light meets first, at a place in the shadow map of 0..1 each way.
float shadowDepth(vec2 at) {
    if (!kReadsShadowCodes) return textureLod(shadowMap, at, 0.0).r;
    ivec2 texel = clamp(ivec2(floor(at * float(inputs.light.shadowSide))), 0, int(inputs.light.shadowSide) - 1);
    return float(shadowCode(uint(texel.y) * inputs.light.shadowSide + uint(texel.x))) / kShadowCodes;
}

// Share of the key light that arrives: eight samples of the shadow map on a spiral, turned from pixel to pixel by interleaved
// gradient noise (Jimenez, "Next Generation Post Processing in Call of Duty: Advanced Warfare", 2014).
float keyVisibility(vec3 position, vec3 n) {
    if (inputs.light.hasShadows == 0.0) return 1.0;
    // The radius of the disc is shadowSoftness; at its rim a tilted surface lies as much deeper as the sine of its tilt.
    float tilt = length(cross(n, inputs.light.keyDirection));
    vec4 clip = inputs.light.toShadow * vec4(position + n * inputs.light.shadowBias * (0.5 + 2.0 * tilt), 1.0);
    float angle = 2.0 * kPi * fract(52.9829189 * fract(dot(vec2(gl_GlobalInvocationID.xy), vec2(0.06711056, 0.00583715))));
    vec2 spoke = inputs.light.shadowSoftness * vec2(cos(angle), sin(angle));
    const mat2 goldenTurn = mat2(-0.737369, 0.675490, -0.675490, -0.737369);
    float lit = 0.0;
    for (int i = 0; i < 8; ++i) {
        vec2 at = clip.xy * 0.5 + 0.5 + spoke * sqrt((float(i) + 0.5) * 0.125);
        lit += shadowDepth(at) <= clip.z ? 0.125 : 0.0;
        spoke = goldenTurn * spoke;
    }
    return lit;
}

vec3 shaded(vec3 position, vec3 n, vec3 v, vec3 albedo, Material material) {
    const float f0 = 0.04; // a dielectric of index 1.5
    float nv = max(dot(n, v), 1e-4);

    vec3 diffuse = irradiance(n) / kPi;
    vec3 mirrored = reflect(-v, n);
    // Directions below the surface see the surface: fade what they would reflect.
    float horizon = clamp(1.0 + 1.5 * dot(mirrored, n), 0.0, 1.0);
    vec3 around = textureLod(environmentMap, equirectangular(mirrored), material.environmentLevel).rgb;
    vec3 specular = around * environmentBrdf(vec3(f0), material.roughness, nv) * horizon;

    vec3 l = inputs.light.keyDirection, h = normalize(l + v);
    float nl = dot(n, l);
    if (nl > 0.0) {
        vec3 arriving = inputs.light.keyRadiance * keyVisibility(position, n);
        diffuse += arriving * nl / kPi;
        specular += arriving * keySpecular(nl, nv, clamp(dot(n, h), 0.0, 1.0), clamp(dot(v, h), 0.0, 1.0), material.roughness,
                                           f0);
    }
    return albedo * diffuse + specular;
}

vec3 seen(vec2 ndc, float depth, vec3 n, vec3 color, Material material) {
    if (kShow == kShowNormal) return 0.5 * n + 0.5;
    vec4 world = inputs.view.fromClip * vec4(ndc, depth, 1.0);
    vec3 position = world.xyz / world.w;
    vec3 v = normalize(inputs.view.eye - position);
    if (kShow == kShowShaded) return shaded(position, n, v, color, material);
    return color * (0.35 + 0.65 * max(dot(n, v), 0.0));
}

// One of a pixel's samples.
struct Seen {
    float depth; // 0 where nothing is seen
    vec3 normal;
    vec3 color;
};

Seen seenAt(ivec2 at, int i) {
    bool isLight = kShow == kShowShaded;
    if (kReadsSampleBuffers) {
        uint pixel = uint(at.y * inputs.view.pictureSize.x + at.x);
        uvec4 two = samplePair(2u * pixel + uint(i >> 1));
        uvec2 one = (i & 1) == 0 ? two.xy : two.zw;
        float depth = uintBitsToFloat(one.y);
        vec3 stored = storedColor(inputs.material.albedo, isLight);
        if (kHasSampleColors) { // those of raster_resolve.comp, in place of the numbers of triangles
            two = sampleColors(2u * pixel + uint(i >> 1));
            one = (i & 1) == 0 ? two.xy : two.zw;
            stored = unpackColor(one.y);
        }
        return Seen(depth, unpackNormal(one.x), colorOfStored(stored, isLight));
    }
    return Seen(texelFetch(depthSamples, at, i).r, fromOctahedral(texelFetch(normalSamples, at, i).xy),
                colorOfStored(texelFetch(colorSamples, at, i).rgb, isLight));
}

// The number of the instance at a sample, of those that see one.
uint instanceAt(ivec2 at, int i) {
    if (kReadsSampleBuffers) return sampleInstances(uint(at.y * inputs.view.pictureSize.x + at.x))[i];
    return texelFetch(instanceSamples, at, i).x;
}

// The material at a sample: that of the inputs where the picture has one instance alone.
Material materialAt(ivec2 at, int i) {
    if (!kHasInstances) return inputs.material;
    return inputs.targets.materials.at[instanceAt(at, i)];
}

// No arrays here: indexing them would make compilers unroll the loops around all of shaded().
void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, inputs.view.pictureSize))) return;
    float lowest = 1.0, highest = 0.0;
    vec3 normal = vec3(0), color = vec3(0);
    for (int i = 0; i < 4; ++i) {
        Seen one = seenAt(at, i);
        lowest = min(lowest, one.depth);
        highest = max(highest, one.depth);
        normal += one.normal;
        color += 0.25 * one.color;
    }
    vec4 sum = vec4(0);
    if (highest > 0.0) {
        vec2 ndc = (vec2(at) + 0.5) / vec2(inputs.view.pictureSize) * 2.0 - 1.0;
        // One surface: depths within 2 %, and the sum of four unit normals longer than sqrt(12), which is less than about
        // 30 degrees from their mean each.
        bool isOneSurface = highest - lowest < 0.02 * highest && dot(normal, normal) > 12.0;
        if (kHasInstances) {
            uint first = instanceAt(at, 0);
            for (int i = 1; i < 4; ++i) isOneSurface = isOneSurface && instanceAt(at, i) == first;
        }
        int count = isOneSurface ? 1 : 4;
        float depth = 0.5 * (lowest + highest);
        vec3 n = normal;
        for (int i = 0; i < count; ++i) {
            if (!isOneSurface) {
                Seen one = seenAt(at, i);
                depth = one.depth;
                n = one.normal;
                color = one.color;
            }
            if (depth > 0.0) sum += vec4(seen(ndc, depth, normalize(n), color, materialAt(at, i)), 1.0);
        }
        sum /= float(count);
    }
    sum.rgb = min(sum.rgb, vec3(65504.0)); // the largest half float: brighter light is white, not infinite
    inputs.targets.picture.at[at.y * inputs.view.pictureSize.x + at.x] = uvec2(packHalves(sum.rg), packHalves(sum.ba));
}
