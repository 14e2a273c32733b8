#version 460
#extension GL_GOOGLE_include_directive : require
#include "displaced.glsl"
#include "octahedral.glsl"

// The layers of a picture, one point a pixel. Motion is that of the point of the surface that is seen, evaluated at the same
// (face,u,v) in both frames: triangles may come and go between them.
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = 11) const bool kHasMotion = false;

layout(set = 0, binding = kBindDepths) uniform sampler2D depths;
layout(set = 0, binding = kBindNormals) uniform sampler2D normalsAndTexCoords;
layout(set = 0, binding = kBindColors) uniform sampler2D surfacePoints;

vec2 pixelOf(mat4 toClip, vec3 position) {
    vec4 clip = toClip * vec4(position, 1.0);
    return (0.5 * clip.xy / clip.w + 0.5) * vec2(scene.pictureSize);
}

vec2 motionOf(uint face, vec2 uv) {
    vec2 motion = vec2(0);
    SampleLocation location = insideLocation(face, uv);
    for (uint i = 0u; i < 2u; ++i) {
        pose = i == 0u ? scene.pointsNow : scene.pointsBefore;
        vec3 q = displaced(face, uv, location).q;
        if (i == 0u) motion += pixelOf(scene.worldToClip, q);
        else motion -= pixelOf(scene.worldToClipBefore, q);
    }
    return motion;
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, scene.pictureSize))) return;
    uint first = kLayerChannels * uint(at.y * scene.pictureSize.x + at.x);
    vec4 seen = texelFetch(surfacePoints, at, 0);
    for (uint i = 0u; i < kLayerChannels; ++i) scene.layerTarget.at[first + i] = 0.0;
    scene.layerTarget.at[first + kLayerDepth] = 1e10;
    scene.layerTarget.at[first + kLayerFace] = -1.0;
    if (seen.w == 0.0) return;

    vec2 ndc = (vec2(at) + 0.5) / vec2(scene.pictureSize) * 2.0 - 1.0;
    vec4 world = scene.clipToWorld * vec4(ndc, texelFetch(depths, at, 0).r, 1.0);
    vec3 position = world.xyz / world.w;
    vec4 other = texelFetch(normalsAndTexCoords, at, 0);
    vec3 normal = fromOctahedral(other.xy);
    uint face = uint(seen.w - 1.0);
    bool isDense = passRows != 0u; // its faces have no numbers and its points stand still
    scene.layerTarget.at[first + kLayerDepth] = (scene.worldToClip * vec4(position, 1.0)).w;
    for (uint i = 0u; i < 3u; ++i) scene.layerTarget.at[first + kLayerNormal + i] = normal[i];
    scene.layerTarget.at[first + kLayerFace] = isDense ? 0.0 : float(cageFaceOf(face));
    scene.layerTarget.at[first + kLayerTexCoords] = other.z;
    scene.layerTarget.at[first + kLayerTexCoords + 1u] = other.w;
    scene.layerTarget.at[first + kLayerHeight] = isDense ? 0.0 : seen.z;
    vec2 motion = vec2(at) + 0.5 - pixelOf(scene.worldToClipBefore, position);
    if (kHasMotion && !isDense) motion = motionOf(face, seen.xy);
    scene.layerTarget.at[first + kLayerMotion] = motion.x;
    scene.layerTarget.at[first + kLayerMotion + 1u] = motion.y;
}
