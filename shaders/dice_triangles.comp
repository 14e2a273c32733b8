#version 460
#extension GL_GOOGLE_include_directive : require
#include "dice.glsl"
#include "locations.glsl"

// The triangles between the samples, one workgroup per tile. Each side is a ring of triangles that joins the r segments
// of the edge to the segments of the inner samples beside it, as the fixed-function tessellator does; within are cells.
//
//   inner samples     +---+---+---+         a segment of the edge takes the inner sample after as many inner segments
//                    / \ / \ /|  \          as have their middles before its own, and an inner segment likewise:
//   the edge        +---+----+----+         the two orders merge, and every triangle is known without the others
layout(local_size_x_id = kIdGroupSize) in;

// Vertex of sample k of a side with r segments, in the side's direction.
uint sideVertex(FaceRuns runs, uint side, uint entry, uint k, uint r) {
    if (k == 0u) return runs.corners[side];
    if (k == r) return runs.corners[(side + 1u) % kSideCount];
    if ((entry & kSideReversed) != 0u) k = r - k;
    uint half_ = 0u;
    if ((entry & kSideSplit) != 0u) {
        r /= 2u;
        if (k == r) return runs.middles[side];
        if (k > r) {
            k -= r;
            half_ = 1u;
        }
    }
    return firstVertexOf(runs.sides[2u * side + half_]) + k - 1u;
}

// The middle of inner segment i is at (2 i + kInnerStart) / 2n of the side; rows of a triangle start half a segment later.
#ifdef RELIEF_TRIANGLES
const uint kInnerStart = 4u;
#else
const uint kInnerStart = 3u;
#endif

// Inner segments, of l, whose middles lie before that of the edge's segment k of r.
uint innerBefore(uint k, uint r, uint l, uint n) {
    uint x = (2u * k + 1u) * n;
    return x > kInnerStart * r ? min((x - (kInnerStart - 2u) * r - 1u) / (2u * r), l) : 0u;
}

// Segments of the edge, of r, whose middles lie before or at that of inner segment i.
uint outerBefore(uint i, uint r, uint n) { return min(((2u * i + kInnerStart) * r + n) / (2u * n), r); }

void storeTriangle(uint triangle, uint a, uint b, uint c) {
    inputs.targets.dicedIndices.at[3u * triangle] = a;
    inputs.targets.dicedIndices.at[3u * triangle + 1u] = b;
    inputs.targets.dicedIndices.at[3u * triangle + 2u] = c;
}

#ifdef RELIEF_TRIANGLES

// Inner samples: the lattice of n segments per side without its border, at least the centre of n = 3.
uint insideVertex(TriangleTile tile, uint n, uint i, uint j) {
    return tile.firstVertex + (j - 1u) * (n - 2u) - (j - 1u) * (j - 2u) / 2u + i - 1u;
}

uint innerOf(TriangleTile tile, uint side, uvec2 n, uint i) {
    uint last = n.x - 2u;
    return side == 0u ? insideVertex(tile, n.x, 1u + i, 1u)
           : side == 1u ? insideVertex(tile, n.x, last - i, 1u + i) : insideVertex(tile, n.x, 1u, last - i);
}

// Cell triangles of the inner lattice, of n - 3 segments per side, row by row: row y has 2 (m - y) - 1 of them.
void storeCell(TriangleTile tile, uvec2 n, uint t, uint triangle) {
    uint m = n.x - 3u, y = 0u;
    while (t >= 2u * (m - y) - 1u) {
        t -= 2u * (m - y) - 1u;
        ++y;
    }
    uint i = t / 2u + 1u, j = y + 1u;
    if (t % 2u == 0u)
        storeTriangle(triangle, insideVertex(tile, n.x, i, j), insideVertex(tile, n.x, i + 1u, j),
                      insideVertex(tile, n.x, i, j + 1u));
    else
        storeTriangle(triangle, insideVertex(tile, n.x, i + 1u, j), insideVertex(tile, n.x, i + 1u, j + 1u),
                      insideVertex(tile, n.x, i, j + 1u));
}
#else

