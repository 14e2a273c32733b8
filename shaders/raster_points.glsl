// Where a sample lies in the triangle that it is one of. Included after inputs.glsl.
#ifndef RELIEF_RASTER_POINTS_GLSL
#define RELIEF_RASTER_POINTS_GLSL

#include "project.glsl"
#include "raster_samples.glsl"

layout(constant_id = kIdIsMesh) const bool kIsMesh = false;

layout(push_constant, scalar) uniform PushBlock { RasterPush push; };

RELIEF_TABLE(kBindMesh, vec4, meshAt)
RELIEF_TABLE(kBindMeshIndices, uint, meshIndex)
RELIEF_TABLE(kBindFaceTriangles, uint, faceTriangle)
RELIEF_TABLE(kBindSamples, uvec4, samplePair)

// Sample s of a pixel: what raster.glsl's store() has left.
uvec2 sampleOf(uint pixel, uint s) {
    uvec4 two = samplePair(2u * pixel + (s >> 1u));
    return (s & 1u) == 0u ? two.xy : two.zw;
}

vec2 ndcOf(ivec2 pixel, ivec2 placeInPixel256) {
    return (vec2(pixel) + vec2(placeInPixel256) / 256.0) / vec2(inputs.view.pictureSize) * 2.0 - 1.0;
}

// Perspective-correct weights of the corners at a point of the picture, 0..1 each. With corners moved so that the point is the
// origin, weight i is proportional to the area of the others with it: x_j y_k - x_k y_j, of homogeneous coordinates (Olano and
// Greer 1997, section 4). A sample may lie outside by as much as the corners were snapped, or a line is wide: weights are not
// negative.
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

// The corners of a triangle.
struct Corners {
    uint vertices[3];
    vec4 positions[3]; // and heights
    vec3 homogeneous[3]; // x, y and w on the screen
};

Corners cornersOf(uint triangle) {
    Corners c;
    for (uint i = 0u; i < 3u; ++i) {
        c.vertices[i] = meshIndex(3u * triangle + i);
        c.positions[i] = meshAt(2u * c.vertices[i]);
        c.homogeneous[i] = project(c.positions[i].xyz).xyw;
    }
    return c;
}
#endif
