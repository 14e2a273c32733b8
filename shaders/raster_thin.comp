#version 460
#extension GL_GOOGLE_include_directive : require
#include "raster_coverage.glsl"

// Long thin triangles that raster_triangles.comp has listed, one invocation each. The box around one may have a hundred times the
// pixels that it covers: of each row of blocks only those between its edges are looked at.
layout(local_size_x_id = kIdGroupSize) in;

// The first and the last column of pixels, from the first one, that the row of blocks at `row` may cover.
ivec2 columnsAt(ShortTriangle t, int row) {
    int above = 256 * row + firstPlace(), below = 256 * (row + kBlock.y - 1) + lastPlace();
    ivec3 most = t.e + max(t.dx * above, t.dx * below);
    return columnsBetween(vec3(most), t.dy, t.last.x - t.first.x);
}

void drawThin(uint triangle) {
    ShortTriangle t = shortTriangle(screenAt(meshIndex(3u * triangle)), screenAt(meshIndex(3u * triangle + 1u)),
                                    screenAt(meshIndex(3u * triangle + 2u)));
    if (t.area == 0) return;
    // One loop over all rows: lanes whose triangles have rows of other lengths do not wait for each other at the end of each.
    int lastRow = t.last.y - t.first.y;
    ivec2 columns = columnsAt(t, 0);
    for (ivec2 pixel = ivec2(columns.x, 0); pixel.y <= lastRow;) {
        if (pixel.x <= columns.y) drawBlock(t, pixel, triangle);
        pixel.x += kBlock.x;
        if (pixel.x > columns.y) {
            pixel.y += kBlock.y;
            columns = columnsAt(t, pixel.y);
            pixel.x = columns.x;
        }
    }
}

void main() {
    uint count = inputs.targets.listedTriangles.at[kThinList + kListCount];
    for (uint i = gl_GlobalInvocationID.x; i < count; i += gl_NumWorkGroups.x * gl_WorkGroupSize.x)
        drawThin(inputs.targets.listedTriangles.at[kListFirst + push.count - 1u - i]);
}
