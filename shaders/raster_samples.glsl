// The samples of a pixel that the compute rasterizer makes.
#ifndef RELIEF_RASTER_SAMPLES_GLSL
#define RELIEF_RASTER_SAMPLES_GLSL

#include "rounding.glsl"

const uint kMostSamples = 4u;

// Where sample s of four lies in its pixel, in 1/256 of a pixel (Vulkan, standardSampleLocations).
ivec2 placeInPixel(uint s) { return ivec2(0xA020E060u >> (8u * s) & 255u, 32u + 64u * s); }

// What samples hold in place of normals where colours are made later: the number of a triangle among those of all instances,
// whether it is a line around it that is seen, and whether the triangle shows its front.
uint packId(uint triangle, bool isLine, bool isFront) { return triangle << 2 | (isLine ? 2u : 0u) | (isFront ? 1u : 0u); }
uint triangleOfId(uint id) { return id >> 2; }
bool isLineId(uint id) { return (id & 2u) != 0u; }
bool isFrontId(uint id) { return (id & 1u) != 0u; }

// A color of ten bits per channel that storedColor() has made, and back.
uint packColor(vec3 stored) {
    uvec3 codes = uvec3(kColorCodes * stored + 0.5);
    return codes.r | codes.g << 10 | codes.b << 20;
}
vec3 unpackColor(uint code) { return vec3(code & 1023u, code >> 10 & 1023u, code >> 20 & 1023u) / kColorCodes; }
#endif
