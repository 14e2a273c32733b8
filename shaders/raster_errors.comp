#version 460
#extension GL_GOOGLE_include_directive : require
#include "displaced.glsl"
#include "raster_faces.glsl"
#include "raster_points.glsl"
#define RELIEF_LOCATION(i)
#define RELIEF_FLAT
#define RELIEF_VARYING
#include "varyings.glsl"
#define RELIEF_OWN_DERIVATIVES
layout(constant_id = kIdShow) const uint kShow = kShowError;
#include "techniques.glsl"
#include "octahedral.glsl"
#include "errors.glsl"

// Colours of how far samples of one instance are from the surface, and their normals: what errors.frag makes of fragments.
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = kIdHasInstances) const bool kHasInstances = false;

float signedError(uint triangle, vec3 weights, Corners corners, vec2 ndc, float depth) {
    if (kIsMesh) return 0.0;
    uint face = faceOf(triangle);
    fetchDicedFace(face);
    vec2 uv = vec2(0);
    vec3 point = vec3(0);
    for (uint i = 0u; i < 3u; ++i) {
        uv += weights[i] * dicedPoint(corners.vertices[i]);
        point += weights[i] * corners.positions[i].xyz;
    }
    return signedDistance(face, uv, point) / pixelWidth(ndc, depth);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, inputs.view.pictureSize))) return;
    uint pixel = uint(at.y * inputs.view.pictureSize.x + at.x);
    for (uint s = 0u; s < kMostSamples; ++s) {
        uvec2 one = sampleOf(pixel, s);
        uint triangle = triangleOfId(one.x) - push.firstId;
        if (one.y == 0u || triangle >= push.count) continue; // nothing, or another instance's
        Corners corners = cornersOf(triangle);
        vec2 ndc = ndcOf(at, placeInPixel(s));
        vec3 weights = weightsAt(corners.homogeneous, ndc), n = vec3(0);
        for (uint i = 0u; i < 3u; ++i) n += weights[i] * worldNormal(meshAt(2u * corners.vertices[i] + 1u).xyz);
        float error = signedError(triangle, weights, corners, ndc, uintBitsToFloat(one.y));
        inputs.targets.sampleColors.at[kMostSamples * pixel + s] =
            uvec2(packNormal(isFrontId(one.x) ? n : -n), packColor(storedColor(heightColor(error), false)));
        if (kHasInstances) inputs.targets.sampleInstances.at[kMostSamples * pixel + s] = inputs.view.instance;
    }
}
