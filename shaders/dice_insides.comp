#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "dice.glsl"

// The samples inside faces, one workgroup per tile.
layout(local_size_x_id = kIdGroupSize) in;

#ifdef RELIEF_TRIANGLES
#include "displaced.glsl"
#else
#ifndef RELIEF_STORAGE_TABLES
#define RELIEF_ONE_FACE
#endif
#include "dice_tile.glsl"
#endif
#include "dice_store.glsl"

vec2 insidePoint(InsideTile tile, uvec2 ij) {
    uvec2 segments = halvesOf(tile.segments);
    if (inputs.rates.isFractional == 0u) return vec2(ij) / vec2(segments);
    Face record = fetchFace(tile.face);
    float rates[kSideCount];
    for (uint side = 0u; side < kSideCount; ++side) rates[side] = sideRate(record.sides[side]).rate;
    return fractionalPoint(ij.x, ij.y, segments, rates);
}

#ifdef RELIEF_TRIANGLES

// Number of inner sample (i,j) of a triangle with n segments per side: rows of n - 2, n - 3, ... samples.
uint insideIndex(uvec2 ij, uint n) { return (ij.y - 1u) * (n - 2u) - (ij.y - 1u) * (ij.y - 2u) / 2u + ij.x - 1u; }

void main() {
    InsideTile tile = fetchInsideTile(gl_WorkGroupID.x + push.first);
    uvec2 first = halvesOf(tile.firstIJ), size = halvesOf(tile.sizeIJ);
    uint n = halvesOf(tile.segments).x;
    for (uint k = gl_LocalInvocationID.x; k < size.x * size.y; k += gl_WorkGroupSize.x) {
        uvec2 ij = first + divided(k, size.x).yx;
        if (ij.x + ij.y >= n) continue;
        vec2 uv = insidePoint(tile, ij);
        DisplacedSample s = displaced(tile.face, uv, insideLocation(tile.face, uv));
        storeVertex(tile.firstVertex + insideIndex(ij, n), s);
    }
}

#else

// Not for SwiftShader, which reads tables from storage buffers and takes minutes to compile this.
#ifndef RELIEF_STORAGE_TABLES

// Rates along u and v that samples inside a face are spaced by.
vec2 ratesInside(uint face) {
    Face record = fetchFace(face);
    float rates[kSideCount];
    for (uint side = 0u; side < kSideCount; ++side) rates[side] = sideRate(record.sides[side]).rate;
    return vec2(max(rates[0], rates[2]), max(rates[1], rates[3]));
}

// The coordinate of row or column k of n segments; `rate`: that of the sides along it.
float insideCoordinate(uint k, uint n, float rate) {
    return inputs.rates.isFractional == 0u ? float(k) / float(n) : sampleParameter(k, n, rate);
}

CurveWeights byFaceWeights(CurveWeights c, float k) { return CurveWeights(c.w, k * c.d, k * k * c.dd); }

