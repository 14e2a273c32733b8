// Lookups in the pictures of a model at a fragment's texture coordinates. Included after varyings.glsl.
#ifndef RELIEF_LOOKUP_GLSL
#define RELIEF_LOOKUP_GLSL

// Where (s,t) lies in a picture, whose rows go down.
vec2 pictureCoordinates() { return vec2(vTexCoord.x, 1.0 - vTexCoord.y); }

// `level` is added to the mip level that fits a pixel.
#ifdef RELIEF_OWN_DERIVATIVES // no neighbouring fragments: how (s,t) change from a pixel to the next is known
vec2 stepX, stepY;
vec4 lookUp(sampler2D map, float level) {
    float scale = exp2(level);
    return textureGrad(map, pictureCoordinates(), scale * vec2(stepX.x, -stepX.y), scale * vec2(stepY.x, -stepY.y));
}
#else
vec4 lookUp(sampler2D map, float level) { return texture(map, pictureCoordinates(), level); }
#endif
#endif
