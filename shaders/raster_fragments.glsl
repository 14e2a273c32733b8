// What a sample of a triangle is made of: the varyings at any point of it, in place of what the fixed function hands to fragments.
// Included after inputs.glsl.
#ifndef RELIEF_RASTER_FRAGMENTS_GLSL
#define RELIEF_RASTER_FRAGMENTS_GLSL

#define RELIEF_LOCATION(i)
#define RELIEF_FLAT
#define RELIEF_VARYING
#define RELIEF_OWN_DERIVATIVES
#include "varyings.glsl"
#include "detail.glsl"
#include "octahedral.glsl"
#include "rounding.glsl"
#include "raster_samples.glsl"

layout(constant_id = kIdHasTexCoords) const bool kHasTexCoords = false;
layout(constant_id = kIdWantsTexCoords) const bool kWantsTexCoords = false;
layout(constant_id = kIdIsMesh) const bool kIsMesh = false;

layout(push_constant, scalar) uniform PushBlock { RasterPush push; };

RELIEF_TABLE(kBindMesh, vec4, meshAt)
RELIEF_TABLE(kBindMeshIndices, uint, meshIndex)
RELIEF_TABLE(kBindMeshTexCoords, vec2, meshTexCoords)
RELIEF_TABLE(kBindMeshTexGradients, vec4, meshTexGradients)
RELIEF_TABLE(kBindFaceTriangles, uint, faceTriangle)
RELIEF_TABLE(kBindSamples, uvec4, samplePair)

// Perspective-correct weights of the corners at a point of the picture, 0..1 each. With corners moved so that the point is the
// origin, weight i is proportional to the area of the others with it: x_j y_k - x_k y_j, of homogeneous coordinates (Olano and
// Greer 1997, section 4). A sample may lie outside by as much as the corners were snapped: weights are not negative.
vec3 weightsAt(vec3 corners[3], vec2 ndc) {
    vec2 a = corners[0].xy - ndc * corners[0].z, b = corners[1].xy - ndc * corners[1].z, c = corners[2].xy - ndc * corners[2].z;
    vec3 areas = vec3(b.x * c.y - c.x * b.y, c.x * a.y - a.x * c.y, a.x * b.y - b.x * a.y);
    float sum = areas.x + areas.y + areas.z;
    if (sum == 0.0) return vec3(1.0 / 3.0);
    vec3 weights = max(areas / sum, vec3(0));
    return weights / (weights.x + weights.y + weights.z);
}

// The face of a diced mesh that a triangle belongs to.
uint faceOf(uint triangle) {
    uint low = 0u, high = push.faceCount; // the first triangle of face `low` is not after it, that of `high` is
    while (low + 1u < high) {
        uint middle = (low + high) / 2u;
        if (faceTriangle(2u * middle) <= triangle) low = middle;
        else high = middle;
    }
    return low;
}

// The corners of a triangle, and their weights at a point.
struct Weighted {
    uint vertices[3];
    vec3 weights;
};

// Sets the varyings to what they are at a point of a triangle; those of faces are set by who wants them.
Weighted interpolate(uint triangle, vec2 ndc) {
    uint vertices[3];
    vec3 corners[3];
    vec4 positions[3];
    for (uint i = 0u; i < 3u; ++i) {
        vertices[i] = meshIndex(3u * triangle + i);
        positions[i] = meshAt(2u * vertices[i]);
        corners[i] = project(positions[i].xyz).xyw;
    }
    vec2 pixel = 2.0 / vec2(inputs.view.pictureSize);
    vec3 w = weightsAt(corners, ndc);
    vec3 right = weightsAt(corners, ndc + vec2(pixel.x, 0.0)), below = weightsAt(corners, ndc + vec2(0.0, pixel.y));
    vNormal = vec3(0);
    vTexCoord = vGradientS = vGradientT = vec4(0);
    vHeight = 0.0;
    stepX = stepY = vec2(0);
    for (uint i = 0u; i < 3u; ++i) {
        uint vertex = vertices[i];
        vNormal += w[i] * worldNormal(meshAt(2u * vertex + 1u).xyz);
        vHeight += w[i] * positions[i].w;
        if (kHasTexCoords && kWantsTexCoords) {
            vec2 st = meshTexCoords(vertex);
            vTexCoord.xy += w[i] * st;
            stepX += (right[i] - w[i]) * st;
            stepY += (below[i] - w[i]) * st;
        }
        if (kHasTexGradients) {
            vGradientS += w[i] * worldGradient(meshTexGradients(kGradientTexels * vertex));
            vGradientT += w[i] * worldGradient(meshTexGradients(kGradientTexels * vertex + 1u));
        }
    }
    return Weighted(vertices, w);
}
#endif
