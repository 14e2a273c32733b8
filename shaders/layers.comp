#version 460
#extension GL_GOOGLE_include_directive : require
#include "displaced.glsl"
#include "octahedral.glsl"

// The layers of a picture, one point per pixel. Motion is that of the point of the surface that is seen, evaluated at the same
// (face,u,v) in both frames: triangles may come and go between them.
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = kIdHasMotion) const bool kHasMotion = false;
layout(constant_id = kIdIsMesh) const bool kIsMesh = false; // its faces have no numbers and its points stand still

layout(constant_id = kIdHasInstances) const bool kHasInstances = false;

layout(set = 0, binding = kBindDepths) uniform sampler2D depths;
layout(set = 0, binding = kBindNormals) uniform sampler2D normalsAndTexCoords;
layout(set = 0, binding = kBindColors) uniform sampler2D surfacePoints;
layout(set = 0, binding = kBindInstances) uniform usampler2D instances; // kHasInstances

layout(constant_id = kIdReadsSampleBuffers) const bool kReadsSampleBuffers = false; // else images
RELIEF_TABLE(kBindSamples, uvec4, samplePair)
RELIEF_TABLE(kBindSampleColors, uvec4, sampleWords)
RELIEF_TABLE(kBindSampleInstances, uvec4, sampleInstances)

// What a pixel sees at its centre: what layers.frag, or raster_layers.comp, has written.
struct SeenPoint {
    float depth;
    vec4 normalAndTexCoords;
    vec4 surfacePoint; // w is 0 where nothing is seen
    uint instance;     // kHasInstances
};

SeenPoint seenPoint(ivec2 at, uint pixel) {
    SeenPoint seen;
    if (kReadsSampleBuffers) {
        uvec4 two = samplePair(pixel >> 1u);
        seen.depth = uintBitsToFloat((pixel & 1u) == 0u ? two.y : two.w);
        seen.normalAndTexCoords = uintBitsToFloat(sampleWords(2u * pixel));
        seen.surfacePoint = uintBitsToFloat(sampleWords(2u * pixel + 1u));
        seen.instance = kHasInstances ? sampleInstances(pixel).x : 0u;
        return seen;
    }
    seen.depth = texelFetch(depths, at, 0).r;
    seen.normalAndTexCoords = texelFetch(normalsAndTexCoords, at, 0);
    seen.surfacePoint = texelFetch(surfacePoints, at, 0);
    seen.instance = kHasInstances ? texelFetch(instances, at, 0).x : 0u;
    return seen;
}

vec2 pixelOf(mat4 toClip, vec3 position) {
    vec4 clip = toClip * vec4(position, 1.0);
    return (0.5 * clip.xy / clip.w + 0.5) * vec2(inputs.view.pictureSize);
}

// Motion in pixels of the point (face, uv) from the frame before to this one.
vec2 motionOf(uint face, vec2 uv) {
    vec2 motion = vec2(0);
    SampleLocation location = insideLocation(face, uv);
    for (uint i = 0u; i < 2u; ++i) { // one call: the compiler unfolds every one
#ifdef RELIEF_HEIGHT_FUNCTION
        functionTime = i == 0u ? inputs.model.heightTime : inputs.model.heightTimeBefore;
#endif
        vec3 q = displacedInPose(face, uv, location, i == 0u ? inputs.model.pointsNow : inputs.model.pointsBefore).q;
        if (i == 0u) motion += pixelOf(inputs.view.toClip, q);
        else motion -= pixelOf(inputs.view.toClipBefore, q);
    }
    return motion;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, inputs.view.pictureSize))) return;
    uint pixel = uint(at.y * inputs.view.pictureSize.x + at.x), first = kLayerChannels * pixel;
    SeenPoint point = seenPoint(at, pixel);
    vec4 seen = point.surfacePoint;
    if (kHasInstances) { // each instance has a dispatch of its own
        uint instance = seen.w == 0.0 ? 0u : point.instance;
        if (instance != inputs.view.instance) return;
    }
    for (uint i = 0u; i < kLayerChannels; ++i) inputs.targets.layers.at[first + i] = 0.0;
    inputs.targets.layers.at[first + kLayerDepth] = 1e10;
    inputs.targets.layers.at[first + kLayerFace] = -1.0;
    if (seen.w == 0.0) return;

    vec2 ndc = (vec2(at) + 0.5) / vec2(inputs.view.pictureSize) * 2.0 - 1.0;
    vec4 world = inputs.view.fromClip * vec4(ndc, point.depth, 1.0);
    vec3 position = world.xyz / world.w;
    vec4 other = point.normalAndTexCoords;
    vec3 normal = fromOctahedral(other.xy);
    uint face = uint(seen.w - 1.0);
    inputs.targets.layers.at[first + kLayerDepth] = (inputs.view.toClip * vec4(position, 1.0)).w;
    for (uint i = 0u; i < 3u; ++i) inputs.targets.layers.at[first + kLayerNormal + i] = normal[i];
    inputs.targets.layers.at[first + kLayerFace] = kIsMesh ? 0.0 : float(cageFaceOf(face));
    inputs.targets.layers.at[first + kLayerTexCoords] = other.z;
    inputs.targets.layers.at[first + kLayerTexCoords + 1u] = other.w;
    inputs.targets.layers.at[first + kLayerHeight] = kIsMesh ? 0.0 : seen.z;
    vec2 motion = vec2(at) + 0.5 - pixelOf(inputs.view.toClipBefore, position);
    if (kHasMotion && !kIsMesh) motion = motionOf(face, seen.xy);
    inputs.targets.layers.at[first + kLayerMotion] = motion.x;
    inputs.targets.layers.at[first + kLayerMotion + 1u] = motion.y;
}
