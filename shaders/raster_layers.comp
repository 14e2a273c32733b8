#version 460
#extension GL_GOOGLE_include_directive : require
#include "raster_faces.glsl"
#include "raster_fragments.glsl"

// Which point of the surface each pixel sees at its centre, of those that see one instance: what layers.frag makes of fragments, of
// pixels that raster_*.comp have left the numbers of their triangles in. What layers.comp reads takes the place of colours.
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = kIdHasInstances) const bool kHasInstances = false;

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, inputs.view.pictureSize))) return;
    uint pixel = uint(at.y * inputs.view.pictureSize.x + at.x), first = kMostSamples * pixel;
    uvec4 two = samplePair(pixel >> 1u);
    uvec2 one = (pixel & 1u) == 0u ? two.xy : two.zw;
    if (one.y == 0u) { // nothing is seen: no face
        if (push.firstId == 0u) inputs.targets.sampleColors.at[first + 3u] = uvec2(0);
        return;
    }
    uint triangle = triangleOfId(one.x) - push.firstId;
    if (triangle >= push.count) return; // another instance's
    Weighted corners = interpolate(triangle, ndcOf(at, ivec2(128)));
    uint face = 0u;
    vec2 uv = vec2(0);
    if (!kIsMesh) {
        face = faceOf(triangle);
        fetchDicedFace(face);
        for (uint i = 0u; i < 3u; ++i) uv += corners.weights[i] * dicedPoint(corners.vertices[i]);
        if (!kHasTexCoords) vTexCoord.xy = uv;
    }
    vec3 n = fragmentNormal();
    if (!isFrontId(one.x)) n = -n;
    inputs.targets.sampleColors.at[first] = floatBitsToUint(octahedral(n));
    inputs.targets.sampleColors.at[first + 1u] = floatBitsToUint(vTexCoord.xy);
    inputs.targets.sampleColors.at[first + 2u] = floatBitsToUint(uv);
    inputs.targets.sampleColors.at[first + 3u] = floatBitsToUint(vec2(vHeight, float(face) + 1.0));
    if (kHasInstances) inputs.targets.sampleInstances.at[first] = inputs.view.instance;
}