// The samples of a bicubic patch, column by column: what depends on u alone is evaluated once for all of its samples.
void diceColumns(InsideTile tile, PatchPoints patchPoints) {
    uvec2 first = halvesOf(tile.firstIJ), size = halvesOf(tile.sizeIJ), segments = halvesOf(tile.segments);
    float scale = float(1u << tile.depth);
    vec2 origin = vec2(halvesOf(tile.origin));
    bool hasTexture = readsTexCoords(), hasRest = readsRest();
    vec2 rates = ratesInside(tile.face);
    vec4 levels = kHasMips ? levelsAt(inputs.rates.firstFaceLevel + tile.face) : vec4(0);
    uint surfaceBoundary = patchPoints.surface.boundary, textureBoundary = patchPoints.texture.boundary;
    ControlPoints restPoints = inPose(patchPoints.surface, inputs.model.pointsRest);
    vec4 surfaceOrigin = originOf(patchPoints.surface), restOrigin = hasRest ? originOf(restPoints) : vec4(0);
    for (uint start = 0u; start < size.x;) {
        uint left = size.x - start, width = gl_WorkGroupSize.x;
        while (4u * left < 3u * width) width >>= 1;
        uint row = gl_LocalInvocationID.x / width, i = start + (gl_LocalInvocationID.x & (width - 1u));
        uint stride = gl_WorkGroupSize.x / width;
        start += width;
        float u = insideCoordinate(first.x + i, segments.x, rates.x), leafU = scale * u - origin.x;
        CurveWeights curve = splineWeights(leafU);
        CurveWeights uw = byFaceWeights(atBoundary(curve, (surfaceBoundary & 8u) != 0u, (surfaceBoundary & 2u) != 0u), scale);
        RowSums rows[4], restRows[4];
        TexRowSums texRows[4];
        [[unroll]] for (uint r = 0u; r < 4u; ++r) rows[r] = sumRow(patchPoints.surface, r, uw, surfaceOrigin);
        if (hasRest) {
            [[unroll]] for (uint r = 0u; r < 4u; ++r) restRows[r] = sumRow(restPoints, r, uw, restOrigin);
        }
        if (hasTexture) {
            CurveWeights tw = byFaceWeights(atBoundary(curve, (textureBoundary & 8u) != 0u, (textureBoundary & 2u) != 0u), scale);
            [[unroll]] for (uint r = 0u; r < 4u; ++r) texRows[r] = sumTexRow(patchPoints.texture, r, tw);
        }
        float levelLow = mix(levels.x, levels.y, u), levelHigh = mix(levels.w, levels.z, u);
        uint vertex = tile.firstVertex + first.x + i - 1u;
        for (uint j = row; j < size.y && i < size.x; j += stride) {
            float v = insideCoordinate(first.y + j, segments.y, rates.y), leafV = scale * v - origin.y;
            CurveWeights curve = splineWeights(leafV);
            CurveWeights vw = byFaceWeights(atBoundary(curve, (surfaceBoundary & 1u) != 0u, (surfaceBoundary & 4u) != 0u), scale);
            PointFrames frames = PointFrames(frameOfRows(rows, vw, surfaceOrigin), kNoFrame, kNoFrame);
            if (hasRest) frames.rest = frameOfRows(restRows, vw, restOrigin);
            if (hasTexture) {
                CurveWeights tw = byFaceWeights(atBoundary(curve, (textureBoundary & 1u) != 0u, (textureBoundary & 4u) != 0u), scale);
                frames.texture = texFrameOfRows(texRows, tw);
            }
            Leaf leaf = Leaf(tile.patchIndex, vec2(leafU, leafV), scale, tile.face);
            SurfacePoint point = surfacePointOf(frames, patchPoints, leaf, vec2(u, v), hasTexture, hasRest);
            DisplacedSample s = displacedAlone(point, mix(levelLow, levelHigh, v));
            storeVertex(vertex + (first.y + j - 1u) * (segments.x - 1u), s);
        }
    }
}

#endif

void main() {
    InsideTile tile = fetchInsideTile(gl_WorkGroupID.x + push.first);
    PatchPoints patchPoints = fetchPatch(tile.patchIndex, inputs.model.pointsNow);
    if (kIsCommon) patchPoints.surface.type = patchPoints.texture.type = kPatchRegular;
    loadTile(patchPoints);
#ifndef RELIEF_STORAGE_TABLES
    if (kReadsNodes) nodesOfFace = nodeLevel(partAt(MapPlace(tile.face, vec2(0), vec2(0))), faceLevel(tile.face, vec2(0)));
    if (kIsCommon) {
        diceColumns(tile, patchPoints);
        return;
    }
#endif
    uvec2 first = halvesOf(tile.firstIJ), size = halvesOf(tile.sizeIJ);
    float scale = float(1u << tile.depth);
    vec2 origin = vec2(halvesOf(tile.origin));
    for (uint k = gl_LocalInvocationID.x; k < size.x * size.y; k += gl_WorkGroupSize.x) {
        uvec2 ij = first + divided(k, size.x).yx;
        vec2 uv = insidePoint(tile, ij);
        DisplacedSample s = displacedInLeaf(patchPoints, Leaf(tile.patchIndex, scale * uv - origin, scale, tile.face), uv,
                                             faceLevel(tile.face, uv));
        uint row = halvesOf(tile.segments).x - 1u;
        storeVertex(tile.firstVertex + (ij.y - 1u) * row + ij.x - 1u, s);
    }
}
#endif
