// Lookups in the pictures of a model at a fragment's texture coordinates. Included after varyings.glsl.
#ifndef RELIEF_LOOKUP_GLSL
#define RELIEF_LOOKUP_GLSL

// A picture is that of the unit square, or of several (a set of tiles): `tiles` are the lowest (s,t) that it covers, and one by how
// far it goes along both.
layout(constant_id = kIdHasPictureTiles) const bool kHasPictureTiles = false;

// Where (s,t) lies in a picture, whose rows go down.
vec2 pictureCoordinates(vec4 tiles) {
    if (kHasPictureTiles) return vec2((vTexCoord.x - tiles.x) * tiles.z, 1.0 - (vTexCoord.y - tiles.y) * tiles.w);
    return vec2(vTexCoord.x, 1.0 - vTexCoord.y);
}

// `level` is added to the mip level that fits a pixel.
#ifdef RELIEF_OWN_DERIVATIVES // no neighbouring fragments: how (s,t) change from a pixel to the next is known
vec2 stepX, stepY;
vec4 lookUp(sampler2D map, vec4 tiles, float level) {
    float scale = exp2(level);
    vec2 x = scale * vec2(stepX.x, -stepX.y), y = scale * vec2(stepY.x, -stepY.y);
    if (kHasPictureTiles) x *= tiles.zw, y *= tiles.zw;
    return textureGrad(map, pictureCoordinates(tiles), x, y);
}
#else
vec4 lookUp(sampler2D map, vec4 tiles, float level) { return texture(map, pictureCoordinates(tiles), level); }
#endif
#endif
