#version 460
#extension GL_GOOGLE_include_directive : require
#include "inputs.glsl"
#include "raster_fragments.glsl"

// Normals and colours of the samples of one instance, which raster_*.comp have left the numbers of their triangles in: what
// surface.frag makes of a fragment is made here of each sample, at the sample.
layout(local_size_x = 8, local_size_y = 8) in;

layout(constant_id = kIdShow) const uint kShow = kShowShaded;
layout(constant_id = kIdHasInstances) const bool kHasInstances = false;

#include "techniques.glsl"

// A whole mesh shows patches of 64 vertices in place of faces, as in mesh.vert.
void setFace(uint triangle, uint vertex) {
    vFace = vertex / 64u;
    vRate = 1u;
    if (kIsMesh || (kShow != kShowFaces && kShow != kShowRate)) return;
    uint face = faceOf(triangle);
    vFace = cageFaceOf(face);
    vRate = max(faceTriangle(2u * face + 1u), 1u);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, inputs.view.pictureSize))) return;
    uint pixel = uint(at.y * inputs.view.pictureSize.x + at.x);
    for (uint s = 0u; s < kMostSamples; ++s) {
        uvec2 one = sampleOf(pixel, s);
        uint triangle = triangleOfId(one.x) - push.firstId;
        if (one.y == 0u || triangle >= push.count) continue; // nothing, or another instance's
        Weighted corners = interpolate(triangle, ndcOf(at, placeInPixel(s)));
        setFace(triangle, corners.vertices[0]);
        vec3 n = fragmentNormal();
        if (!isFrontId(one.x) && kShow != kShowNormal) n = -n;
        uint normal = kShading == kShadingVertexTable ? packPair(vTexCoord.zw) : packNormal(n);
        bool isLine = kShow == kShowWireframe && isLineId(one.x);
        uint color = packColor(storedColor(isLine ? lineColor() : techniqueColor(), kShow == kShowShaded));
        inputs.targets.sampleColors.at[kMostSamples * pixel + s] = uvec2(normal, color);
        if (kHasInstances) inputs.targets.sampleInstances.at[kMostSamples * pixel + s] = inputs.view.instance;
    }
}
