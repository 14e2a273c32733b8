// What a sample is made of: the varyings at any point of its triangle, in place of what the fixed function hands to fragments.
// Included after inputs.glsl.
#ifndef RELIEF_RASTER_FRAGMENTS_GLSL
#define RELIEF_RASTER_FRAGMENTS_GLSL

layout(constant_id = kIdHasTexCoords) const bool kHasTexCoords = false;
layout(constant_id = kIdWantsTexCoords) const bool kWantsTexCoords = false;

#define RELIEF_LOCATION(i)
#define RELIEF_FLAT
#define RELIEF_VARYING
#define RELIEF_OWN_DERIVATIVES
#include "varyings.glsl"
#include "detail.glsl"
#include "octahedral.glsl"
#include "rounding.glsl"
#include "raster_points.glsl"
#include "vertex_table.glsl"

RELIEF_TABLE(kBindMeshTexCoords, vec2, meshTexCoords)
RELIEF_TABLE(kBindMeshTexGradients, vec4, meshTexGradients)

// The corners of a triangle, and their weights at a point.
struct Weighted {
    uint vertices[3];
    vec3 weights;
};

void clearVaryings() {
    vNormal = vec3(0);
    vTexCoord = vGradientS = vGradientT = vec4(0);
    vHeight = 0.0;
    stepX = stepY = vec2(0);
#ifdef RELIEF_HEIGHT_FUNCTION
    vRest = restStepX = restStepY = vec3(0);
    vRestGradient = mat3(0);
#endif
}

// Adds what a vertex carries for fragments that bend normals, by its weight at the point and how that changes from pixel to pixel.
void addGradients(uint vertex, float weight, float right, float below) {
#ifdef RELIEF_HEIGHT_FUNCTION
    uint first = (kHasSlopes ? kRestGradientTexels : kGradientTexels) * vertex;
#else
    uint first = kGradientTexels * vertex;
#endif
    vGradientS += weight * worldGradient(meshTexGradients(first));
    vGradientT += weight * worldGradient(meshTexGradients(first + 1u));
#ifdef RELIEF_HEIGHT_FUNCTION
    if (!kHasSlopes) return;
    vec4 columns[3];
    for (uint i = 0u; i < 3u; ++i) columns[i] = meshTexGradients(first + kGradientTexels + i);
    vec3 rest = vec3(columns[0].w, columns[1].w, columns[2].w);
    vRest += weight * rest;
    restStepX += right * rest;
    restStepY += below * rest;
    vRestGradient += weight * worldGradients(mat3(columns[0].xyz, columns[1].xyz, columns[2].xyz));
#endif
}

// Sets the varyings to what they are at a point of a triangle; those of faces are set by who wants them.
Weighted interpolate(uint triangle, vec2 ndc) {
    Corners corners = cornersOf(triangle);
    vec2 pixel = 2.0 / vec2(inputs.view.pictureSize);
    vec3 w = weightsAt(corners.homogeneous, ndc);
    vec3 right = weightsAt(corners.homogeneous, ndc + vec2(pixel.x, 0.0)) - w;
    vec3 below = weightsAt(corners.homogeneous, ndc + vec2(0.0, pixel.y)) - w;
    clearVaryings();
    for (uint i = 0u; i < 3u; ++i) {
        uint vertex = corners.vertices[i];
        vec3 n = worldNormal(meshAt(2u * vertex + 1u).xyz);
        vNormal += w[i] * n;
        vHeight += w[i] * corners.positions[i].w;
        if (kHasTexCoords && kWantsTexCoords) {
            vec2 st = meshTexCoords(vertex);
            vTexCoord.xy += w[i] * st;
            stepX += right[i] * st;
            stepY += below[i] * st;
        }
        if (kShading == kShadingVertexTable) vTexCoord.zw += w[i] * tableCoordinates(n, corners.positions[i].xyz);
        if (kHasTexGradients) addGradients(vertex, w[i], right[i], below[i]);
    }
    return Weighted(corners.vertices, w);
}
#endif
