#version 460
#extension GL_GOOGLE_include_directive : require
#include "raster.glsl"

// Triangles that raster_triangles.comp has listed: those that cover much, and those that have corners behind the eye or far aside. One
// workgroup per triangle and tile of the picture; its invocations share the pixels of the tile. Edges are 64-bit numbers.
layout(local_size_x_id = kIdGroupSize) in;

// --- clipping -------------------------------------------------------------------------------------------------------

struct ClipVertex {
    vec4 clip;
    vec3 normal; // in the world
};

// A triangle cut by five planes has eight corners at most.
const uint kMostCorners = 8u;
ClipVertex corners[kMostCorners];
uint cornerCount;

// Planes: in front of the near plane, then as far to each side as snapped coordinates go.
const uint kPlanes = 5u;

float distanceTo(uint plane, vec4 clip) {
    if (plane == 0u) return clip.w - clip.z;
    vec2 most = 0.99 * kMostPixels / (0.5 * vec2(push.size)) - 1.0; // pixels are 0.5 size (x / w + 1)
    uint axis = plane - 1u & 1u;
    precise float limit = most[axis] * clip.w;
    return plane < 3u ? limit - clip[axis] : limit + clip[axis];
}

// Where the edge from a corner inside to one outside meets the plane: the same bits from both triangles of an edge.
ClipVertex cutAt(ClipVertex inside, ClipVertex outside, float distanceInside, float distanceOutside) {
    precise float t = distanceInside / (distanceInside - distanceOutside);
    precise vec4 clip = inside.clip + t * (outside.clip - inside.clip);
    precise vec3 normal = inside.normal + t * (outside.normal - inside.normal);
    return ClipVertex(clip, normal);
}

// Sutherland and Hodgman (1974).
void cutBy(uint plane) {
    ClipVertex kept[kMostCorners];
    uint count = 0u;
    for (uint i = 0u; i < cornerCount; ++i) {
        ClipVertex from = corners[i], to = corners[i + 1u == cornerCount ? 0u : i + 1u];
        float atFrom = distanceTo(plane, from.clip), atTo = distanceTo(plane, to.clip);
        if (atFrom >= 0.0 && count < kMostCorners) kept[count++] = from;
        if ((atFrom >= 0.0) != (atTo >= 0.0) && count < kMostCorners)
            kept[count++] = atFrom >= 0.0 ? cutAt(from, to, atFrom, atTo) : cutAt(to, from, atTo, atFrom);
    }
    cornerCount = count;
    for (uint i = 0u; i < count; ++i) corners[i] = kept[i];
}

const int kMostAcross = 8; // pixels of a row that invocations share

// --- pixels -----------------------------------------------------------------------------------------------------------

ScreenVertex screenCorner(uint i) {
    ScreenVertex v = toScreen(corners[i].clip);
    if (kPass == kPassSurface) v.normal = packNormal(corners[i].normal);
    return v;
}

// E of the edge a -> b at p, without the bias.
int64_t edgeAt(ivec2 a, ivec2 b, ivec2 p) {
    return int64_t(b.x - a.x) * int64_t(p.y - a.y) - int64_t(b.y - a.y) * int64_t(p.x - a.x);
}

// The larger E of two places.
float mostAt(ivec2 a, ivec2 b, ivec2 p, ivec2 q) { return float(max(edgeAt(a, b, p), edgeAt(a, b, q))); }

void drawPixel(ScreenVertex a, ScreenVertex b, ScreenVertex c, ivec3 bias, float perArea, Attributes all, ivec2 pixel, uint triangle,
               bool isFront) {
    for (uint s = 0u; s < sampleCount(); ++s) {
        ivec2 p = 256 * pixel + placeOf(s);
        int64_t ea = edgeAt(b.p, c.p, p), eb = edgeAt(c.p, a.p, p), ec = edgeAt(a.p, b.p, p);
        if (ea + int64_t(bias.x) < 0l || eb + int64_t(bias.y) < 0l || ec + int64_t(bias.z) < 0l) continue;
        store(pixel, s, vec3(float(ea), float(eb), float(ec)) * perArea, all, triangle, isFront);
    }
}

