#version 460
#extension GL_GOOGLE_include_directive : require
#include "raster.glsl"

// Lines around triangles, one invocation per triangle: the samples in rectangles one pixel wide along its edges, as the fixed
// function draws lines of triangles (Vulkan 1.3, "Bresenham Line Segment Rasterization", and with strict lines: rectangles).
layout(local_size_x_id = kIdGroupSize) in;

// In front of the near plane, then within twice the picture's width and height around its middle.
float distanceTo(uint plane, vec4 clip) {
    if (plane == 0u) return clip.w - clip.z;
    float x = plane < 3u ? clip.x : clip.y;
    return 2.0 * clip.w + ((plane & 1u) == 0u ? x : -x);
}

// Leaves of a line what lies inside of all planes; false where that is nothing.
bool cutLine(inout vec4 a, inout vec4 b) {
    float first = 0.0, last = 1.0;
    for (uint plane = 0u; plane < 5u; ++plane) {
        float atA = distanceTo(plane, a), atB = distanceTo(plane, b);
        if (atA < 0.0) first = max(first, atB < 0.0 ? 2.0 : atA / (atA - atB));
        else if (atB < 0.0) last = min(last, atA / (atA - atB));
    }
    if (!(first < last)) return false;
    vec4 along = b - a;
    b = a + last * along;
    a += first * along;
    return true;
}

// What a triangle does to its lines: how much nearer they are drawn than they lie, and from which side it is seen.
struct Plane {
    float bias;
    bool isFront;
};

// Where the picture's middle is moved to for numbers of a triangle: its corner farthest in front of the eye, which is the one whose
// x / w and y / w are the most precise. Others may lie behind the eye, or beside it at any distance.
vec2 originOf(vec4 corners[3]) {
    vec4 farthest = corners[0];
    for (uint i = 1u; i < 3u; ++i)
        if (corners[i].w > farthest.w) farthest = corners[i];
    return farthest.w > 0.0 ? farthest.xy / farthest.w : vec2(0); // else nothing is seen of it
}

// Depth is linear in x and y of the screen: the numbers (A, B, C) with z = A x + B y + C w at all corners, in homogeneous
// coordinates, of which A and B are its slopes, are the corners' z times the inverse of their matrix. The corners are moved so that
// one of them is the origin, which keeps small triangles precise.
Plane planeOf(vec4 corners[3]) {
    vec2 origin = originOf(corners);
    vec3 rows[3];
    float nearest = 0.0;
    for (uint i = 0u; i < 3u; ++i) {
        rows[i] = vec3(corners[i].xy - origin * corners[i].w, corners[i].w);
        nearest = max(nearest, corners[i].w > 0.0 ? min(corners[i].z / corners[i].w, 1.0) : 1.0);
    }
    vec3 across[3] = vec3[3](cross(rows[1], rows[2]), cross(rows[2], rows[0]), cross(rows[0], rows[1]));
    float area = dot(rows[0], across[0]);
    vec2 slopes = corners[0].z * across[0].xy + corners[1].z * across[1].xy + corners[2].z * across[2].xy;
    slopes = area != 0.0 ? abs(slopes / area) * 2.0 / vec2(push.size) : vec2(0); // per pixel
    // The last place of numbers as large as the largest depth.
    float unit = uintBitsToFloat(floatBitsToUint(max(nearest, 1e-20)) & 0x7f800000u) * exp2(-23.0);
    return Plane(kLineBiasUnits * unit + kLineBiasSlope * max(slopes.x, slopes.y), area < 0.0);
}

// Column after column of pixels, or row after row where a line is steep, and in each the few pixels that the rectangle meets.
void drawLine(vec4 from, vec4 to, float bias, uint id) {
    vec2 halfSize = 0.5 * vec2(push.size), a = from.xy / from.w * halfSize + halfSize, b = to.xy / to.w * halfSize + halfSize;
    float depthA = from.z / from.w, depthB = to.z / to.w;
    bool isSteep = abs(b.y - a.y) > abs(b.x - a.x);
    if (isSteep) a = a.yx, b = b.yx;
    ivec2 size = isSteep ? push.size.yx : push.size;
    vec2 along = b - a;
    float square = dot(along, along), reach = sqrt(square);
    if (!(square > 0.0)) return;
    float slope = along.y / along.x, overlap = 0.5 * abs(along.y) / reach, thickness = 0.5 * reach / abs(along.x);
    int firstColumn = max(int(floor(min(a.x, b.x) - overlap)), 0), lastColumn = min(int(floor(max(a.x, b.x) + overlap)), size.x - 1);
    for (int column = firstColumn; column <= lastColumn; ++column) {
        float y = a.y + slope * (float(column) - a.x);
        int firstRow = max(int(floor(min(y, y + slope) - thickness)), 0);
        int lastRow = min(int(floor(max(y, y + slope) + thickness)), size.y - 1);
        for (int row = firstRow; row <= lastRow; ++row) {
            ivec2 pixel = isSteep ? ivec2(row, column) : ivec2(column, row);
            for (uint s = 0u; s < sampleCount(); ++s) {
                vec2 place = vec2(placeOf(s)) / 256.0, p = vec2(column, row) + (isSteep ? place.yx : place) - a;
                float t = dot(p, along) / square, side = (along.x * p.y - along.y * p.x) / reach;
                if (t >= 0.0 && t <= 1.0 && side >= -0.5 && side < 0.5)
                    keepNearest(uint(pixel.y * push.size.x + pixel.x), s, id, clamp(mix(depthA, depthB, t) + bias, 0.0, 1.0));
            }
        }
    }
}

void main() {
    uint triangle = push.first + gl_GlobalInvocationID.x;
    if (triangle >= push.count) return;
    vec4 corners[3];
    for (uint i = 0u; i < 3u; ++i) corners[i] = project(meshAt(2u * meshIndex(3u * triangle + i)).xyz);
    Plane plane = planeOf(corners);
    uint id = packId(push.firstId + triangle, true, plane.isFront);
    for (uint i = 0u; i < 3u; ++i) {
        vec4 from = corners[i], to = corners[i == 2u ? 0u : i + 1u];
        if (cutLine(from, to)) drawLine(from, to, plane.bias, id);
    }
}
