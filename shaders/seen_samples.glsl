// The samples of a picture that surface.frag or raster_*.comp left, as the passes over pixels read them.
#ifndef RELIEF_SEEN_SAMPLES_GLSL
#define RELIEF_SEEN_SAMPLES_GLSL

#include "octahedral.glsl"
#include "raster_samples.glsl"
#include "rounding.glsl"

layout(constant_id = kIdShow) const uint kShow = kShowShaded;
layout(constant_id = kIdHasInstances) const bool kHasInstances = false;
layout(constant_id = kIdReadsSampleBuffers) const bool kReadsSampleBuffers = false; // else images
layout(constant_id = kIdHasSampleColors) const bool kHasSampleColors = false;       // else all are the material's
layout(constant_id = kIdShading) const uint kShading = kShadingPhysical;

layout(set = 0, binding = kBindDepths) uniform sampler2DMS depthSamples;
layout(set = 0, binding = kBindNormals) uniform sampler2DMS normalSamples;
layout(set = 0, binding = kBindColors) uniform sampler2DMS colorSamples;
layout(set = 0, binding = kBindInstances) uniform usampler2DMS instanceSamples; // kHasInstances
RELIEF_TABLE(kBindSamples, uvec4, samplePair)
RELIEF_TABLE(kBindSampleColors, uvec4, sampleColors)
RELIEF_TABLE(kBindSampleInstances, uvec4, sampleInstances)

// One of a pixel's samples.
struct Seen {
    float depth; // 0 where nothing is seen
    vec3 normal; // kShadingVertexTable: n.l and v.r in its place
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
        vec3 held = kShading == kShadingVertexTable ? vec3(unpackPair(one.x), 0.0) : unpackNormal(one.x);
        return Seen(depth, held, colorOfStored(stored, isLight));
    }
    vec2 stored = texelFetch(normalSamples, at, i).xy;
    vec3 normal = kShading == kShadingVertexTable ? vec3(stored, 0.0) : fromOctahedral(stored);
    return Seen(texelFetch(depthSamples, at, i).r, normal, colorOfStored(texelFetch(colorSamples, at, i).rgb, isLight));
}

// The number of the instance at a sample, of those that see one.
uint instanceAt(ivec2 at, int i) {
    if (kReadsSampleBuffers) return sampleInstances(uint(at.y * inputs.view.pictureSize.x + at.x))[i];
    return texelFetch(instanceSamples, at, i).x;
}
#endif
