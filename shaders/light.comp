#version 460
#extension GL_GOOGLE_include_directive : require
#include "inputs.glsl"
#include "seen_samples.glsl"

// Light on the samples that surface.frag left: once per pixel inside the surface, once per sample where its depth jumps.
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = kIdAddsLight) const bool kAddsLight = false; // of one more key light, to the picture
layout(constant_id = kIdHasOcclusion) const bool kHasOcclusion = false;

#include "environment.glsl"
#include "key_visibility.glsl"

vec3 positionOf(vec2 ndc, float depth) {
    vec4 world = inputs.view.fromClip * vec4(ndc, depth, 1.0);
    return world.xyz / world.w;
}

// The share of the environment that is seen past the surface around, smoothed over the 4 x 4 pixels that occlusion.comp
// gives directions of their own; pixels of other depths do not count.
float openness(float depth) {
    if (!kHasOcclusion) return 1.0;
    ivec2 at = ivec2(gl_GlobalInvocationID.xy), size = inputs.view.pictureSize;
    float sum = 0.0, weights = 0.0;
    for (int i = 0; i < 16; ++i) {
        ivec2 beside = clamp(at + ivec2(i & 3, i >> 2) - 2, ivec2(0), size - 1);
        vec2 there = vec2(inputs.targets.occlusion.at[2 * (beside.y * size.x + beside.x)],
                          inputs.targets.occlusion.at[2 * (beside.y * size.x + beside.x) + 1]);
        float weight = max(1.0 - 50.0 * abs(there.y / depth - 1.0), 0.0) + 1e-4;
        sum += weight * there.x;
        weights += weight;
    }
    return sum / weights;
}

#include "conserving.glsl"
#include "phong.glsl"
#include "water.glsl"

// GGX with Smith's height-correlated masking (Heitz 2014) and Schlick's Fresnel, times n.l.
float keySpecular(float nl, float nv, float nh, float vh, float roughness, float f0) {
    float a2 = roughness * roughness * roughness * roughness, x = 1.0 - vh;
    float d = (nh * a2 - nh) * nh + 1.0;
    float distribution = a2 / (kPi * d * d);
    float visibility = 0.5 / max(1e-5, nl * sqrt(nv * nv * (1.0 - a2) + a2) + nv * sqrt(nl * nl * (1.0 - a2) + a2));
    float fresnel = f0 + (1.0 - f0) * x * x * x * x * x;
    return distribution * visibility * fresnel * nl;
}

vec3 shaded(vec3 position, vec3 n, vec3 v, vec3 albedo, Material material, float open) {
    const float f0 = 0.04; // a dielectric of index 1.5
    float nv = max(dot(n, v), 1e-4);

    vec3 diffuse = vec3(0), specular = vec3(0);
    if (!kAddsLight) {
        diffuse = irradiance(n) / kPi;
        vec3 mirrored = reflect(-v, n);
        // Directions below the surface see the surface: fade what they would reflect.
        float horizon = clamp(1.0 + 1.5 * dot(mirrored, n), 0.0, 1.0);
        vec3 around = textureLod(environmentMap, equirectangular(mirrored), material.environmentLevel).rgb;
        specular = around * environmentBrdf(vec3(f0), material.roughness, nv) * horizon;
        if (kHasOcclusion) {
            diffuse *= open;
            specular *= specularOpenness(open, nv, material.roughness);
        }
    }

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
    vec3 position = positionOf(ndc, depth);
    vec3 v = normalize(inputs.view.eye - position);
    if (kShow != kShowShaded) return color * (0.35 + 0.65 * max(dot(n, v), 0.0));
    if (kShading == kShadingConserving) return conserving(position, n, v, color, material, openness(depth));
    if (kShading == kShadingPhong || kShading == kShadingTable || kShading == kShadingVertexTable)
        return phong(position, n, v, color);
    if (kShading == kShadingWater) return water(position, n, v, color, material);
    if (kShading == kShadingMatcap) return color * matcap(n, v);
    return shaded(position, n, v, color, material, openness(depth));
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
        bool isOneSurface =
            highest - lowest < 0.02 * highest && dot(normal, normal) > 12.0 && kShading != kShadingVertexTable;
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
            if (depth > 0.0) sum += vec4(seen(ndc, depth, kShading == kShadingVertexTable ? n : normalize(n), color, materialAt(at, i)), 1.0);
        }
        sum /= float(count);
    }
    if (kAddsLight) {
        uvec2 before = inputs.targets.picture.at[at.y * inputs.view.pictureSize.x + at.x];
        vec2 blueAndAlpha = unpackHalf2x16(before.y);
        sum = vec4(sum.rgb + vec3(unpackHalf2x16(before.x), blueAndAlpha.x), blueAndAlpha.y);
    }
    sum.rgb = min(sum.rgb, vec3(65504.0)); // the largest half float: brighter light is white, not infinite
    inputs.targets.picture.at[at.y * inputs.view.pictureSize.x + at.x] = uvec2(packHalves(sum.rg), packHalves(sum.ba));
}