uint insideVertex(TriangleTile tile, uvec2 n, uint i, uint j) { return tile.firstVertex + (j - 1u) * (n.x - 1u) + i - 1u; }

// Inner sample i beside a side, in the side's direction.
uint innerOf(TriangleTile tile, uint side, uvec2 n, uint i) {
    return side == 0u   ? insideVertex(tile, n, 1u + i, 1u)
           : side == 1u ? insideVertex(tile, n, n.x - 1u, 1u + i)
           : side == 2u ? insideVertex(tile, n, n.x - 1u - i, n.y - 1u)
                        : insideVertex(tile, n, 1u, n.y - 1u - i);
}

void storeCell(TriangleTile tile, uvec2 n, uint t, uint triangle) {
    uvec2 ji = divided(t / 2u, n.x - 2u);
    uint a = insideVertex(tile, n, ji.y + 1u, ji.x + 1u), d = a + n.x - 1u;
    bool isFirst = t % 2u == 0u;
    storeTriangle(triangle, isFirst ? a : a + 1u, isFirst ? a + 1u : d + 1u, d);
}
#endif

void storeCells(TriangleTile tile, uvec2 n, uint rings, uint count) {
    for (uint k = gl_LocalInvocationID.x; k < kTrianglesPerTile && tile.firstInFace + k < count; k += gl_WorkGroupSize.x)
        storeCell(tile, n, tile.firstInFace + k - rings, tile.firstTriangle + k);
}

void main() {
    uvec4 words = tileTexel(push.first + gl_WorkGroupID.x);
    TriangleTile tile = TriangleTile(words.x, words.y, words.z, words.w);
    Face face = fetchFace(tile.face);
    FaceRuns runs = fetchFaceRuns(tile.face);
    uint r[kSideCount], largest = 1u, sum = 0u;
    for (uint side = 0u; side < kSideCount; ++side) {
        r[side] = sideRate(face.sides[side]).segments;
        largest = max(largest, r[side]);
        sum += r[side];
    }
#ifdef RELIEF_TRIANGLES
    uvec2 n = latticeSegments(3u, r[0], r[1], r[2], 0u);
#else
    uvec2 n = latticeSegments(4u, r[0], r[1], r[2], r[3]);
#endif
    uint cells = cellTriangles(kSideCount, n);
    uint rings = largest == 1u ? kSideCount - 2u : ringTriangles(kSideCount, sum, n);
    if (kIsCommon) {
        storeCells(tile, n, rings, rings + cells);
        return;
    }

    for (uint k = gl_LocalInvocationID.x; k < kTrianglesPerTile && tile.firstInFace + k < rings; k += gl_WorkGroupSize.x) {
        uint t = tile.firstInFace + k, triangle = tile.firstTriangle + k;
        if (largest == 1u) {
            storeTriangle(triangle, runs.corners[0], runs.corners[t + 1u], runs.corners[t + 2u]);
            continue;
        }
        uint side = 0u;
        for (; side + 1u < kSideCount; ++side) {
            uint inRing = r[side] + innerSegments(kSideCount, side, n);
            if (t < inRing) break;
            t -= inRing;
        }
#ifdef RELIEF_TRIANGLES
        uint along = n.x;
#else
        uint along = side % 2u == 0u ? n.x : n.y;
#endif
        uint outer = r[side], inner = innerSegments(kSideCount, side, n);
        uint entry = face.sides[side];
        if (t < outer) {
            storeTriangle(triangle, sideVertex(runs, side, entry, t, outer), sideVertex(runs, side, entry, t + 1u, outer),
                          innerOf(tile, side, n, innerBefore(t, outer, inner, along)));
        } else {
            uint i = t - outer;
            storeTriangle(triangle, innerOf(tile, side, n, i + 1u), innerOf(tile, side, n, i),
                          sideVertex(runs, side, entry, outerBefore(i, outer, along), outer));
        }
    }
}