void drawInTile(ScreenVertex a, ScreenVertex b, ScreenVertex c, uint triangle, ivec2 tileFirst, ivec2 tileLast) {
    if (min(a.p.x, min(b.p.x, c.p.x)) == kUnplaced) return; // not a number
    int64_t area = edgeAt(a.p, b.p, c.p);
    if (area == 0l) return;
    bool isFront = area < 0l;
    if (isFront) {
        ScreenVertex v = b;
        b = c, c = v;
        area = -area;
    }
    Attributes all = attributesOf(a, b, c, isFront);
    float perArea = 1.0 / float(area);
    ivec3 bias = ivec3(biasOf(c.p - b.p), biasOf(a.p - c.p), biasOf(b.p - a.p));
    ivec2 first = max((min(a.p, min(b.p, c.p)) + (255 - lastPlace())) >> 8, tileFirst);
    ivec2 last = min((max(a.p, max(b.p, c.p)) - firstPlace()) >> 8, tileLast);
    ivec2 size = last - first + 1;
    if (size.x <= 0 || size.y <= 0) return;
    // As many rows at once as there are invocations for, and of these the columns between the edges.
    int across = min(kMostAcross, int(gl_WorkGroupSize.x)), rows = int(gl_WorkGroupSize.x) / across;
    ivec2 own = ivec2(int(gl_LocalInvocationID.x) % across, int(gl_LocalInvocationID.x) / across);
    ivec3 dy = ivec3(c.p.y - b.p.y, a.p.y - c.p.y, b.p.y - a.p.y);
    for (int row = first.y; row <= last.y; row += rows) {
        ivec2 above = 256 * ivec2(first.x, row) + ivec2(0, firstPlace());
        ivec2 below = 256 * ivec2(first.x, row + rows - 1) + ivec2(0, lastPlace());
        vec3 most = vec3(mostAt(b.p, c.p, above, below), mostAt(c.p, a.p, above, below), mostAt(a.p, b.p, above, below));
        ivec2 columns = columnsBetween(most, dy, last.x - first.x);
        for (ivec2 pixel = ivec2(first.x + columns.x, row) + own; pixel.x <= first.x + columns.y; pixel.x += across)
            if (pixel.y <= last.y) drawPixel(a, b, c, bias, perArea, all, pixel, triangle, isFront);
    }
}

// Whether a triangle with all corners on the screen lies outside of a tile: so that it need not be cut to find out.
bool isApart(uint vertices[3], ivec2 first, ivec2 last) {
    ivec2 a = ivec2(screenAt(vertices[0]).xy), b = ivec2(screenAt(vertices[1]).xy), c = ivec2(screenAt(vertices[2]).xy);
    ivec2 low = min(a, min(b, c)), high = max(a, max(b, c));
    return low.x != kUnplaced && (any(lessThan(high, 256 * first)) || any(greaterThan(low, 256 * (last + 1))));
}

void main() {
    uint tilesAcross = uint(push.size.x + kLargeTile - 1) / uint(kLargeTile);
    ivec2 first = kLargeTile * ivec2(gl_WorkGroupID.y % tilesAcross, gl_WorkGroupID.y / tilesAcross);
    ivec2 last = min(first + kLargeTile, push.size) - 1;
    uint count = inputs.targets.listedTriangles.at[kLargeList + kListCount];
    for (uint i = gl_WorkGroupID.x; i < count; i += gl_NumWorkGroups.x) {
        uint triangle = inputs.targets.listedTriangles.at[kListFirst + i];
        uint vertices[3];
        for (uint k = 0u; k < 3u; ++k) vertices[k] = meshIndex(3u * triangle + k);
        if (isApart(vertices, first, last)) continue;
        for (uint k = 0u; k < 3u; ++k) {
            uint vertex = vertices[k];
            precise vec4 clip = project(meshAt(2u * vertex).xyz);
            corners[k] = ClipVertex(clip, kPass == kPassSurface ? worldNormal(meshAt(2u * vertex + 1u).xyz) : vec3(0));
        }
        cornerCount = 3u;
        for (uint plane = 0u; plane < kPlanes; ++plane) cutBy(plane);
        for (uint k = 2u; k < cornerCount; ++k) drawInTile(screenCorner(0u), screenCorner(k - 1u), screenCorner(k), triangle, first, last);
    }
}
